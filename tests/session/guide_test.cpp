// A guide beside a wall, on a device whose damping bears only so much of both.
#include <gtest/gtest.h>

#include <memory>

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
    HandGuide guide;
    guide.form = HandGuide::Form::point;
    guide.points[0] = {0.0, -0.02, 0.0};
    guide.count = 1;
    guide.stiffness = 5'000.0;
    guide.range = 0.1;
    led.aids.add(guide);
    rig.session.set_proxy(rig.proxy, led);
    rig.ticks(500);
    EXPECT_NEAR(rig.device.force.y, 400.0 * 0.01 - 400.0 * 0.02 * 0.8, 1e-3);
}

TEST(Guide, WhatLeadsNowhereIsRefused) {
    SessionRig rig;
    ProxyDescription led;
    led.device = rig.hand;
    HandGuide guide;
    guide.form = HandGuide::Form::line;
    led.aids.add(guide);
    EXPECT_NE(rig.session.add_proxy(led).error, "");
    led.aids.guide_count = 5;
    EXPECT_NE(rig.session.add_proxy(led).error, "");
}

// Held at 300 N/m to a guide that goes along with a node at 60 frames a second and 0.2 m/s.
TEST(Guide, AGuideThatMovesGoesEvenly) {
    SessionRig rig;
    ProxyDescription led;
    led.device = rig.hand;
    led.settings.radius = 0.01;
    HandGuide guide;
    guide.form = HandGuide::Form::point;
    guide.mode = HandGuide::Mode::hold;
    guide.count = 1;
    guide.stiffness = 300.0;
    led.aids.add(guide);
    rig.session.set_proxy(rig.proxy, led);
    rig.ticks(100);
    double before = rig.proxy_state().force.x, largest = 0.0;
    for (int frame = 1; frame <= 30; ++frame) {
        Session::GuideFrames frames{};
        frames[0].position.x = 0.2 * 0.016 * frame;
        rig.session.set_guide_frames(rig.proxy, frames);
        for (int i = 0; i < 16; ++i) {
            rig.tick();
            largest = std::max(largest, std::abs(rig.proxy_state().force.x - before));
            before = rig.proxy_state().force.x;
        }
    }
    rig.ticks(20);
    EXPECT_NEAR(rig.proxy_state().force.x, 300.0 * 0.2 * 0.016 * 30, 1e-9);
    EXPECT_LE(largest, 300.0 * 0.2 * 1.3e-3);  // the way of one tick, and not that of a frame
}

// Points that many hands share are freed by the owner, when no hand has them any more.
TEST(Guide, TheOwnerLetsGoOfAWayAfterTheLoop) {
    SessionRig rig;
    ProxyDescription led;
    led.device = rig.hand;
    HandGuide guide;
    guide.form = HandGuide::Form::way;
    guide.way = GuideWay::of({{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}});
    const std::weak_ptr<const GuideWay> watched = guide.way;
    led.aids.add(guide);
    rig.session.set_proxy(rig.proxy, led);
    guide = {};
    led = {};
    led.device = rig.hand;
    rig.ticks(3);
    rig.session.collect();
    EXPECT_FALSE(watched.expired());
    rig.session.set_proxy(rig.proxy, led);
    rig.ticks(3);
    EXPECT_FALSE(watched.expired());  // the loop has let go, and has freed nothing
    rig.session.collect();
    EXPECT_TRUE(watched.expired());
}

}  // namespace
}  // namespace tactus::guide_test
