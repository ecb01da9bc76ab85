// A far side whose bodies all move keeps to the bandwidth that its user sets: what a hand may touch next
// comes first, nothing is forgotten, and the load is said.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "model_rig.hpp"

namespace tactus::bandwidth_test {
namespace {

using namespace session_test;

constexpr int count = 60;
constexpr Nanoseconds second = 1'000'000'000;

TeleopSettings keeping_to(double rate) {
    TeleopSettings settings;
    settings.body_rate = rate;
    return settings;
}

struct Crowd {
    explicit Crowd(double rate, LinkConditions conditions = {}) : rig(conditions, keeping_to(rate)) {
        for (int k = 0; k < count; ++k) {
            BodyAddition one = body(BoxShape{Vec3(0.02)}, place(k), Motion::Dynamic, 0.1);
            one.description.gravity_scale = 0.0;
            one.description.can_sleep = false;
            bodies.push_back(rig.far->add("Box" + std::to_string(k), one));
        }
        rig.near->device.position = hand;
        rig.run(3 * second);
    }
    static Vec3 place(int k) { return {0.3 * (k % 10), 0.5, 0.3 * (k / 10)}; }

    // For so many seconds a script of the far scene pushes them about, each another way in every 50 ms.
    void stir(double seconds) {
        const int ticks = static_cast<int>(seconds * 1e3);
        for (int i = 0; i < ticks; ++i) {
            for (int k = 0; i % 50 == 0 && k < count; ++k) {
                const double angle = 2.4 * k + 1.7 * (i / 50);
                const double way = i / 50 % 2 == 0 ? 1.0 : -1.0;  // to and fro
                rig.far->session.set_body_velocity(bodies[static_cast<std::size_t>(k)],
                                                   way * 0.2 * Vec3(std::cos(angle), std::sin(angle), 0.0),
                                                   Vec3(0.0));
            }
            rig.run(period);
            note_errors();
            oldest = std::max(oldest, rig.far->port->statistics.front().load.oldest);
        }
    }
    void note_errors() {
        const SessionSnapshot& there = rig.far->session.snapshot();
        ++noted;
        for (int k = 0; k < count; ++k) {
            const auto at = static_cast<std::size_t>(k);
            const BodyState* const truth = state_of(there.bodies, there.body_count, bodies[at]);
            const Vec3 here = rig.near->pose("Box" + std::to_string(k)).position;
            errors[at] += truth ? glm::distance(truth->pose.position, here) : 0.0;
        }
    }
    // Of a body, in the mean (unit: meters).
    double error(int k) const { return errors[static_cast<std::size_t>(k)] / noted; }
    double bits() const { return rig.near->port->statistics.front().link.received_rate.bits_per_s; }
    const StateLoad& load() const { return rig.far->port->statistics.front().load; }

