// Two hands with a tool each in one session.
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "core/haptics/fading_force.hpp"
#include "recorded_inputs.hpp"
#include "session_rig.hpp"
#include "shared/meshes.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::tool_pair_test {
namespace {

using namespace session_test;

std::shared_ptr<const ToolShape> bar() {
    static const ToolShapeResult made = make_tool_shape(shared::box({0.06, 0.01, 0.01}), {1e-3, 400});
    return made.shape;
}

std::shared_ptr<const ToolShape> plate() {
    static const ToolShapeResult made = make_tool_shape(shared::box({0.04, 0.02, 0.04}), {1e-3, 400});
    return made.shape;
}

// A bar over a plate, far above the ground.
class TwoTools : public SessionRig {
public:
    explicit TwoTools(InputRecorder* recorder = nullptr) : SessionRig({}, recorder) {
        session.remove_proxy(proxy);
        let_turn(device);
        let_turn(other);
        device.position = {0.0, 1.06, 0.0};
        other.position = {0.0, 1.0, 0.0};
        Workspace workspace;
        workspace.force_limit = 1e6;
        use.device = hand;
        other_use.device = session.add_device(other, workspace).handle;
        tool = session.add_tool(bar(), use).handle;
        other_tool = session.add_tool(plate(), other_use).handle;
        ticks(2);
    }
    const ToolState& state(std::size_t i) { return newest().tools[i]; }
    void press(double y = 1.024) { draw({0.01, y, 0.0}, 100); }
    // One of the two has gone: neither hand is kicked, and soon none is given anything.
    void expect_to_fade() {
        EXPECT_GT(glm::length(device.force), 2.0);
        EXPECT_GT(glm::length(other.force), 2.0);
        for (int i = 0; i < 20; ++i) {
            const Vec3 first = device.force, second = other.force;
            ticks(1);
            EXPECT_LE(glm::distance(device.force, first), FadingForce::max_step + 1e-9);
            EXPECT_LE(glm::distance(other.force, second), FadingForce::max_step + 1e-9);
        }
        EXPECT_LT(glm::length(device.force) + glm::length(other.force), 1e-6);
    }

    HeldDevice other;
    ToolUse use, other_use;
    SessionHandle tool = no_handle, other_tool = no_handle;
};

TEST(ToolPair, BothHandsFeelTheSameWrenchTurnedAround) {
    TwoTools rig;
    EXPECT_EQ(rig.state(0).status, 0u);
    rig.press();
    rig.device.rotation = glm::angleAxis(0.05, Vec3(0.0, 0.0, 1.0));
    rig.ticks(60);
    const ToolState first = rig.state(0);
    const ToolState second = rig.state(1);
    EXPECT_GT(first.force.y, 2.0);
    EXPECT_LT(glm::length(first.force + second.force), 1e-3 * first.force.y);
    EXPECT_LT(glm::distance(rig.device.force, first.force), 1e-9);
    EXPECT_LT(glm::distance(rig.other.torque, second.torque), 1e-9);
    // About one place, of what acts on the tools at their origins.
    const auto about = [&](const ToolState& state) {
        return state.torque + glm::cross(state.hand.position - first.pose.position, state.force) +
               glm::cross(state.pose.position - state.hand.position, state.force);
    };
    EXPECT_LT(glm::length(about(first) + about(second)), 1e-3 * glm::length(about(first)) + 1e-4);
    ASSERT_GT(first.contact_count, 0);
    EXPECT_EQ(first.bodies[0], no_handle);
    EXPECT_EQ(first.tools[0], rig.other_tool);
    EXPECT_EQ(second.tools[0], rig.tool);
    EXPECT_LT(glm::length(first.normals[0] + second.normals[0]), 1e-12);
}

TEST(ToolPair, StillHandsMoveNothing) {
    TwoTools rig;
    rig.press();
    rig.ticks(60);
    const Pose before[2] = {rig.state(0).pose, rig.state(1).pose};
    rig.ticks(200);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(rig.state(i).pose.position, before[i].position);
        EXPECT_EQ(rig.state(i).pose.rotation, before[i].rotation);
    }
}

// What is left of a coupling that is not safe to render is what the other hand feels, too.
TEST(ToolPair, WhatADeviceCannotRenderTheOtherDoesNotFeel) {
    TwoTools rig;
    rig.device.can.delay = 0.01;
    rig.device.can.damping = 1.0;
    rig.session.set_tool(rig.tool, rig.use);
    rig.press();
    rig.ticks(60);
    EXPECT_GT(rig.state(0).force.y, 0.01);
    EXPECT_LT(rig.state(0).force.y, 6.0);
    EXPECT_LT(glm::length(rig.state(0).force + rig.state(1).force), 2e-3 * rig.state(0).force.y + 1e-4);
}

