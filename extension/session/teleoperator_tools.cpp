// The far side's tools: each follows the operator's hand within its own contacts.
#include <algorithm>
#include <array>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <utility>

#include "session/teleoperator_side.hpp"

namespace tactus {

// Neither the device that the tool stands at here nor its grasp have a say in where it is.
void TeleoperatorSide::play(SessionLoop& loop, std::size_t index, ToolSlot& slot) {
    Tool& tool = tools_[index];
    const bool waits = hands_.play(slot, tool.played) == Playing::waiting;
    const bool is_given = slot.hand.holds;
    const bool another_goes = tool.is_new && !tool.idle;
    if (waits || another_goes || !tool.played.connected || !is_given ||
        !telling_.may_press(channel_, first_tool + index)) {
        let_go(tool, slot);
        return;
    }
    const Pose& frame = settings().frame;
    tool.goal = compose(frame, Pose{tool.played.position, tool.played.rotation});
    slot.hand.goal = tool.goal;
    slot.hand.place = slot.hand.goal.position;
    slot.hand.velocity = direction_to_parent(frame, tool.played.velocity);
    slot.hand.spin = direction_to_parent(frame, tool.played.spin);
    newest_applied_ = std::max(newest_applied_, tool.played.sequence);
    if (!std::exchange(tool.holds, true)) {
        tool.limit.come();
        if (tool.idle) {
            tool.limit.begin();
            come_back(loop, tool, slot);
        }
    }
    if (settings().traditional && known_press(tool.played)) {
        tool.limit.come();
    }
    if (!PlayedHands::leads(slot) && tool.limit.returns() && is_free(tool) &&
        slot.stretch(slot.state.pose) > slot.proxy.shape().reach) {
        slot.proxy.restart();
    }
    tool.idle = tool.goes = tool.is_new = false;
}

// See let_go() for a pointer.
void TeleoperatorSide::let_go(Tool& tool, ToolSlot& slot) const {
    tool.holds = false;
    tool.goes = true;
    if (tool.idle || !slot.hand.holds || tool.limit.is_gone()) {
        tool.idle = true;
        tool.goes = slot.hand.holds = false;
        return;
    }
    slot.hand.goal = tool.goal;
    slot.hand.place = slot.hand.goal.position;
    slot.hand.velocity = slot.hand.spin = Vec3(0.0);
}

// See draw_back() for a pointer. Tools touch each other, so that all are moved to see where each comes to.
void TeleoperatorSide::draw_back_tools(SessionLoop& loop) {
    const auto hand_of = [&](std::size_t i, const ToolSlot& slot) {
        return tools_[i].goes             ? PressLimit::Hand::goes
               : PlayedHands::leads(slot) ? PressLimit::Hand::guessed
                                          : PressLimit::Hand::here;
    };
    const auto binds = [&](std::size_t i) {
        const ToolSlot* const slot = tool_of(loop, i);
        return slot && slot->hand.holds && tools_[i].limit.binds(hand_of(i, *slot));
    };
    std::array<bool, max_tools> bound{};
    for (std::size_t i = 0; i < share_.most(max_tools); ++i) {
        bound[i] = binds(i);
    }
    if (std::ranges::none_of(bound, std::identity{})) {
        return;
    }
    struct Before {
        ToolMemory memory;
        ToolState state;
        Wrench wrench;
        Vec3 turned{0.0};
    };
    std::array<Before, max_tools> before;
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (const ToolSlot* const slot = loop.tool(i)) {
            before[i] = {slot->proxy.memory(), slot->state, slot->wrench, slot->turned};
        }
    }
    loop.touch_tools();
    for (std::size_t i = 0; i < share_.most(max_tools); ++i) {
        if (bound[i]) {
            ToolSlot& slot = *tool_of(loop, i);
            draw_back(tools_[i], slot, before[share_.proxy_of(i)].state, hand_of(i, slot));
        }
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (ToolSlot* const slot = loop.tool(i)) {
            slot->proxy.recall(before[i].memory, loop.scene());
            slot->state = before[i].state;
            slot->wrench = before[i].wrench;
            slot->turned = before[i].turned;
        }
    }
}

