// A robot that carries a tool: it goes and, where it can, turns so that the tool is where the operator's hand
// would have it. The grasp is how the tool is mounted on the robot.
//
// A robot that does not turn holds the tool as it is mounted. It says so, and the operator's tool is held
// alike (OperatorSide::hold_fixed_tools). One that turns but has nothing to hold its wrist by does not move:
// what it carries would go wherever it is pushed.
#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "session/robot_side.hpp"

namespace tactus {

namespace {

// About the handle's place: no device tells its own (unit: kilogram square meters).
constexpr double usual_inertia = 1e-4;

Quat handle_of(const ToolSlot& slot) {
    return glm::normalize(slot.hand.goal.rotation * glm::conjugate(slot.use.grasp.rotation));
}

}  // namespace

RobotSide::Wrist RobotSide::wrist_of(const RobotView& robot) {
    if (!robot.connected) {
        return Wrist::unknown;
    }
    const DeviceCapabilities& can = robot.capabilities;
    return !can.rotates ? Wrist::stiff : can.max_torque > 0.0 ? Wrist::driven : Wrist::loose;
}

void RobotSide::play(SessionLoop& loop, std::size_t index, ToolSlot& slot) {
    Tool& tool = tools_[index];
    const bool waits = hands_.play(slot, tool.played) == Playing::waiting;
    const RobotView robot = loop.robot(slot.use.device);
    tool.wrist = wrist_of(robot);
    const bool can_hold = tool.wrist == Wrist::stiff || tool.wrist == Wrist::driven;
    const bool answers = can_hold && slot.hand.holds;
    if (waits || !tool.played.connected || !answers || !channel_.link().hears_peer() ||
        !telling_.may_press(channel_, first_tool + index)) {
        tool.holds = false;
        return;
    }
    if (!std::exchange(tool.holds, true)) {
        tool.target = {slot.hand.place, handle_of(slot)};
        tool.had_place = slot.hand.place;
        tool.returns = false;
        tool.observer.reset();
        tool.twist_observer.reset();
    }
    feel(loop, tool, slot, robot);
    statistics_.sample = std::max(statistics_.sample, tool.played.sequence);
    tool.wanted = compose(settings().frame, Pose{tool.played.position, tool.played.rotation});
    const double left = glm::distance(tool.wanted.position, slot.hand.goal.position);
    tool.returns = hands_.is_outage(slot) || (tool.returns && left > slot.proxy.shape().reach);
    lead(tool, slot, robot);
}

// What pushes and turns it. A stiff wrist bears what would turn it, and nobody measures that.
void RobotSide::feel(SessionLoop& loop, Tool& tool, const ToolSlot& slot, const RobotView& robot) const {
    // Forces keep their size in the scene, ways do not.
    const double scale = robot.workspace.scale;
    const Vec3 velocity = slot.hand.velocity_at(slot.hand.place) / scale;
    tool.contact.force =
        tool.observer.observe(body_of(robot.capabilities), loop.given_force(slot), velocity, seconds_);
    tool.contact.torque = Vec3(0.0);
    if (tool.wrist == Wrist::driven) {
        const RobotBody wrist{usual_inertia * scale, 0.0, 0.0, 0.0};
        tool.contact.torque =
            tool.twist_observer.observe(wrist, loop.given_torque(slot), slot.hand.spin, seconds_) +
            glm::cross(slot.hand.place - slot.hand.goal.position, tool.contact.force);
    }
}

// The stand-in is the spring, whichever scheme is chosen. No part of the tool goes faster about its origin
// than the robot's place may.
void RobotSide::lead(Tool& tool, const ToolSlot& slot, const RobotView& robot) const {
    const double scale = robot.workspace.scale;
    const double most = settings().stand_in.speed, reach = slot.proxy.shape().reach;
    const double length = slot.coupling_length();
    const Pose& grasp = slot.use.grasp;
    const double spin = glm::length(tool.played.spin);
    const double turning = follow_speed(spin * reach, most) / reach;
    const double speed =
        follow_speed(glm::length(tool.played.velocity) + spin * glm::length(grasp.position), most);
    const Pose before = tool.target;
    tool.coupling = coupling_of(robot);
    tool.turning = {tool.coupling.stiffness * length * length, tool.coupling.damping * length * length};
    tool.target.rotation =
        tool.wrist == Wrist::driven
            ? next_turn(before.rotation, tool.wanted.rotation * glm::conjugate(grasp.rotation), turning,
                        seconds_)
            : handle_of(slot);
    tool.target.position =
        next_target(before.position, tool.wanted.position - tool.target.rotation * grasp.position, speed,
                    robot.workspace.pose.position, robot.capabilities.radius * scale, seconds_);
    if (const auto most_pressed = most_press(tool.played, tool.returns)) {
        const double friction = friction_at(robot, slot.hand.velocity_at(slot.hand.place));
        tool.target.position =
            yielding(tool.target.position, slot.hand.place, *most_pressed, friction, tool.coupling);
    }
    tool.velocity = (tool.target.position - before.position) / seconds_;
    tool.spin = turn_vector(tool.target.rotation * glm::conjugate(before.rotation)) / seconds_;
}

void RobotSide::drive(const Tool& tool, ToolSlot& slot) {
    ToolState& state = slot.state;
    const ToolHand& hand = slot.hand;
    state.pose = hand.goal;
    state.hand = tool.holds ? tool.wanted : hand.goal;
    state.status = tool.wrist == Wrist::stiff   ? static_cast<std::uint32_t>(tool_turn_fixed)
                   : tool.wrist == Wrist::loose ? static_cast<std::uint32_t>(tool_wrist_loose)
                                                : 0u;
    state.force = state.torque = Vec3(0.0);
    if (!tool.holds) {
        return;
    }
    state.force = drive_force(tool.coupling, tool.target.position, tool.velocity, hand.place,
                              hand.velocity_at(hand.place));
    if (tool.wrist == Wrist::driven) {
        state.torque =
            drive_torque(tool.turning, tool.target.rotation, tool.spin, handle_of(slot), hand.spin);
    }
}

// Without a model what is felt is told when it changes. With one, where the tool is, as often as what moves:
// whether it can turn is known by that.
void RobotSide::tell_tools(SessionLoop& loop, Nanoseconds now) {
    const bool whole = settings().traditional;
    const bool its_turn = whole || ++tool_tick_ % settings().states_every == 0;
    WrenchSamples message;
    for (std::size_t i = 0; i < max_tools; ++i) {
        Tool& tool = tools_[i];
        const ToolSlot* const slot = loop.tool(i);
        if (!slot || !tool.holds) {
            continue;
        }
        statistics_.energy.far_J += glm::dot(tool.contact.force, slot->hand.place - tool.had_place);
        tool.had_place = slot->hand.place;
        const double length = slot->coupling_length();
        if (its_turn &&
            (!whole || wrench_is_due(settings().deadband, tool.said, tool.contact, length, now))) {
            WrenchSample& sample = message.samples[message.count++];
            sample = wrench_sample(settings().frame, i, tool.played.sequence, channel_.link().local_time(now),
                                   tool.contact, slot->hand.goal);
            sample.fixed = tool.wrist == Wrist::stiff;
        }
    }
    if (message.count == 0 || !channel_.try_send(message)) {
        return;
    }
    for (std::size_t i = 0; i < message.count; ++i) {
        Tool& tool = tools_[message.samples[i].pointer - first_tool];
        tool.said = {tool.contact, now};
    }
}

}  // namespace tactus
