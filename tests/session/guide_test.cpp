// A guide beside a wall, on a device whose damping bears only so much of both.
#include <gtest/gtest.h>

#include "session_rig.hpp"

namespace tactus::guide_test {
namespace {

using namespace session_test;

TEST(Guide, GuideAndWallTogetherAreNoStifferThanIsSafe) {
    SessionRig rig;
    rig.device.can.damping = 0.4;  // bears 800 N/m at 1 kHz
    BodyAddition wall = ground();
    wall.touch_material.stiffness = 10'000.0;
    rig.add(wall);
    rig.device.position = {0.0, 0.05, 0.0};
    rig.tick();
    rig.draw({0.0, 0.0, 0.0}, 50);
    rig.ticks(200);
    EXPECT_NEAR(rig.device.force.y, 800.0 * 0.01, 1e-3);

    ProxyDescription led;
    led.device = rig.hand;
    led.settings.radius = 0.01;
    led.guide.form = HandGuide::Form::point;
    led.guide.points[0] = {0.0, -0.02, 0.0};
    led.guide.count = 1;
    led.guide.stiffness = 5'000.0;
    led.guide.range = 0.1;
    rig.session.set_proxy(rig.proxy, led);
    rig.ticks(500);
    EXPECT_NEAR(rig.device.force.y, 400.0 * 0.01 - 400.0 * 0.02 * 0.8, 1e-3);
}

TEST(Guide, WhatLeadsNowhereIsRefused) {
    SessionRig rig;
    ProxyDescription led;
    led.device = rig.hand;
    led.guide.form = HandGuide::Form::line;
    EXPECT_NE(rig.session.add_proxy(led).error, "");
}

}  // namespace
}  // namespace tactus::guide_test
