// Virtual time: the same calls with the same times give the same bits.
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/math/bit_hash.hpp"
#include "session_rig.hpp"
#include "shared/meshes.hpp"
#include "support/process.hpp"

namespace tactus::determinism_test {
namespace {

using namespace session_test;

struct Outcome {
    std::uint64_t hash = 0;
    int touching = 0;
    double box_moved = 0.0;
};

// A finger circles over a terrain and pushes a stack of boxes about.
Outcome run(ForceLaw law) {
    SessionRig rig;
    BodyAddition hills = body(MeshShape{std::make_shared<const TriangleMesh>(shared::terrain(24, 2.0, 0.05))},
                              Vec3(0.0), Motion::Static);
    hills.touch_material = {800.0, 1.0, 0.5, 0.4};
    rig.add(hills);
    SessionHandle first = no_handle;
    for (int i = 0; i < 5; ++i) {
        BodyAddition box = body(BoxShape{Vec3(0.08)}, {0.4, 0.2 + 0.17 * i, 0.0}, Motion::Dynamic, 0.3);
        box.touch_material = {600.0, 0.5, 0.4, 0.3};
        const SessionHandle handle = rig.add(box);
        first = i == 0 ? handle : first;
    }
    ProxyDescription description;
    description.device = rig.hand;
    description.settings.radius = 0.02;
    description.force_law = law;
    rig.session.set_proxy(rig.proxy, description);
    RecorderRing<SessionRecord> ring(256);
    rig.session.record(ring, rig.proxy, first);
    Outcome outcome;
    BitHash hash;
    Vec3 start(0.0);
    for (int i = 0; i < 3'000; ++i) {
        const double a = 0.002 * i;
        rig.device.position = {0.4 * std::cos(a), 0.1 + 0.12 * std::sin(5.0 * a), 0.4 * std::sin(a)};
        rig.device.velocity = {-0.8 * std::sin(a), 1.2 * std::cos(5.0 * a), 0.8 * std::cos(a)};
        hash.add(static_cast<std::uint64_t>(rig.tick()));
        ring.drain([&](const SessionRecord& row) {
            for (const Vec3& v : {row.hand, row.proxy_position, row.force, row.object_position}) {
                hash.add(v);
            }
            hash.add(row.object_rotation);
            hash.add(static_cast<std::uint64_t>(row.time));
            outcome.touching += row.contacts > 0;
            start = i == 0 ? row.object_position : start;
            outcome.box_moved = glm::length(row.object_position - start);
        });
    }
    outcome.hash = hash.value();
    return outcome;
}

TEST(SessionDeterminism, TwoRunsAreTheSameToTheLastBit) {
    for (const ForceLaw law : {ForceLaw::spring, ForceLaw::smoothed}) {
        const Outcome first = run(law);
        const Outcome second = run(law);
        EXPECT_EQ(first.hash, second.hash);
        EXPECT_GT(first.touching, 300);
        EXPECT_GT(first.box_moved, 0.01);
    }
}

// Two hundred boxes thrown about, most of them slowed.
std::uint64_t run_a_crowd() {
    BitHash hash;
    SessionRig rig;
    rig.add(ground());
    std::vector<SessionHandle> boxes;
    for (int i = 0; i < 200; ++i) {
        BodyAddition box = body(BoxShape{Vec3(0.03)}, {0.07 * (i % 20), 0.04 + 0.1 * (i % 3), 0.1 * (i / 20)},
                                Motion::Dynamic, 0.2);
        box.description.linear_velocity = {0.1 * (i % 7), 0.5, -0.1 * (i % 5)};
        boxes.push_back(rig.add(box));
    }
    rig.session.settle();
    for (int i = 0; i < 1'500; ++i) {
        const double a = 0.003 * i;
        rig.device.position = {0.7 + 0.6 * std::cos(a), 0.05, 0.4 * std::sin(a)};
        rig.device.velocity = {-1.8 * std::sin(a), 0.0, 1.2 * std::cos(a)};
        hash.add(static_cast<std::uint64_t>(rig.tick()));
        hash.add(rig.device.force);
        for (const SessionHandle box : boxes) {
            hash.add(rig.state_of(box)->pose.position);
        }
        hash.add(static_cast<std::uint64_t>(rig.newest().slowed_bodies));
    }
    return hash.value();
}

constexpr const char* hash_file = "TACTUS_TEST_HASH_FILE";

// The other process of the next test.
TEST(SessionDeterminism, InAProcessOfItsOwn) {
    const char* const path = std::getenv(hash_file);
    if (path == nullptr) {
        GTEST_SKIP() << "runs as a part of EveryProcessOnAnyCoresGivesTheSameBits";
    }
    std::ofstream(path) << run(ForceLaw::spring).hash << ' ' << run_a_crowd();
}

std::string hashes_of_a_process(const std::string& cores) {
    const std::string path = ::testing::TempDir() + "tactus_hash_" + std::to_string(testing::time_stamp());
    EXPECT_TRUE(testing::run_tests_again("SessionDeterminism.InAProcessOfItsOwn", hash_file, path, cores));
    std::string hashes;
    std::getline(std::ifstream(path), hashes);
    std::remove(path.c_str());
    return hashes;
}

TEST(SessionDeterminism, EveryProcessOnAnyCoresGivesTheSameBits) {
    const std::string here = std::to_string(run(ForceLaw::spring).hash) + ' ' + std::to_string(run_a_crowd());
    EXPECT_EQ(hashes_of_a_process("0"), here);
    if (std::thread::hardware_concurrency() > 1) {
        EXPECT_EQ(hashes_of_a_process("0,1"), here);
    }
}

TEST(SessionDeterminism, TheForceLawChangesTheRun) {
    EXPECT_NE(run(ForceLaw::spring).hash, run(ForceLaw::smoothed).hash);
}

}  // namespace
}  // namespace tactus::determinism_test
