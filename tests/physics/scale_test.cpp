// From 5 mm to 10 m, from an eighth of a gram to a thousand tonnes, in one world with one set of settings.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "physics/physics_world.hpp"
#include "scene.hpp"

namespace tactus::scale_test {
namespace {

using namespace scene;

constexpr double density = 1000.0;  // (unit: kilograms per cubic meter)
const std::vector<double> edges{0.005, 0.01, 0.05, 0.2, 1.0, 4.0, 10.0};

BodyDescription flat_box(double edge, const Vec3& position, double friction) {
    const Vec3 size = edge * Vec3(1.0, 0.5, 1.0);
    BodyDescription body = box(size, position, density * size.x * size.y * size.z);
    body.material.friction = friction;
    return body;
}

struct EverySize {
    explicit EverySize(double friction) {
        BodyDescription floor = ground();
        floor.material.friction = 1.0;
        add(world, floor);
        double z = 0.0;
        for (const double edge : edges) {
            z += 2.0 * edge;
            ids.push_back(add(world, flat_box(edge, {0.0, 0.25 * edge + 0.2e-3, z}, friction)));
        }
    }
    PhysicsWorld world;
    std::vector<BodyId> ids;
};

TEST(Scale, EverySizeRestsWhereTheGroundIsAndSleeps) {
    EverySize scene(0.5);
    run(scene.world, 1500);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        EXPECT_NEAR(scene.world.pose(scene.ids[i]).position.y, 0.25 * edges[i], 3e-5) << edges[i] << " m";
        EXPECT_FALSE(scene.world.awake(scene.ids[i])) << edges[i] << " m";
    }
}

// v^2 / (2 mu g), less v dt / 2: the step takes the friction of its whole length first.
TEST(Scale, EverySizeSlidesAsFarAsCoulombSays) {
    constexpr double friction = 0.3;
    EverySize scene(friction);
    run(scene.world, 200);
    std::vector<double> starts;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const double speed = std::sqrt(2.0 * friction * 9.81 * edges[i]);
        starts.push_back(scene.world.pose(scene.ids[i]).position.x);
        scene.world.set_velocity(scene.ids[i], {speed, 0.0, 0.0}, Vec3(0.0));
    }
    run(scene.world, 4000);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const double speed = std::sqrt(2.0 * friction * 9.81 * edges[i]);
        const double way = scene.world.pose(scene.ids[i]).position.x - starts[i];
        EXPECT_NEAR(way, edges[i] - 0.5 * speed * tick, 0.01 * edges[i]) << edges[i] << " m";
        EXPECT_NEAR(scene.world.pose(scene.ids[i]).rotation.w, 1.0, 1e-5) << edges[i] << " m";
    }
}

TEST(Scale, AnEighthOfAGramRestsOnAThousandTonnes) {
    PhysicsWorld world;
    add(world, ground());
    const BodyId large = add(world, box(Vec3(10.0), {0.0, 5.0, 0.0}, 1e6));
    std::vector<BodyId> small;
    for (int i = 0; i < 4; ++i)
        small.push_back(add(world, box(Vec3(0.005), {3.0 + 0.02 * i, 10.0026, -2.0}, 1.25e-4)));
    run(world, 2000);
    EXPECT_NEAR(world.pose(large).position.y, 5.0, 3e-5);
    for (const BodyId id : small) {
        EXPECT_NEAR(world.pose(id).position.y, 10.0025, 6e-5);
        EXPECT_NEAR(world.pose(id).position.z, -2.0, 1e-5);
        EXPECT_FALSE(world.awake(id));
    }
}

TEST(Scale, ATowerOfEverySizeStands) {
    PhysicsWorld world;
    add(world, ground());
    std::vector<BodyId> tower;
    std::vector<double> heights;
    double top = 0.0;
    for (auto edge = edges.rbegin(); edge != edges.rend(); ++edge) {
        heights.push_back(top + 0.25 * *edge);
        tower.push_back(add(world, flat_box(*edge, {0.0, heights.back(), 0.0}, 0.5)));
        top += 0.5 * *edge;
    }
    run(world, 3000);
    for (std::size_t i = 0; i < tower.size(); ++i)
        EXPECT_LT(glm::length(world.pose(tower[i]).position - Vec3(0.0, heights[i], 0.0)), 3e-4) << i;
}

TEST(Scale, AWallOfTenMetresPushesACubeOfFiveMillimetres) {
    PhysicsWorld world;
    add(world, ground());
    BodyDescription wall = box({1.0, 10.0, 10.0}, {-0.51, 5.0, 0.0}, 1.0);
    wall.motion = Motion::Kinematic;
    const BodyId pusher = add(world, wall);
    const BodyId id = add(world, box(Vec3(0.005), {0.0, 0.0025, 0.0}, 1.25e-4));
    for (int i = 1; i <= 2000; ++i) {
        world.move_to(pusher, {{-0.51 + 1e-4 * i, 5.0, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)}, tick);
        world.step(tick);
    }
    EXPECT_NEAR(world.pose(id).position.x, world.pose(pusher).position.x + 0.5025, 1e-4);
    EXPECT_NEAR(world.pose(id).position.y, 0.0025, 5e-5);
    EXPECT_NEAR(std::abs(world.pose(id).rotation.w), 1.0, 1e-4);
}

}  // namespace
}  // namespace tactus::scale_test
