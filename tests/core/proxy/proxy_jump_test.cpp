// In which ticks the force may jump (ProxyTick::jumped): what the motion of the hand does not lead to.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <numbers>

#include "core/proxy/proxy.hpp"
#include "shared/meshes.hpp"
#include "shared/poses.hpp"
#include "shared/rough_meshes.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::proxy_jump_test {
namespace {

using shared::at;
using shared::TouchRig;

constexpr double radius = 0.05;

TEST(ProxyJump, ATickWithoutChangesIsNone) {
    for (const bool faceted : {false, true}) {
        TouchRig rig(radius);
        faceted ? rig.add(shared::icosphere(4, 1.0)) : rig.add(SphereShape{1.0});
        rig.tick({0.0, 1.2, 0.0});
        for (int i = 0; i <= 1'000; ++i) {  // in, around half of it, and out
            const double angle = std::numbers::pi * 1e-3 * i;
            const double height = 1.0 + radius - 0.03 * std::sin(angle);
            const ProxyTick tick = rig.tick(height * Vec3(std::sin(angle), std::cos(angle), 0.0));
            ASSERT_FALSE(tick.jumped) << i;
        }
    }
}

TEST(ProxyJump, StaticFrictionThatGivesWay) {
    TouchRig rig(radius);
    rig.add(BoxShape{Vec3(1.0)}, {}, {1000.0, 0.0, 0.5, 0.3});
    const double height = 1.0 + radius - 0.02;
    rig.draw({0.0, 1.1, 0.0}, {0.0, height, 0.0}, 100);
    int jumps = 0;
    for (int i = 0; i <= 300; ++i) {
        const ProxyTick tick = rig.tick({0.0, height, 1e-4 * i});
        EXPECT_EQ(tick.jumped, i == 101) << i;  // more than 0.5 times what is pressed
        jumps += tick.jumped;
    }
    EXPECT_EQ(jumps, 1);
}

// Another body comes by at 100 m/s, which a hand cannot feel come; at 10 m/s it is pushed.
TEST(ProxyJump, WhatIsThrownAtItFasterThanAHandCanFeel) {
    for (const double way : {0.01, 0.1}) {
        TouchRig rig(radius);
        const int box = rig.add(BoxShape{Vec3(0.2)}, at({-1.0, 0.0, 0.0}));
        rig.tick(Vec3(0.0));
        bool jumped = false;
        for (double x = -1.0; x < -0.1; x += way) {
            jumped = rig.tick(Vec3(0.0), box, at({x, 0.0, 0.0})).jumped || jumped;
        }
        EXPECT_EQ(jumped, way > radius) << way;
    }
}

// A hand that is deeper than the axis of the inflated edge: there is no resting place on the edge.
TEST(ProxyJump, AnEdgeThatTheHandIsBehind) {
    TouchRig rig(radius);
    rig.add(shared::icosphere(1, 1.0));
    rig.draw({0.0, 1.2, 0.03}, {0.0, 0.8, 0.03}, 400);
    int jumps = 0;
    for (int i = 0; i <= 4'000; ++i) {
        const double angle = 1e-3 * i;
        const Vec3 before = rig.proxy.position();
        const ProxyTick tick = rig.tick({0.8 * std::sin(angle), 0.8 * std::cos(angle), 0.03});
        const bool far = glm::distance(before, tick.position) > 0.02;
        EXPECT_TRUE(tick.jumped || !far) << i;
        jumps += far;
    }
    EXPECT_GT(jumps, 3);
}

TEST(ProxyJump, EveryTickOfASqueeze) {
    TouchRig rig(radius);
    const int plate = rig.add(BoxShape{Vec3(1.0, 0.1, 1.0)}, at({0.0, 0.5, 0.0}));
    rig.add(BoxShape{Vec3(2.0, 0.1, 2.0)}, at({0.0, -0.1, 0.0}));
    rig.tick({0.0, radius, 0.0});
    for (int i = 0; i < 400; ++i) {
        const double low = std::max(0.08, 0.4 - 0.002 * i);  // 0.4 of the radius too little in the end
        const ProxyTick tick = rig.tick({0.0, 0.045, 0.0}, plate, at({0.0, low + 0.1, 0.0}));
        if (low < 0.1 - 1e-6) {
            EXPECT_TRUE(tick.jumped) << i;
            EXPECT_TRUE(tick.status & proxy_squeezed) << i;
        } else if (i > 0 && low > 0.1 + 1e-6) {
            EXPECT_FALSE(tick.jumped) << i;
        }
    }
}

TEST(ProxyJump, WhatATickDidNotFinish) {
    const TriangleMesh mesh = shared::scanned(6);
    TouchRig rig(0.05);
    rig.add(mesh);
    ProxySettings settings = rig.proxy.settings();
    settings.max_work = 2'000;
    rig.proxy.set_settings(settings);
    rig.draw({0.0, 0.9, 0.0}, {0.0, 0.4, 0.0}, 400);
    rig.tick({0.3, 0.2, 0.1});
    int later = 0;
    bool unfinished = true;
    for (int i = 0; i < 200; ++i) {
        const Vec3 before = rig.proxy.position();
        const ProxyTick tick = rig.tick({0.3, 0.2, 0.1});
        const bool moved = glm::distance(before, tick.position) > 1e-5;
        EXPECT_TRUE(tick.jumped || !moved) << i;
        later += moved && unfinished;
        unfinished = (tick.status & proxy_unfinished) != 0;
    }
    EXPECT_GT(later, 0);
}

}  // namespace
}  // namespace tactus::proxy_jump_test
