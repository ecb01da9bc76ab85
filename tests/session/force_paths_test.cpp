// Each path by which a force comes to a hand: within its limit, and nothing without its dead man's button.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/tool/tool_shape.hpp"
#include "session_rig.hpp"
#include "shared/meshes.hpp"

namespace tactus::force_paths_test {
namespace {

using namespace session_test;

constexpr std::uint32_t button = 0b1;

// Nothing else in the scene adds much force to the path that is tested.
struct Path {
    const char* name;
    std::function<void(SessionRig&)> set;
    std::function<void(SessionRig&)> every_tick = [](SessionRig&) {};
};

Path surface(const char* name, const std::function<void(TouchMaterial&)>& change) {
    return {name, [change](SessionRig& rig) {
                BodyAddition floor = ground();
                floor.touch_material.stiffness = 20.0;
                change(floor.touch_material);
                rig.add(floor);
            }};
}

ProxyDescription led_to(const SessionRig& rig, HandGuide::Form form, const Vec3& first, const Vec3& last) {
    ProxyDescription led;
    led.device = rig.hand;
    led.settings.radius = 0.01;
    HandGuide guide;
    guide.form = form;
    guide.points[0] = first;
    guide.points[1] = last;
    guide.count = form == HandGuide::Form::point ? 1 : 2;
    guide.stiffness = 400.0;
    guide.range = 0.2;
    led.aids.add(guide);
    return led;
}

std::vector<Path> paths() {
    return {
        surface("wall", [](TouchMaterial& m) { m.stiffness = 1000.0; }),
        surface("surface damping", [](TouchMaterial& m) { m.damping = 20.0; }),
        surface("magnet", [](TouchMaterial& m) { m.magnet_force = 4.0; }),
        surface("viscosity", [](TouchMaterial& m) { m.viscosity = 10.0; }),
        surface("stick-slip",
                [](TouchMaterial& m) {
                    m.stick_slip_stiffness = 800.0;
                    m.stick_slip_force = 3.0;
                }),
        surface("vibration",
                [](TouchMaterial& m) {
                    m.vibration_force = 4.0;
                    m.vibration_frequency = 80.0;
                }),
        {"a guide's point",
         [](SessionRig& rig) {
             rig.session.set_proxy(rig.proxy,
                                   led_to(rig, HandGuide::Form::point, {0.0, -0.03, 0.0}, Vec3(0.0)));
         }},
        {"a guide's line",
         [](SessionRig& rig) {
             rig.session.set_proxy(rig.proxy,
                                   led_to(rig, HandGuide::Form::line, {-0.1, -0.03, 0.0}, {0.1, -0.03, 0.0}));
         }},
        {"a script's force", [](SessionRig&) {},
         [](SessionRig& rig) {
             FieldMoment moment;
             moment.place = rig.device.position;
             moment.velocity = rig.device.velocity;
             moment.force = {0.0, 3.0, 2.0};
             rig.session.set_hand_field(rig.proxy, moment);
         }},
        {"the weight of an arm", [](SessionRig& rig) { rig.device.can.weight = 3.0; }},
        {"a tool",
         [](SessionRig& rig) {
             let_turn(rig.device);
             rig.add(ground());
             ProxyDescription none;
             none.enabled = false;
             rig.session.set_proxy(rig.proxy, none);
             ToolUse use;
             use.device = rig.hand;
             rig.session.add_tool(make_tool_shape(shared::box({0.03, 0.01, 0.01})).shape, use);
         }},
    };
}

struct Played {
    double most = 0.0, last = 0.0;                // of the force (unit: newtons)
    double most_torque = 0.0, last_torque = 0.0;  // (unit: newton meters)
};

// The hand comes down to the floor and strokes it, 5 mm deep.
Played stroke(SessionRig& rig, const Path& path, int ticks = 600) {
    Played played;
    for (int i = 0; i < ticks; ++i) {
        const double phase = 2.0 * std::numbers::pi * i / 200.0;
        const double before = rig.device.position.y;
        rig.device.position = {0.03 * std::sin(phase), std::max(0.005, 0.05 - 1e-3 * i), 0.0};
        rig.device.velocity = {0.03 * 2.0 * std::numbers::pi * 5.0 * std::cos(phase),
                               1e3 * (rig.device.position.y - before), 0.0};
        path.every_tick(rig);
        rig.tick();
        rig.session.collect();
        played.last = glm::length(rig.device.force);
        played.last_torque = glm::length(rig.device.torque);
        played.most = std::max(played.most, played.last);
        played.most_torque = std::max(played.most_torque, played.last_torque);
    }
    return played;
}

Played stroke_with(const Path& path, double limit, std::uint32_t held, std::uint32_t dead_man = button) {
    SessionRig rig;
    rig.device.can.feels = true;
    path.set(rig);
    Workspace workspace;
    workspace.force_limit = limit;
    workspace.dead_man = dead_man;
    rig.device.buttons = held;
    rig.device.position = {0.0, 0.05, 0.0};
    rig.session.set_workspace(rig.hand, workspace);
    return stroke(rig, path);
}

TEST(ForcePaths, NoneGoesBeyondTheLimit) {
    for (const Path& path : paths()) {
        ASSERT_GT(stroke_with(path, 8.0, button).most, 1.0) << path.name << " gives no force to limit";
        EXPECT_LE(stroke_with(path, 0.5, button).most, 0.5 + 1e-12) << path.name;
        EXPECT_EQ(stroke_with(path, 0.0, button).most, 0.0) << path.name;
    }
}

TEST(ForcePaths, NoneGivesAnythingWithoutTheButton) {
    for (const Path& path : paths()) {
        for (const std::uint32_t held : {0u, 0b10u}) {
            const Played played = stroke_with(path, 8.0, held);
            EXPECT_EQ(played.most, 0.0) << path.name;
            EXPECT_EQ(played.most_torque, 0.0) << path.name;
        }
        EXPECT_GT(stroke_with(path, 8.0, 0, 0).most, 1.0) << path.name << ": where none is asked for";
    }
}

TEST(ForcePaths, NoneOutlivesTheButtonByATick) {
    for (const Path& path : paths()) {
        SessionRig rig;
        rig.device.can.feels = true;
        path.set(rig);
        Workspace workspace;
        workspace.force_limit = 8.0;
        workspace.dead_man = button;
        rig.device.buttons = button;
        rig.device.position = {0.0, 0.05, 0.0};
        rig.session.set_workspace(rig.hand, workspace);
        ASSERT_GT(stroke(rig, path, 333).most, 1.0) << path.name;
        rig.device.buttons = 0;
        const Played after = stroke(rig, path, 20);
        EXPECT_EQ(after.most, 0.0) << path.name;
        EXPECT_EQ(after.most_torque, 0.0) << path.name;
        rig.session.refresh();
        EXPECT_EQ(rig.session.snapshot().devices[0].safety, HandState::released) << path.name;
    }
}

}  // namespace
}  // namespace tactus::force_paths_test
