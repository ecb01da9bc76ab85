// Effects in closed form on a hand: felt at every tick, within what is safe and allowed.
#include "core/haptics/hand_effect.hpp"

#include <glm/geometric.hpp>

#include "core/haptics/fading_force.hpp"
#include "core/tool/tool_shape.hpp"
#include "session_rig.hpp"
#include "shared/meshes.hpp"

namespace tactus::hand_effects_test {
namespace {

using namespace session_test;

HandEffect effect_of(HandEffect::Form form) {
    HandEffect effect;
    effect.form = form;
    effect.direction = {1.0, 0.0, 0.0};
    return effect;
}

void give(SessionRig& rig, std::initializer_list<HandEffect> effects) {
    ProxyDescription description;
    description.device = rig.hand;
    description.settings.radius = 0.01;
    for (const HandEffect& effect : effects) {
        description.aids.effects.items[description.aids.effects.count++] = effect;
    }
    rig.session.set_proxy(rig.proxy, description);
}

TEST(HandEffects, ASpringIsFeltAtEveryTick) {
    SessionRig rig;
    give(rig, {effect_of(HandEffect::Form::spring)});
    rig.ticks(200);
    for (int i = 0; i < 200; ++i) {
        rig.device.position.x += 1e-4;
        rig.tick();
        ASSERT_NEAR(rig.proxy_state().force.x, -200.0 * rig.device.position.x, 1e-9) << i;
    }
}

TEST(HandEffects, SeveralAddUp) {
    SessionRig rig;
    HandEffect ramp = effect_of(HandEffect::Form::ramp);
    ramp.duration = 0.5;
    give(rig, {effect_of(HandEffect::Form::spring), effect_of(HandEffect::Form::constant), ramp});
    rig.device.position.x = 0.01;
    rig.ticks(1000);
    EXPECT_NEAR(rig.proxy_state().force.x, -2.0 + 1.0 + 1.0, 1e-9);
}

// A force that begins, goes or is another one is no kick.
TEST(HandEffects, AForceComesAndGoesGradually) {
    SessionRig rig;
    rig.ticks(5);
    HandEffect strong = effect_of(HandEffect::Form::constant);
    strong.force = 5.0;
    double before = 0.0, largest = 0.0;
    const auto watch = [&](int count) {
        for (int i = 0; i < count; ++i) {
            rig.tick();
            largest = std::max(largest, std::abs(rig.device.force.x - before));
            before = rig.device.force.x;
        }
    };
    give(rig, {strong});
    watch(200);
    EXPECT_NEAR(before, 5.0, 1e-9);
    give(rig, {});
    watch(200);
    EXPECT_EQ(before, 0.0);
    EXPECT_LE(largest, FadingForce::max_step + 1e-9);
}

TEST(HandEffects, NoneIsStifferThanIsSafe) {
    SessionRig rig;
    rig.device.can.feels = true;
    rig.device.can.damping = 0.2;  // of which half is for effects: 0.1 / 0.5 ms
    HandEffect wall = effect_of(HandEffect::Form::spring);
    wall.stiffness = 5000.0;
    give(rig, {wall});
    rig.ticks(100);
    rig.device.position.x = 0.01;
    rig.ticks(300);
    EXPECT_NEAR(rig.proxy_state().force.x, -0.01 * 200.0, 1e-6);
}

TEST(HandEffects, TheDevicesLimitHolds) {
    SessionRig rig;
    Workspace workspace;
    workspace.force_limit = 3.0;
    rig.session.set_workspace(rig.hand, workspace);
    HandEffect strong = effect_of(HandEffect::Form::constant);
    strong.force = 50.0;
    give(rig, {strong});
    rig.ticks(1000);
    EXPECT_NEAR(glm::length(rig.device.force), 3.0, 1e-9);
}

// A tool feels what acts on its hand as a pointer does.
TEST(HandEffects, AToolFeelsThemAtTheDevicePosition) {
    SessionRig rig;
    rig.session.remove_proxy(rig.proxy);
    ToolUse use;
    use.device = rig.hand;
    use.grasp.position = {0.05, 0.0, 0.0};
    use.aids.effects.items[0] = effect_of(HandEffect::Form::spring);
    use.aids.effects.count = 1;
    HandGuide guide;
    guide.form = HandGuide::Form::point;
    guide.mode = HandGuide::Mode::hold;
    guide.count = 1;
    guide.points[0] = {0.01, 0.02, 0.0};
    guide.stiffness = 300.0;
    use.aids.add(guide);
    const ToolShapeResult bar = make_tool_shape(shared::box({0.1, 0.01, 0.01}), {1e-3, 500});
    const SessionHandle tool = rig.session.add_tool(bar.shape, use).handle;
    rig.device.position = {0.01, 0.01, 0.0};
    rig.ticks(200);
    EXPECT_LT(glm::distance(rig.newest().tools[0].force, Vec3(-2.0, -2.0 + 3.0, 0.0)), 1e-9);
    FieldMoment moment;
    moment.place = rig.device.position;
    moment.force = {0.0, 0.0, 1.0};
    for (int i = 0; i < 20; ++i) {
        rig.session.set_hand_field(hand_of_tool(tool), moment);
        rig.ticks(16);
    }
    EXPECT_NEAR(rig.newest().tools[0].force.z, 1.0, 1e-6);
}

TEST(HandEffects, AToolsHandIsRecordedAsAPointersIs) {
    SessionRig rig;
    rig.session.remove_proxy(rig.proxy);
    ToolUse use;
    use.device = rig.hand;
    use.aids.effects.items[0] = effect_of(HandEffect::Form::spring);
    use.aids.effects.count = 1;
    const ToolShapeResult bar = make_tool_shape(shared::box({0.1, 0.01, 0.01}), {1e-3, 500});
    const SessionHandle tool = rig.session.add_tool(bar.shape, use).handle;
    rig.device.position = {0.01, 0.0, 0.0};
    rig.ticks(200);
    RecorderRing<SessionRecord> ring(64);
    ASSERT_TRUE(rig.session.record(ring, hand_of_tool(tool), no_handle));
    rig.ticks(10);
    int rows = 0;
    ring.drain([&](const SessionRecord& row) {
        ++rows;
        EXPECT_EQ(row.proxy, hand_of_tool(tool));
        EXPECT_NEAR(row.force.x, -2.0, 1e-9);
        EXPECT_NEAR(row.displayed.x, -2.0, 1e-9);
        EXPECT_EQ(row.hand, rig.device.position);
    });
    EXPECT_EQ(rows, 10);
    rig.session.end_recording(ring);
    rig.tick();
}

TEST(HandEffects, TheScenesOwnForceIsGivenBesides) {
    SessionRig rig;
    Workspace workspace;
    workspace.force_limit = 100.0;
    workspace.force = {0.0, -2.0, 0.0};
    give(rig, {effect_of(HandEffect::Form::constant)});
    rig.session.set_workspace(rig.hand, workspace);
    rig.tick();
    EXPECT_LE(glm::length(rig.device.force), 2.0 * FadingForce::max_step);
    rig.ticks(200);
    EXPECT_LT(glm::distance(rig.device.force, Vec3(1.0, -2.0, 0.0)), 1e-9);
}

TEST(HandEffects, WhatCannotBeComputedIsRefused) {
    SessionRig rig;
    ProxyDescription description;
    description.device = rig.hand;
    description.aids.effects.count = 1;
    description.aids.effects.items[0] = effect_of(HandEffect::Form::sine);
    description.aids.effects.items[0].period = 0.0;
    EXPECT_NE(rig.session.add_proxy(description).error, "");
    description.aids.effects.items[0].period = 0.1;
    description.aids.effects.count = 9;
    EXPECT_NE(rig.session.add_proxy(description).error, "");
}

}  // namespace
}  // namespace tactus::hand_effects_test
