// A whole tick, Jolt's step included, is fit for the haptic thread while the owner adds and removes as fast
// as it can.
#include <atomic>
#include <thread>

#include "session_rig.hpp"
#include "shared/meshes.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::realtime_test {
namespace {

using namespace session_test;
using testing::AuditScope;
using testing::LockAudit;

BodyAddition mesh_body(const Vec3& position, Motion motion) {
    static const auto mesh = std::make_shared<const TriangleMesh>(shared::icosphere(2, 0.1));
    return body(MeshShape{mesh}, position, motion, 0.5);
}

Vec3 hand_at(int i) {
    return {0.3 * std::sin(0.004 * i), 0.05 + 0.1 * std::sin(0.02 * i), 0.3 * std::cos(0.003 * i)};
}

void fill(SessionRig& rig) {
    rig.add(ground());
    for (int i = 0; i < 6; ++i) {
        rig.add(body(BoxShape{Vec3(0.06)}, {0.15 * i - 0.4, 0.07 + 0.13 * (i % 2), 0.05 * i}, Motion::Dynamic,
                     0.3));
    }
    rig.add(mesh_body({0.0, 0.1, 0.3}, Motion::Static));
    rig.device.position = hand_at(0);
}

TEST(SessionRealtime, ATickAllocatesNothingWaitsForNobodyAndCallsNoSystem) {
    SessionRig rig;
    fill(rig);
    RecorderRing<SessionRecord> ring(4096);
    rig.session.record(ring, rig.proxy, 1);
    rig.session.settle();
    AuditScope audit;
    for (int i = 0; i < 2'000; ++i) {
        rig.device.position = hand_at(i);
        rig.tick();
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.frees(), 0u) << audit.describe();
    EXPECT_EQ(audit.waits() + audit.system_calls(), 0u) << audit.describe();
    EXPECT_GT(ring.drain([](const SessionRecord&) {}), 1'900u);
}

TEST(SessionRealtime, CommandsAreCarriedOutWithoutAllocating) {
    SessionRig rig;
    fill(rig);
    rig.session.settle();
    std::vector<SessionHandle> added;
    for (int round = 0; round < 20; ++round) {
        for (int i = 0; i < 3; ++i) {
            added.push_back(rig.add(
                mesh_body({1.0 + 0.3 * i, 0.5, 0.1 * round}, i == 0 ? Motion::Static : Motion::Dynamic)));
        }
        const SessionHandle last = added.back();
        rig.session.set_touch_material(last, {100.0, 1.0, 0.2, 0.1});
        rig.session.set_body_motion(last, Motion::Kinematic);
        rig.session.move_body(last, {{1.0, 1.0, 1.0}, Quat(1.0, 0.0, 0.0, 0.0)}, 0.005);
        rig.session.teleport_body(added.front(), {{2.0, 1.0, 1.0}, Quat(1.0, 0.0, 0.0, 0.0)});
        rig.session.set_body_layers(last, {2, 2});
        rig.session.set_body_surface(last, {0.3, 0.1, false, false});
        rig.session.set_body_velocity(last, Vec3(0.1), Vec3(0.0));
        rig.session.set_gravity({0.0, -9.0 - 0.01 * round, 0.0});
        const SessionHandle swinging = added[added.size() - 2];
        rig.session.set_body_push(swinging, {0.1, 0.0, 0.0}, {0.0, 0.01 * round, 0.0});
        const AddResult joint =
            rig.session.add_joint({.kind = JointKind::Hinge, .frame = {}}, swinging, no_handle);
        if (round % 2 == 1) {
            rig.session.remove_joint(joint.handle);
        }
        if (round > 10) {
            rig.session.remove_body(added[static_cast<std::size_t>(round)]);
        }
        AuditScope audit;
        for (int i = 0; i < 10; ++i) {
            rig.tick();
        }
        audit.finish();
        ASSERT_EQ(audit.allocations() + audit.frees(), 0u) << audit.describe();
        ASSERT_EQ(audit.waits() + audit.system_calls(), 0u) << audit.describe();
        rig.session.collect();
    }
}

TEST(SessionRealtime, NoLockOfATickIsTakenByAnyOtherThread) {
    const LockAudit locks;
    SessionRig rig;
    fill(rig);
    rig.session.settle();
    std::atomic<bool> done{false};
    std::atomic<int> changes{0};
    // From here on the owner side belongs to this thread, the loop side to the test's.
    std::thread owner([&] {
        int i = 0;
        while (!done.load()) {
            const AddResult added =
                rig.session.add_body(mesh_body({2.0 + 0.01 * (i % 50), 0.5, 0.0}, Motion::Dynamic));
            if (added.handle != no_handle) {
                rig.session.teleport_body(added.handle, {{3.0, 0.5, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)});
                rig.session.remove_body(added.handle);
            }
            rig.session.collect();
            rig.session.refresh();
            ++changes;
            ++i;
        }
        while (rig.session.collect()) {
            std::this_thread::yield();
        }
    });
    std::size_t allocations = 0;
    int ticks = 0;
    while (ticks < 1'500 || (changes.load() < 100 && ticks < 200'000)) {
        AuditScope audit;
        rig.device.position = hand_at(ticks++);
        rig.tick();
        audit.finish();
        allocations += audit.allocations() + audit.frees() + audit.waits() + audit.system_calls();
    }
    done = true;
    // The owner drains what is left while the loop goes on.
    std::atomic<bool> joined{false};
    std::thread joiner([&] {
        owner.join();
        joined = true;
    });
    while (!joined.load()) {
        rig.tick();
    }
    joiner.join();
    EXPECT_EQ(allocations, 0u);
    EXPECT_GE(changes.load(), 100);
    EXPECT_TRUE(locks.shared_locks().empty());
}

}  // namespace
}  // namespace tactus::realtime_test