TEST(ToolPair, OneThatGoesLetsTheOtherGoAndOneThatComesIsMet) {
    TwoTools rig;
    rig.press();
    rig.ticks(20);
    EXPECT_GT(rig.state(0).force.y, 2.0);
    rig.session.remove_tool(rig.tool);
    rig.expect_to_fade();
    EXPECT_EQ(rig.newest().tool_count, 1u);
    rig.session.collect();
    rig.device.position.y = 1.06;
    EXPECT_EQ(rig.session.add_tool(bar(), rig.use).handle, rig.tool);
    rig.ticks(2);
    rig.press();
    rig.ticks(20);
    EXPECT_GT(rig.state(0).force.y, 2.0);
    // The one that was there first goes as well.
    rig.session.remove_tool(rig.other_tool);
    rig.expect_to_fade();
    rig.session.collect();
}

TEST(ToolPair, OneThatIsNotEnabledIsNotThere) {
    TwoTools rig;
    rig.other_use.enabled = false;
    rig.session.set_tool(rig.other_tool, rig.other_use);
    rig.press();
    EXPECT_LT(glm::length(rig.state(0).force), 1e-6);
    rig.other_use.enabled = true;  // in the other one: it waits
    rig.session.set_tool(rig.other_tool, rig.other_use);
    rig.ticks(3);
    EXPECT_EQ(rig.state(1).status, static_cast<std::uint32_t>(tool_absent));
    rig.draw({0.0, 1.06, 0.0}, 50);
    EXPECT_EQ(rig.state(1).status, 0u);
    rig.press();
    rig.ticks(20);
    EXPECT_GT(rig.state(0).force.y, 2.0);
}

TEST(ToolPair, MasksSayWhetherTheyMeet) {
    TwoTools rig;
    rig.use.settings.layer = 2;
    rig.other_use.settings.mask = 1;
    rig.session.set_tool(rig.tool, rig.use);
    rig.session.set_tool(rig.other_tool, rig.other_use);
    rig.press();
    EXPECT_LT(glm::length(rig.state(0).force), 1e-6);
    ToolUse wrong = rig.use;
    wrong.settings.static_friction = -1.0;
    EXPECT_NE(rig.session.add_tool(bar(), wrong).error, "");
}

// The lower tool stands on a block that stands on the ground: it bears both hands.
TEST(ToolPair, OnePressesABlockThroughTheOther) {
    TwoTools rig;
    rig.add(ground());
    BodyAddition block = body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.0}, Motion::Dynamic, 0.5);
    block.touch_material = {1000.0, 0.0, 0.5, 0.4};
    const SessionHandle handle = rig.add(block);
    rig.ticks(200);
    for (int i = 1; i <= 300; ++i) {
        rig.other.position.y = 1.0 - (1.0 - 0.118) * i / 300.0;
        rig.device.position.y = 1.06 - (1.06 - 0.146) * i / 300.0;
        rig.tick();
    }
    rig.ticks(300);
    const Vec3 before = rig.state_of(handle)->pose.position;
    EXPECT_GT(rig.state(0).force.y, 1.0);
    EXPECT_GT(rig.state(0).force.y + rig.state(1).force.y, 2.0);
    rig.ticks(300);
    EXPECT_LT(glm::distance(rig.state_of(handle)->pose.position, before), 2e-5);
}

TEST(ToolPair, IsTheSameOnEveryRunAndAllocatesNothing) {
    const auto play = [] {
        TwoTools rig;
        std::vector<double> seen;
        testing::AuditScope audit;
        for (int i = 0; i < 300; ++i) {
            rig.device.position = {0.01 * std::sin(0.05 * i), 1.06 - 0.0003 * std::min(i, 130), 0.0};
            rig.device.rotation =
                glm::angleAxis(0.1 * std::sin(0.03 * i), glm::normalize(Vec3(0.5, 0.2, 1.0)));
            rig.other.position = {0.0, 1.0, 0.003 * std::sin(0.04 * i)};
            rig.tick();
        }
        audit.finish();
        EXPECT_EQ(audit.allocations() + audit.frees(), 0u) << audit.describe();
        for (std::size_t i = 0; i < 2; ++i) {
            const ToolState& state = rig.state(i);
            seen.insert(seen.end(),
                        {state.pose.position.x, state.pose.rotation.w, state.force.y, state.torque.z});
        }
        return seen;
    };
    EXPECT_EQ(play(), play());
}

TEST(ToolPair, ARecordingGivesTheSameBitsAgain) {
    RecordedInputs inputs;
    TwoTools rig(&inputs.recorder);
    for (int i = 0; i < 600; ++i) {
        rig.device.position = {0.02 * std::sin(0.02 * i), 1.06 - 0.0003 * std::min(i, 130), 0.0};
        rig.other.position = {0.0, 1.0 + 0.002 * std::sin(0.07 * i), 0.0};
        if (i == 400) {
            rig.session.remove_tool(rig.other_tool);
        }
        rig.tick();
        if (i % 16 == 15) {
            rig.session.collect();
            inputs.drain();
        }
    }
    inputs.end();
    expect_whole(inputs.play(), 602);
}

}  // namespace
}  // namespace tactus::tool_pair_test