    Vec3 hand{0.0, 0.535, 0.0};  // above Box0, and touches nothing
    ModelRig rig;
    std::vector<SessionHandle> bodies;
    std::vector<double> errors = std::vector<double>(count, 0.0);
    int noted = 0;
    double oldest = 0.0;
};

TEST(Bandwidth, WhatMovesKeepsToIt) {
    Crowd free(0.0);
    free.stir(3.0);
    EXPECT_GT(free.bits(), 4e6);
    EXPECT_NEAR(free.load().wanted, free.bits(), 0.2 * free.bits());
    for (const double rate : {2e6, 500e3, 100e3}) {
        Crowd narrow(rate);
        narrow.stir(3.0);
        // Hellos, the comparison of clocks and what is said of samples come on top.
        EXPECT_LT(narrow.bits(), 1.05 * rate + 40e3) << rate;
        EXPECT_GT(narrow.bits(), 0.8 * rate) << rate;
        EXPECT_GT(narrow.load().wanted, 3e6) << rate;
    }
}

TEST(Bandwidth, WhatTheHandMayTouchNextComesFirst) {
    Crowd free(0.0);
    free.stir(3.0);
    Crowd narrow(500e3);
    narrow.stir(3.0);
    double far_free = 0.0, far_narrow = 0.0;
    for (int k = 30; k < count; ++k) {
        far_free += free.error(k) / 30.0;
        far_narrow += narrow.error(k) / 30.0;
    }
    EXPECT_LT(narrow.error(0), 1.5 * free.error(0) + 1e-5);
    EXPECT_GT(far_narrow, 2.0 * far_free);
}

TEST(Bandwidth, NothingIsForgotten) {
    Crowd narrow(100e3);
    narrow.stir(6.0);
    EXPECT_LT(narrow.oldest, 4.0);
    EXPECT_GT(narrow.oldest, 0.2);
}

// Where nothing has to give way, nothing does.
TEST(Bandwidth, ARateThatSufficesChangesNothing) {
    Crowd free(0.0), wide(20e6);
    free.stir(1.0);
    wide.stir(1.0);
    EXPECT_EQ(free.errors, wide.errors);
    EXPECT_LT(wide.oldest, 0.05);
}

// Boxes that lie side by side on the ground and are pushed about there.
TEST(Bandwidth, HundredsOfTouchingBodiesKeepToIt) {
    constexpr int crowd = 300;
    constexpr double rate = 2e6, besides = 40e3;
    rig_bodies = 320;
    ModelRig rig({}, keeping_to(rate));
    rig_bodies = usual_rig_bodies;
    rig.far->add("Ground", body(BoxShape{{3.0, 0.1, 3.0}}, {0.0, -0.1, 0.0}, Motion::Static));
    std::vector<SessionHandle> boxes;
    for (int k = 0; k < crowd; ++k) {
        BodyAddition one =
            body(BoxShape{Vec3(0.02)}, {0.04 * (k % 20), 0.02, 0.04 * (k / 20)}, Motion::Dynamic, 0.1);
        one.description.can_sleep = false;
        boxes.push_back(rig.far->add("Box" + std::to_string(k), one));
    }
    rig.near->device.position = {0.0, 0.06, 0.0};  // above Box0
    const auto bits = [&] { return rig.near->port->statistics.front().link.received_rate.bits_per_s; };
    double most = 0.0;
    for (int i = 0; i < 100 && rig.near->builder.objects().size() <= boxes.size(); ++i) {
        rig.run(100 * ms);
        most = std::max(most, bits());
    }
    ASSERT_EQ(rig.near->builder.objects().size(), boxes.size() + 1);
    double near = 0.0, others = 0.0;
    for (int i = 0; i < 1200; ++i) {
        for (int k = 0; i % 50 == 0 && k < crowd; ++k) {
            const double angle = 2.4 * k + 1.7 * (i / 50), way = i / 50 % 2 == 0 ? 0.1 : -0.1;
            rig.far->session.set_body_velocity(boxes[static_cast<std::size_t>(k)],
                                               way * Vec3(std::cos(angle), 0.0, std::sin(angle)), Vec3(0.0));
        }
        rig.run(period);
        most = std::max(most, bits());
        const SessionSnapshot& there = rig.far->session.snapshot();
        for (int k = 0; i % 20 == 0 && k < crowd; k += 19) {
            const BodyState* const truth =
                state_of(there.bodies, there.body_count, boxes[static_cast<std::size_t>(k)]);
            ASSERT_NE(truth, nullptr);
            const double error =
                glm::distance(truth->pose.position, rig.near->pose("Box" + std::to_string(k)).position);
            (k == 0 ? near : others) += error;
        }
    }
    EXPECT_LT(most, 1.05 * rate + besides);
    EXPECT_GT(bits(), 0.9 * rate);
    EXPECT_LT(near, others / 15) << "what the hand may touch next comes first";
    EXPECT_GT(rig.far->port->statistics.front().load.wanted, 10.0 * rate);
}

TEST(Bandwidth, DescriptionsKeepToItAsWell) {
    constexpr double rate = 400e3;
    Crowd narrow(rate);
    auto land = std::make_shared<TriangleMesh>();
    constexpr std::uint32_t side = 60;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        land->vertices.push_back({0.02 * (i % side), 0.001 * ((i * 7919) % 13), 0.02 * (i / side)});
    }
    for (std::uint32_t i = 0; i + side + 1 < side * side; ++i) {
        if (i % side + 1 < side) {
            land->triangles.push_back({i, i + side, i + 1});
        }
    }
    narrow.rig.far->add("Land", body(MeshShape{land}, {0.0, -5.0, 0.0}, Motion::Static));
    double most = 0.0;
    for (int i = 0; i < 20; ++i) {
        narrow.stir(0.5);
        most = std::max(most, i > 2 ? narrow.bits() : 0.0);
    }
    EXPECT_LT(most, 1.1 * rate + 40e3);
    EXPECT_NE(narrow.rig.near->find("Land"), nullptr);
}

}  // namespace
}  // namespace tactus::bandwidth_test
