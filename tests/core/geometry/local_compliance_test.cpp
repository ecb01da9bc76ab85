// What a sphere sinks into an elastic body beyond what its cells show, and a hand over it.
#include "core/geometry/local_compliance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/haptics/force_law.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::local_compliance_test {
namespace {

constexpr double radius = 0.01;

// Cells of no end show nothing: it is all of Hertz's F = 4/3 E* sqrt(R d^3). Fine ones show all of it.
TEST(LocalCompliance, BetweenHertzAndNothing) {
    for (const double s : {1e-4, 1e-3, 8e-3}) {
        const Indentation all = indentation_at({1e4, 1e6}, radius, s);
        EXPECT_NEAR(all.force, 4.0 / 3.0 * 1e4 * std::sqrt(radius * std::pow(all.depth, 3.0)),
                    1e-5 * all.force);
        EXPECT_LT(indentation_at({1e4, 1e-9}, radius, s).depth, 1e-4 * all.depth);
    }
}

TEST(LocalCompliance, ForceAndDepthGrowEvenlyBeyondTheSphereToo) {
    const LocalCompliance body{1e4, 0.004};
    Indentation before;
    for (double s = 1e-5; s < 3.0 * radius; s += 1e-5) {
        const Indentation now = indentation_at(body, radius, s);
        ASSERT_GT(now.force, before.force);
        ASSERT_GT(now.depth, before.depth);
        const Indentation middle = indentation_at(body, radius, s - 0.5e-5);
        const double slope = (now.force - before.force) / (now.depth - before.depth);
        if (s > 1e-4) {
            ASSERT_NEAR(slope, middle.stiffness, 0.01 * slope) << s;
        }
        before = now;
    }
}

// The spring of the surface and the indentation are in series, at each depth and for each direction of wall.
TEST(LocalCompliance, AHandPressesBothInSeries) {
    const PlacedShape placed{PlaneShape{}, {}};
    auto shape = std::make_shared<TouchShape>(*make_touch_shape({&placed, 1}).shape);
    shape->give = {1e4, 0.004};
    shared::TouchRig rig(radius);
    rig.add(std::shared_ptr<const TouchShape>(shape), {}, {800.0, 2.0, 0.0, 0.0});
    rig.draw({0.0, 0.02, 0.0}, {0.0, radius, 0.0}, 10);
    SafeWalls safe;
    safe.radius = radius;
    double force_before = 0.0, wall_before = 0.0;
    for (int i = 1; i <= 400; ++i) {
        const double step = 5e-5;
        const Vec3 hand(0.0, radius - step * i, 0.0);
        const ProxyTick tick = rig.tick(hand);
        const double stretch = rig.proxy.position().y - hand.y;
        const HandForce force =
            contact_force(rig.scene, rig.proxy.touching(), tick.slide, Vec3(0.0), 1e-3, safe);
        double low = 0.0, high = 1.0;
        for (int k = 0; k < 80; ++k) {
            const double s = 0.5 * (low + high);
            const Indentation local = indentation_at(shape->give, radius, s);
            (local.depth + local.force / 800.0 < stretch ? low : high) = s;
        }
        ASSERT_NEAR(force.total.y, indentation_at(shape->give, radius, low).force, 1e-6) << i;
        const Wall& wall = force.contacts[0].wall;
        if (i > 20) {  // the slope has a step where the disc is as wide as the sphere
            const double slope = (force.total.y - force_before) / step;
            ASSERT_GT(slope, std::min(wall.stiffness, wall_before) - 1.0) << i;
            ASSERT_LT(slope, std::max(wall.stiffness, wall_before) + 1.0) << i;
        }
        ASSERT_NEAR(wall.damping, 2.0 * std::pow(wall.stiffness / 800.0, 2.0), 1e-9);
        ASSERT_EQ(force.contacts[0].wanted_stiffness, wall.stiffness);
        force_before = force.total.y;
        wall_before = wall.stiffness;
    }
}

}  // namespace
}  // namespace tactus::local_compliance_test
