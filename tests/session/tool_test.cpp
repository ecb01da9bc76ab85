// Tools beside fingertips: what the hand feels of them, and what they do to bodies.
#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "session_rig.hpp"
#include "shared/meshes.hpp"
#include "shared/stack_figures.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::tool_test {
namespace {

using namespace session_test;

// A bar of 200 mm along x, 20 mm thick.
std::shared_ptr<const ToolShape> bar() {
    static const ToolShapeResult made = make_tool_shape(shared::box({0.1, 0.01, 0.01}), {1e-3, 500});
    return made.shape;
}

class ToolRig : public SessionRig {
public:
    explicit ToolRig(const SessionSettings& settings = {}) : SessionRig(settings) {
        session.remove_proxy(proxy);
        use.device = hand;
        let_turn(device);
        device.position = {0.0, 0.1, 0.0};
        tool = session.add_tool(bar(), use).handle;
    }
    const ToolState& tool_state() { return newest().tools[0]; }

    ToolUse use;
    SessionHandle tool = no_handle;
};

SessionSettings weightless() {
    SessionSettings settings;
    settings.physics.gravity = Vec3(0.0);
    return settings;
}

TEST(Tool, PressedAndTurnedOnTheGroundItGivesForceAndTorque) {
    ToolRig rig;
    rig.add(ground());
    rig.ticks(2);
    EXPECT_EQ(rig.tool_state().status, 0u);
    rig.draw({0.0, 0.006, 0.0}, 100);
    rig.device.rotation = glm::angleAxis(0.05, Vec3(0.0, 0.0, 1.0));
    rig.ticks(50);
    const ToolState& state = rig.tool_state();
    EXPECT_EQ(state.status, static_cast<std::uint32_t>(tool_touching));
    EXPECT_NEAR(state.force.y, 4.0, 1.0);  // 1000 N/m, and the spheres are up to 1 mm inside
    EXPECT_NEAR(state.torque.z, -0.05, 2e-3);
    EXPECT_NEAR(rig.device.force.y, state.force.y, 1e-9);
    EXPECT_NEAR(rig.device.torque.z, state.torque.z, 1e-9);
}

// Some are off by rounding in single precision; the clutch multiplies them, again and again.
TEST(Tool, ARotationThatIsNearlyOneIsMadeOne) {
    ToolRig rig;
    rig.device.rotation = Quat(1.0004, 0.0, 0.0, 0.0);
    rig.ticks(2);
    EXPECT_NEAR(glm::length(rig.tool_state().pose.rotation), 1.0, 1e-12);
    for (int i = 0; i < 20; ++i) {
        Workspace held;
        held.clutch = i % 2 == 0;
        rig.session.set_workspace(rig.hand, held);
        rig.ticks(3);
    }
    EXPECT_NEAR(glm::length(rig.tool_state().hand.rotation), 1.0, 1e-12);
    EXPECT_EQ(rig.tool_state().status, 0u);
}

// Held at its end, it is pressed up at its middle: the hand feels that as a torque.
TEST(Tool, TheTorqueIsAboutTheHand) {
    ToolRig rig;
    rig.add(ground());
    rig.use.grasp.position = {0.1, 0.0, 0.0};
    rig.session.set_tool(rig.tool, rig.use);
    rig.ticks(2);
    rig.draw({0.0, 0.006, 0.0}, 100);
    rig.ticks(50);
    const ToolState& state = rig.tool_state();
    EXPECT_GT(state.force.y, 3.0);
    EXPECT_NEAR(state.torque.z, 0.1 * state.force.y, 2e-3);
}

TEST(Tool, PushesABlockAndMakesNoEnergy) {
    ToolRig rig(weightless());
    BodyAddition block = body(BoxShape{Vec3(0.05)}, {0.2, 0.1, 0.0}, Motion::Dynamic, 0.5);
    const SessionHandle handle = rig.add(block);
    rig.ticks(2);
    rig.draw({0.3, 0.1, 0.0}, 1'000);
    const BodyState* const pushed = rig.state_of(handle);
    ASSERT_NE(pushed, nullptr);
    // As fast as the hand, or twice as fast where it has bounced off the spring.
    EXPECT_GE(pushed->linear_velocity.x, 0.3 - 1e-3);
    EXPECT_LE(pushed->linear_velocity.x, 0.6 + 1e-3);
    EXPECT_GT(pushed->pose.position.x, 0.4);
    EXPECT_LT(glm::length(rig.tool_state().force), 5.0);
}

// Two hundred grams between a tool and the ground: at rest, and the ground bears what the hand presses with.
TEST(Tool, PressesABlockOntoTheGroundAndNothingRings) {
    ToolRig rig;
    rig.add(ground());
    BodyAddition block = body(BoxShape{Vec3(0.03)}, {0.0, 0.03, 0.0}, Motion::Dynamic, 0.2);
    block.touch_material = {1000.0, 0.0, 0.5, 0.4};
    const SessionHandle handle = rig.add(block);
    rig.ticks(200);
    rig.draw({0.0, 0.066, 0.0}, 200);
    rig.ticks(300);
    const Vec3 before = rig.state_of(handle)->pose.position;
    const Vec3 force = rig.tool_state().force;
    EXPECT_NEAR(force.y, 4.0, 1.2);
    rig.ticks(500);
    EXPECT_LT(glm::distance(rig.state_of(handle)->pose.position, before), 1e-5);
    EXPECT_LT(glm::distance(rig.tool_state().force, force), 0.02);
}

// A box turns away under a tool that is pressed onto it near an edge, 3 mm deep. In a tick the force changes
// by what the edge has gone, twice at most, and not by all that the tool has slipped.
TEST(Tool, ItsForceFadesWhereItSlipsOffATurningBody) {
    const ToolShapeResult cube = make_tool_shape(shared::box(Vec3(0.005)), {1e-3, 500});
    for (const double rate : {2.0, 4.0, 8.0}) {
        for (const double friction : {0.0, 0.3}) {
            ToolRig rig(weightless());
            rig.session.remove_tool(rig.tool);
            rig.session.add_tool(cube.shape, rig.use);
            BodyAddition turning = body(BoxShape{Vec3(0.04)}, Vec3(0.0), Motion::Kinematic);
            turning.touch_material.static_friction = turning.touch_material.dynamic_friction = friction;
            const SessionHandle id = rig.add(turning);
            rig.draw({0.0, 0.05, 0.035}, 100);
            rig.draw({0.0, 0.042, 0.035}, 100);
            rig.session.set_body_velocity(id, Vec3(0.0), {-rate, 0.0, 0.0});
            const double way = rate * std::hypot(0.045, 0.045) * 1e-3;  // of the edge in a tick
            Vec3 before = rig.device.force;
            double most = 0.0;
            for (int i = 0; i < 800; ++i) {
                rig.tick();
                most = std::max(most, glm::distance(rig.device.force, before));
                before = rig.device.force;
            }
            EXPECT_GT(most, 0.2);
            EXPECT_LT(most, std::max(1.02 * FadingForce::max_step, 2.0 * rig.use.settings.stiffness * way))
                << rate << " rad/s, friction " << friction;
        }
    }
}

// Blocks that bounce off one another and off the tool are no squeeze.
TEST(Tool, TopplesAStackAndIsNeverLostInIt) {
    const shared::StackFigures figures = shared::push_stack(0.2, 0.0);
    EXPECT_EQ(figures.lost, 0);
    EXPECT_EQ(figures.tool.penetrations, 0) << figures.tool.deepest;
    EXPECT_GT(figures.tool.contact_ticks, 200);
    EXPECT_LT(figures.highest, 0.15);
}

TEST(Tool, IsTheSameOnEveryRunAndAllocatesNothing) {
    const auto play = [] {
        ToolRig rig(weightless());
        rig.add(body(PlaneShape{}, Vec3(0.0), Motion::Static));
        for (int i = 0; i < 3; ++i) {
            BodyAddition block =
                body(BoxShape{Vec3(0.03)}, {0.2 + 0.1 * i, 0.03, 0.01 * i}, Motion::Dynamic, 0.2);
            block.touch_material = {1000.0, 0.0, 0.5, 0.4};
            rig.add(block);
        }
        rig.session.settle();
        rig.ticks(2);
        std::vector<double> seen;
        testing::AuditScope audit;
        for (int i = 0; i < 400; ++i) {
            rig.device.position = {0.001 * i, 0.1 - 0.0003 * std::min(i, 280), 0.0};
            rig.device.rotation = glm::angleAxis(0.003 * i, glm::normalize(Vec3(0.1, 1.0, 0.2)));
            rig.tick();
        }
        audit.finish();
        EXPECT_EQ(audit.allocations() + audit.frees(), 0u) << audit.describe();
        const ToolState& state = rig.tool_state();
        seen.insert(seen.end(),
                    {state.pose.position.x, state.pose.rotation.w, state.force.x, state.torque.y});
        for (std::size_t i = 0; i < rig.session.snapshot().body_count; ++i) {
            seen.push_back(rig.session.snapshot().bodies[i].pose.position.x);
        }
        return seen;
    };
    EXPECT_EQ(play(), play());
}

TEST(Tool, WhatMakesNoSenseIsRefused) {
    ToolRig rig;
    EXPECT_NE(rig.session.add_tool(nullptr, rig.use).error, "");
    ToolUse wrong = rig.use;
    wrong.settings.stiffness = 0.0;
    EXPECT_NE(rig.session.add_tool(bar(), wrong).error, "");
    for (std::size_t i = 1; i < max_tools; ++i) {
        EXPECT_EQ(rig.session.add_tool(bar(), rig.use).error, "");
    }
    EXPECT_NE(rig.session.add_tool(bar(), rig.use).error, "");
    rig.session.remove_tool(rig.tool);
    rig.tick();
    rig.session.collect();
    EXPECT_EQ(rig.session.add_tool(bar(), rig.use).error, "");
    rig.tick();
    EXPECT_EQ(rig.newest().tool_count, max_tools);
}

}  // namespace
}  // namespace tactus::tool_test
