// Friction that falls with the speed: that of the law at a steady pace, never a leap, and nothing given.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/haptics/force_law.hpp"
#include "core/haptics/friction.hpp"
#include "shared/random_values.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::stribeck_test {
namespace {

using shared::TouchRig;

constexpr double radius = 0.01;
constexpr double tick = 1e-3;

TouchMaterial falling(double speed) {
    TouchMaterial material{1000.0, 0.0, 0.6, 0.2};
    material.stribeck_speed = speed;
    return material;
}

// A hand on a plane, `depth` below where it touches.
struct Rubbed {
    Rubbed(const TouchMaterial& material, double depth) : rig(radius), hand(0.0, radius - depth, 0.0) {
        rig.add(PlaneShape{}, {}, material);
        rig.draw({0.0, 2.0 * radius, 0.0}, hand, 10);
    }
    ProxyTick go(const Vec3& way) {
        hand += way;
        return rig.tick(hand);
    }
    // Tangential over normal force.
    double ratio() const {
        const Vec3 x = rig.proxy.position() - hand;
        return std::hypot(x.x, x.z) / x.y;
    }
    TouchRig rig;
    Vec3 hand;
};

TEST(Stribeck, AtASteadyPaceFrictionIsThatOfTheLaw) {
    for (const double depth : {5e-4, 3e-3, 8e-3}) {
        for (const double share : {0.1, 0.5, 0.7, 1.0, 1.5, 4.0}) {
            const TouchMaterial material = falling(0.05);
            Rubbed rubbed(material, depth);
            for (int i = 0; i < 4'000; ++i) {
                rubbed.go({share * 0.05 * tick, 0.0, 0.0});
            }
            const double wanted = 0.2 + 0.4 * std::exp(-share * share);
            EXPECT_NEAR(rubbed.ratio(), wanted, 0.005) << depth << " m deep, " << share << " of the speed";
        }
    }
}

TEST(Stribeck, HoldsByStaticFrictionBeforeItSlides) {
    Rubbed rubbed(falling(0.05), 5e-3);
    const Vec3 stuck = rubbed.rig.proxy.position();
    rubbed.go({0.0029, 0.0, 0.0});  // 0.6 * 5 mm are 3 mm
    EXPECT_EQ(rubbed.rig.proxy.position(), stuck);
    rubbed.go({0.0002, 0.0, 0.0});
    EXPECT_NE(rubbed.rig.proxy.position(), stuck);
    EXPECT_NEAR(rubbed.ratio(), 0.6, 0.01);  // where static gave way to dynamic it would be 0.2
}

// A hand that speeds up and slows down again: the proxy follows without a leap.
TEST(Stribeck, FrictionFallsAndRisesWithoutALeap) {
    for (const double depth : {1e-3, 5e-3, 9e-3}) {
        Rubbed rubbed(falling(0.05), depth);
        double before = rubbed.ratio();
        double speed = 0.0;
        for (int i = 0; i < 3'000; ++i) {
            speed += (i < 1'500 ? 1.0 : -1.0) * 0.3 / 1'500.0;
            rubbed.go({speed * tick, 0.0, 0.0});
            const double by_hand = speed * tick / depth;
            ASSERT_LE(std::abs(rubbed.ratio() - before), by_hand + 0.02) << "tick " << i;
            before = rubbed.ratio();
        }
        EXPECT_GT(rubbed.ratio(), 0.3);  // it has come to rest
    }
}

TEST(Stribeck, AHandThatStopsIsSoonHeldAsAtRest) {
    Rubbed rubbed(falling(0.05), 3e-3);
    for (int i = 0; i < 500; ++i) {
        rubbed.go({2e-4, 0.0, 0.0});
    }
    for (int i = 0; i < 300; ++i) {
        rubbed.go(Vec3(0.0));
    }
    const Vec3 stuck = rubbed.rig.proxy.position();
    rubbed.go({0.5 * (0.6 - 0.2) * 3e-3, 0.0, 0.0});
    EXPECT_EQ(rubbed.rig.proxy.position(), stuck);
}

TEST(Stribeck, NeverGivesEnergy) {
    shared::RandomValues random(11);
    Rubbed rubbed(falling(0.02), 4e-3);
    double taken = 0.0;
    Vec3 velocity(0.0);
    Vec3 force(0.0);
    for (int i = 0; i < 20'000; ++i) {
        velocity += 0.05 * (random.in_box(1.0) - velocity);
        const Vec3 way = Vec3(velocity.x, 0.0, velocity.z) * (0.3 * tick);
        const ProxyTick moved = rubbed.go(way);
        const HandForce now =
            contact_force(rubbed.rig.scene, rubbed.rig.proxy.touching(), moved.slide, Vec3(0.0), tick);
        taken -= 0.5 * glm::dot(force + now.total, way);
        force = now.total;
        const Vec3 x = rubbed.rig.proxy.position() - rubbed.hand;
        const double stored = 500.0 * (glm::dot(x, x) - 16e-6);
        ASSERT_GE(taken, stored - 1e-6) << "tick " << i;
    }
    EXPECT_GT(taken, 0.1);
}

TEST(Stribeck, EqualFrictionAtEverySpeedIsCoulombsToTheBit) {
    TouchMaterial plain{1000.0, 0.0, 0.4, 0.4};
    TouchMaterial level = plain;
    level.stribeck_speed = 0.1;
    Rubbed first(plain, 4e-3), second(level, 4e-3);
    shared::RandomValues random(3);
    for (int i = 0; i < 2'000; ++i) {
        const Vec3 way = random.in_box(1e-3);
        const Vec3 along(way.x, 0.0, way.z);
        EXPECT_EQ(first.go(along).position, second.go(along).position);
    }
}

TEST(Stribeck, AProxyThatIsTakenBackGoesOnAsItDid) {
    Rubbed rubbed(falling(0.05), 4e-3);
    for (int i = 0; i < 100; ++i) {
        rubbed.go({1e-4, 0.0, 0.0});
    }
    const ProxyMemory memory = rubbed.rig.proxy.memory();
    const Vec3 from = rubbed.hand;
    const Vec3 once = rubbed.go({1e-4, 0.0, 0.0}).position;
    rubbed.rig.proxy.recall(memory);
    rubbed.hand = from;
    EXPECT_NEAR(glm::distance(rubbed.go({1e-4, 0.0, 0.0}).position, once), 0.0, 1e-12);
}

}  // namespace
}  // namespace tactus::stribeck_test
