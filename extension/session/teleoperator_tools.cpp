// The far side's tools: each follows the operator's hand within its own contacts.
#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "session/teleoperator_side.hpp"

namespace tactus {

namespace {

// A hand that comes back no farther from where it was lost, in the frame of what it pressed, presses still
// (unit: meters).
constexpr double same_tool_hand = 0.05;

}  // namespace

// Neither the device that the tool stands at here nor its grasp have a say in where it is.
void TeleoperatorSide::play(SessionLoop& loop, Tool& tool, ToolSlot& slot) {
    const bool waits = hands_.play(slot, tool.played) == Playing::waiting;
    if (waits || !tool.played.connected || !slot.hand.holds) {
        if (!std::exchange(tool.idle, true)) {
            keep(loop, tool, slot);
        }
        tool.holds = slot.hand.holds = false;
        return;
    }
    const Pose& frame = settings().frame;
    slot.hand.goal = compose(frame, Pose{tool.played.position, tool.played.rotation});
    slot.hand.place = slot.hand.goal.position;
    slot.hand.velocity = direction_to_parent(frame, tool.played.velocity);
    slot.hand.spin = direction_to_parent(frame, tool.played.spin);
    newest_applied_ = std::max(newest_applied_, tool.played.sequence);
    tool.idle = false;
    if (!std::exchange(tool.holds, true)) {
        come_back(loop, tool, slot);
    }
}

// See keep() and come_back() for a pointer.
void TeleoperatorSide::keep(SessionLoop& loop, Tool& tool, const ToolSlot& slot) const {
    tool.kept_on = slot.state.contact_count > 0 ? slot.state.bodies[0] : no_handle;
    if (const SessionLoop::Body* const under = loop.body(tool.kept_on)) {
        const Pose& pose = loop.scene().body(under->slot).pose;
        tool.kept_tool = compose(inverse(pose), slot.state.pose);
        tool.kept_hand = to_local(pose, slot.state.hand.position);
    }
}

void TeleoperatorSide::come_back(SessionLoop& loop, Tool& tool, ToolSlot& slot) const {
    const SessionLoop::Body* const under = loop.body(std::exchange(tool.kept_on, no_handle));
    if (!under) {
        return;
    }
    const Pose& pose = loop.scene().body(under->slot).pose;
    if (glm::distance(to_parent(pose, tool.kept_hand), slot.hand.goal.position) <= same_tool_hand) {
        ToolMemory memory;
        memory.pose = compose(pose, tool.kept_tool);
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