// `slot` is where its contacts let it go in this tick; `before`: the state of the last.
void TeleoperatorSide::draw_back(Tool& tool, ToolSlot& slot, const ToolState& before,
                                 PressLimit::Hand hand) const {
    PressLimit::In in;
    in.hand = hand;
    in.stiffness = slot.use.settings.stiffness;
    in.force = glm::length(before.force);
    in.seconds = seconds_;
    in.is_outage = PlayedHands::is_outage(slot);
    in.own_force = known_press(tool.played);
    tool.limit.step(in);
    const Pose& reached = slot.state.pose;
    const double depth = slot.state.contact_count > 0 ? slot.stretch(reached) : 0.0;
    if (const double most = tool.limit.depth(); depth > most) {
        const Pose& goal = slot.hand.goal;
        const double share = most / depth;
        slot.hand.goal = {reached.position + (goal.position - reached.position) * share,
                          glm::slerp(reached.rotation, goal.rotation, share)};
        slot.hand.place = slot.hand.goal.position;
        slot.hand.velocity = slot.hand.spin = Vec3(0.0);
    }
    tool.limit.applied(hand, depth);
}

void TeleoperatorSide::come_back(SessionLoop& loop, Tool& tool, ToolSlot& slot) const {
    if (const std::optional<Pose> from = way_back(loop, tool.kept, is_free(tool))) {
        ToolMemory memory;
        memory.pose = *from;
        memory.present = true;
        slot.proxy.recall(memory, loop.scene());
    }
}

void TeleoperatorSide::send_wrenches(SessionLoop& loop, Nanoseconds now) {
    WrenchSamples message;
    for (std::size_t i = 0; i < share_.most(max_tools); ++i) {
        const ToolSlot* const slot = tool_of(loop, i);
        if (slot && tools_[i].holds &&
            wrench_is_due(settings().deadband, tools_[i].said, {slot->state.force, slot->state.torque},
                          slot->coupling_length(), now)) {
            message.samples[message.count++] = wrench_of(i, *slot, now);
        }
    }
    if (message.count == 0 || !channel_.try_send(message)) {
        return;
    }
    for (std::size_t i = 0; i < message.count; ++i) {
        const std::size_t index = message.samples[i].pointer - first_tool;
        const ToolState& state = tool_of(loop, index)->state;
        tools_[index].said = {{state.force, state.torque}, now};
    }
}

// With a model: where a tool is that touches something, whenever states of what moves are told. What is done
// again of the model's past needs to have it there, at the same sample: between bodies that are put right it
// might not fit where it was, nor where it is between those that are not yet.
void TeleoperatorSide::tell_tools(SessionLoop& loop, Nanoseconds now) {
    if (!telling_.has_told_states()) {
        return;
    }
    WrenchSamples message;
    for (std::size_t i = 0; i < share_.most(max_tools); ++i) {
        const ToolSlot* const slot = tool_of(loop, i);
        if (slot && tools_[i].holds && slot->state.contact_count > 0) {
            message.samples[message.count++] = wrench_of(i, *slot, now);
        }
    }
    if (message.count > 0) {
        channel_.send(message);
    }
}

WrenchSample TeleoperatorSide::wrench_of(std::size_t index, const ToolSlot& slot, Nanoseconds now) const {
    const ToolState& state = slot.state;
    WrenchSample sample =
        wrench_sample(settings().frame, index, tools_[index].played.sequence, channel_.link().local_time(now),
                      {state.force, state.torque}, state.pose);
    sample.object = state.contact_count > 0 ? static_cast<ObjectId>(state.bodies[0]) : no_object;
    return sample;
}

}  // namespace tactus
