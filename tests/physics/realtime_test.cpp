// The world in the haptic loop: no allocation, no free, no system call, no lock that another thread takes,
// while that other thread prepares and destroys bodies as fast as it can.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "physics/physics_world.hpp"
#include "scene.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::realtime_test {
namespace {

using namespace scene;
using testing::AuditScope;
using testing::LockAudit;

std::vector<BodyDescription> every_shape() {
    auto heights = std::make_shared<std::vector<float>>(12 * 12, 0.0f);
    const Shape shapes[] = {BoxShape{Vec3(0.05)},
                            SphereShape{0.05},
                            CapsuleShape{0.03, 0.05},
                            CylinderShape{0.05, 0.05},
                            ConvexHullShape{cube_mesh(0.05)},
                            MeshShape{cube_mesh(0.05)}};
    std::vector<BodyDescription> bodies;
    double x = 0.0;
    for (const Shape& shape : shapes) {
        BodyDescription body;
        body.shapes = one(shape);
        body.pose.position = {x += 0.101, 0.08, 0.0};
        body.mass = 0.2;
        bodies.push_back(body);
    }
    bodies.back().continuous = true;
    BodyDescription terrain;
    terrain.shapes = one(HeightFieldShape{12, 12, Vec3(0.2, 1.0, 0.2), heights});
    terrain.motion = Motion::Static;
    bodies.push_back(terrain);
    BodyDescription mesh;
    mesh.shapes = one(MeshShape{cube_mesh(0.5)});
    mesh.pose.position = {0.3, -0.45, 0.0};
    mesh.motion = Motion::Static;
    bodies.push_back(mesh);
    return bodies;
}

class PhysicsInTheLoop : public ::testing::Test {
protected:
    void SetUp() override {
        add(world_, ground());
        for (const BodyDescription& description : every_shape())
            ids_.push_back(add(world_, description));
    }

    void push_everything() {
        for (const BodyId id : ids_)
            world_.apply_force(id, {0.3, 0.1, 0.2}, world_.center_of_mass(id) + Vec3(0.0, 0.02, 0.0));
    }

    PhysicsWorld world_;
    std::vector<BodyId> ids_;
};

TEST_F(PhysicsInTheLoop, StepAllocatesNothingFromTheVeryFirst) {
    AuditScope audit;
    for (int i = 0; i < 1000; ++i) {
        push_everything();
        world_.step(tick);
    }
    audit.finish();
    EXPECT_EQ(audit.allocations(), 0u) << audit.describe();
    EXPECT_EQ(audit.frees(), 0u) << audit.describe();
    EXPECT_EQ(audit.waits(), 0u) << audit.describe();
    EXPECT_EQ(audit.system_calls(), 0u) << audit.describe();
    EXPECT_EQ(world_.memory_overflows(), 0u);
}

TEST_F(PhysicsInTheLoop, EveryChangeAllocatesNothing) {
    std::vector<PreparedBody> waiting;
    for (int i = 0; i < 200; ++i)
        waiting.push_back(prepare(box(Vec3(0.05), {0.001 * i, 0.5, 0.1 * (i % 7)}, 0.1)));
    PreparedBody other = prepare(box(Vec3(0.08), Vec3(0.0), 0.3));
    std::vector<BodyId> added;
    added.reserve(waiting.size());

    AuditScope audit;
    for (PreparedBody& body : waiting) {
        added.push_back(world_.add(body));
        world_.step(tick);
    }
    const BodyId id = ids_.front();
    world_.reshape(id, other);
    world_.set_pose(id, {{0.0, 1.0, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)});
    world_.set_motion(id, Motion::Kinematic);
    world_.move_to(id, {{0.0, 1.1, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)}, tick);
    world_.step(tick);
    world_.set_motion(id, Motion::Dynamic);
    world_.set_material(id, SurfaceMaterial{0.2, 0.1, true, false});
    world_.set_collision(id, CollisionLayers{4, 1});
    world_.set_collision(id, CollisionLayers{1, 1});
    world_.set_velocity(id, Vec3(0.1), Vec3(0.2));
    world_.set_damping(id, 0.1, 0.1);
    world_.set_gravity_scale(id, 0.5);
    world_.set_can_sleep(id, false);
    world_.set_continuous(id, true);
    world_.sleep(id);
    world_.wake(id);
    world_.apply_torque(id, Vec3(0.01));
    world_.step(tick);
    for (std::size_t i = 0; i < added.size(); ++i) {
        waiting[i] = world_.remove(added[i]);
        world_.step(tick);
    }
    audit.finish();
    EXPECT_EQ(audit.allocations(), 0u) << audit.describe();
    EXPECT_EQ(audit.frees(), 0u) << audit.describe();
    EXPECT_EQ(audit.system_calls(), 0u) << audit.describe();
    EXPECT_EQ(world_.memory_overflows(), 0u);
}

TEST_F(PhysicsInTheLoop, TakesNoLockThatPreparingTakes) {
    const LockAudit locks;
    std::atomic<bool> done{false};
    std::atomic<int> prepared{0};
    std::thread editor([&] {
        const std::vector<BodyDescription> descriptions = every_shape();
        while (!done.load()) {
            for (const BodyDescription& description : descriptions)
                prepared += prepare(description).ready() ? 1 : 0;
        }
    });
    PreparedBody extra = prepare(box(Vec3(0.05), {0.0, 1.0, 0.0}, 0.1));
    int ticks = 0;
    do {
        const AuditScope audit;
        push_everything();
        const BodyId id = world_.add(extra);
        world_.step(tick);
        extra = world_.remove(id);
        ++ticks;
    } while (ticks < 500 || prepared.load() < 50);
    done = true;
    editor.join();
    EXPECT_GT(locks.locks_in_scopes(), 0u);
    EXPECT_TRUE(locks.shared_locks().empty());
}

}  // namespace
}  // namespace tactus::realtime_test
