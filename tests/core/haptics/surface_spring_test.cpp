// Surfaces whose stiffness changes with the depth: alone, in series with a pad, and as a hand feels them.
#include "core/haptics/surface_spring.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/haptics/force_law.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::surface_spring_test {
namespace {

using shared::TouchRig;

TouchMaterial bending(double stiffening, double friction = 0.0) {
    TouchMaterial material{600.0, 0.0, friction, friction};
    material.stiffening = stiffening;
    material.stiffening_depth = 0.01;
    return material;
}

TEST(SurfaceSpring, ForceIsTheIntegralOfTheSlopeAndEnergyThatOfTheForce) {
    for (const double stiffening : {0.1, 0.5, 1.0, 3.0, 20.0}) {
        const SurfaceSpring spring = spring_of(bending(stiffening));
        constexpr int steps = 20'000;
        constexpr double step = 0.03 / steps;
        double force = 0.0, energy = 0.0;
        for (int i = 0; i < steps; ++i) {
            const double middle = (i + 0.5) * step;
            energy += step * (force + 0.5 * step * spring.slope(middle));
            force += step * spring.slope(middle);
            const double depth = (i + 1) * step;
            ASSERT_NEAR(spring.force(depth), force, 1e-6 * force) << stiffening << " at " << depth;
            ASSERT_NEAR(spring.energy(depth), energy, 1e-5 * energy + 1e-11) << stiffening << " at " << depth;
        }
        EXPECT_EQ(spring.slope(0.0), 600.0);
        EXPECT_EQ(spring.slope(0.02), 600.0 * stiffening);
    }
}

TEST(SurfaceSpring, TheDepthOfAForceIsWhereItActs) {
    for (const double stiffening : {1e-2, 0.5, 1.0 + 1e-12, 3.0, 1e3}) {
        const SurfaceSpring spring = spring_of(bending(stiffening));
        for (double depth = 1e-7; depth < 0.1; depth *= 1.7) {
            EXPECT_NEAR(spring.depth_of(spring.force(depth)), depth, 1e-9 * depth);
            const double force = spring.force(depth);
            EXPECT_NEAR(spring.secant(force) * depth, force, 1e-9 * force);
            EXPECT_NEAR(0.5 * force * force / spring.as_rich(force), spring.energy(depth),
                        1e-9 * spring.energy(depth));
        }
        EXPECT_EQ(spring.depth_of(0.0), 0.0);
        EXPECT_EQ(spring.secant(0.0), 600.0);
        EXPECT_EQ(spring.as_rich(0.0), 600.0);
    }
}

TEST(SurfaceSpring, UnderAPadBothHoldTheSameForce) {
    for (const double stiffening : {0.1, 1.0, 3.0, 20.0}) {
        const SurfaceSpring surface = spring_of(bending(stiffening));
        for (const double pad : {50.0, 800.0, 1e5}) {
            for (double both = 1e-6; both < 0.2; both *= 1.5) {
                const double depth = depth_under_pad(surface, pad, both);
                EXPECT_NEAR(surface.force(depth), pad * (both - depth), 1e-9 * pad * both);
            }
        }
        EXPECT_EQ(depth_under_pad(surface, 0.0, 0.02), 0.02);
    }
}

TEST(SurfaceSpring, NoSteeperThanWhatIsSafe) {
    for (const double stiffening : {0.3, 5.0}) {
        const SurfaceSpring surface = spring_of(bending(stiffening));
        for (const double limit : {100.0, 700.0, 5000.0}) {
            EXPECT_LE(no_steeper(surface, 0.0, limit).steepest(), limit);
            const double under = no_steeper(surface, 900.0, limit).steepest();
            EXPECT_LE(under_pad({under, 0.0}, 900.0).stiffness, limit * (1.0 + 1e-12));
        }
        const double free = std::numeric_limits<double>::infinity();
        EXPECT_EQ(no_steeper(surface, 0.0, free).deep, surface.deep);
        EXPECT_EQ(no_steeper(surface, 900.0, free).deep, surface.deep);
    }
}

// A hand on a plane.
struct Pressed {
    explicit Pressed(const TouchMaterial& material) : rig(0.05) {
        rig.add(PlaneShape{}, {}, material);
        rig.draw({0.0, 0.1, 0.0}, {0.0, 0.05, 0.0}, 10);
    }
    HandForce at(const Vec3& hand, const SafeWalls& safe = {}) {
        const ProxyTick tick = rig.tick(hand);
        return contact_force(rig.scene, rig.proxy.touching(), tick.slide, Vec3(0.0), 1e-3, safe);
    }
    TouchRig rig;
};

TEST(StiffeningSurface, IsFeltAsStiffAsItIsAtItsDepth) {
    for (const double stiffening : {0.4, 4.0}) {
        Pressed pressed(bending(stiffening));
        const SurfaceSpring spring = spring_of(bending(stiffening));
        for (const double depth : {0.001, 0.005, 0.01, 0.02}) {
            const HandForce force = pressed.at({0.0, 0.05 - depth, 0.0});
            EXPECT_NEAR(force.total.y, spring.force(depth), 1e-3 * spring.force(depth));
            EXPECT_NEAR(force.contacts[0].wall.stiffness, spring.slope(depth), 1e-2 * spring.slope(depth));
            EXPECT_EQ(force.contacts[0].wanted_stiffness, force.contacts[0].wall.stiffness);
        }
    }
}

TEST(StiffeningSurface, AStiffeningOfOneChangesNoBit) {
    TouchMaterial plain{700.0, 2.0, 0.4, 0.3};
    TouchMaterial same = plain;
    same.stiffening_depth = 0.5;
    Pressed first(plain), second(same);
    shared::RandomValues random(5);
    for (int i = 0; i < 500; ++i) {
        const Vec3 hand = Vec3(0.0, 0.04, 0.0) + random.in_box(0.02);
        EXPECT_EQ(first.at(hand).total, second.at(hand).total);
    }
}

// Shifted while it is shallow, pressed, brought back, let go: springs that stiffen with the depth alone would
// give back more along the surface than they took.
TEST(StiffeningSurface, NoWayThatLeadsBackGivesEnergy) {
    for (const double friction : {0.0, 0.5, 2.0}) {
        for (const double stiffening : {0.3, 6.0}) {
            Pressed pressed(bending(stiffening, friction));
            const Vec3 ways[] = {{0.0, 0.049, 0.0},  {0.0, 0.045, 0.0},   {0.002, 0.045, 0.0},
                                 {0.002, 0.03, 0.0}, {-0.002, 0.03, 0.0}, {0.0, 0.03, 0.0},
                                 {0.0, 0.051, 0.0}};
            Vec3 hand(0.0, 0.051, 0.0);
            double given = 0.0, largest = 0.0;
            for (const Vec3& to : ways) {
                const Vec3 step = (to - hand) / 2'000.0;
                for (int i = 0; i < 2'000; ++i) {
                    const Vec3 before = pressed.at(hand).total;
                    hand += step;
                    given += 0.5 * glm::dot(before + pressed.at(hand).total, step);
                    largest = std::max(largest, -given);
                }
            }
            EXPECT_LE(given, 1e-4 * largest) << "friction " << friction << ", stiffening " << stiffening;
        }
    }
}

TEST(StiffeningSurface, FrictionHoldsByCoulombsRatioAtEveryDepth) {
    Pressed pressed(bending(5.0, 0.6));
    for (const double depth : {0.002, 0.008, 0.02}) {
        Vec3 hand(0.0, 0.05 - depth, 0.0);
        HandForce force;
        for (int i = 0; i < 100; ++i) {
            hand.x += 0.001;
            force = pressed.at(hand);
        }
        EXPECT_NEAR(-force.total.x / force.total.y, 0.6, 1e-3);
    }
}

TEST(StiffeningSurface, NoDeviceGetsMoreThanItRendersSafely) {
    SafeWalls safe;
    safe.device_damping = 0.4;  // 800 N/m at 1 ms
    for (const double pad : {0.0, 3000.0}) {
        safe.pad_stiffness = pad;
        Pressed pressed(bending(10.0));
        double before = pressed.at({0.0, 0.05, 0.0}, safe).total.y;
        for (double depth = 1e-4; depth < 0.03; depth += 1e-4) {
            const HandForce force = pressed.at({0.0, 0.05 - depth, 0.0}, safe);
            EXPECT_LE(force.total.y - before, 800.0 * 1.0001e-4);
            EXPECT_LE(force.contacts[0].wall.stiffness, 800.0 * (1.0 + 1e-12));
            before = force.total.y;
        }
        EXPECT_GT(pressed.at({0.0, 0.02, 0.0}, safe).contacts[0].wanted_stiffness, 1900.0);
    }
}

}  // namespace
}  // namespace tactus::surface_spring_test
