// The operator's hand where it holds a tool: what a pointer has (operator_touch.cpp, operator_sending.cpp),
// with a torque. Its changes are hidden whichever stealthy correction is chosen; none is carried along.
#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <utility>

#include "core/safety/limited_force.hpp"
#include "network/plausibility.hpp"
#include "session/operator_side.hpp"

namespace tactus {

namespace {

Pose as_sent(const Pose& pose) {
    return {position_as_sent(pose.position), rotation_as_sent(pose.rotation)};
}

// How far apart two wrenches are, turns counted as FeltTool does (unit: newtons).
double apart(const Wrench& a, const Wrench& b, double length) {
    return glm::distance(a.force, b.force) + glm::distance(a.torque, b.torque) / length;
}

}  // namespace

// What a robot that does not turn carries keeps its rotation, here as there: the hand leads its place alone.
void OperatorSide::hold_fixed_tools(SessionLoop& loop) {
    constexpr double same_turn = 1e-6;  // (unit: radians)
    for (std::size_t i = 0; i < max_tools; ++i) {
        ToolSlot* const slot = loop.tool(i);
        if (!slot || !slot->hand.holds) {
            continue;
        }
        const TraditionalTouch::FarTool& far = traditional_.far_tool(i);
        const bool fixed = settings().robot && far.sample != no_sample && far.fixed;
        Tool& tool = tools_[i];
        const bool was_fixed = std::exchange(tool.fixed, fixed);
        changed_ = changed_ || fixed != was_fixed;
        if (!fixed) {
            continue;
        }
        const Quat turned = far.tool.rotation;
        changed_ = changed_ || angle_between(std::exchange(tool.turned, turned), turned) > same_turn;
        ToolHand& hand = slot->hand;
        const Pose& grasp = slot->use.grasp;
        hand.velocity = hand.velocity_at(hand.place);
        hand.spin = Vec3(0.0);
        hand.goal = compose(Pose{hand.place, turned * glm::conjugate(grasp.rotation)}, grasp);
        hand.fixed = true;
    }
}

void OperatorSide::round_tools(SessionLoop& loop) const {
    const Pose& frame = settings().frame;
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (ToolSlot* const slot = loop.tool(i)) {
            ToolHand& hand = slot->hand;
            hand.goal = compose(frame, as_sent(compose(inverse(frame), hand.goal)));
            hand.velocity =
                direction_to_parent(frame, velocity_as_sent(direction_to_local(frame, hand.velocity)));
            hand.spin = direction_to_parent(frame, spin_as_sent(direction_to_local(frame, hand.spin)));
        }
    }
}

// The tools are left as they were. True where one of them has just come to touch something.
bool OperatorSide::tools_land(SessionLoop& loop) {
    struct Before {
        ToolMemory memory;
        Wrench wrench;
        bool free = true;
    };
    std::array<Before, max_tools> before;
    const auto for_each_held = [&](auto&& use) {
        for (std::size_t i = 0; i < max_tools; ++i) {
            if (ToolSlot* const slot = loop.tool(i); slot && slot->hand.holds) {
                use(*slot, before[i], tools_[i]);
            }
        }
    };
    bool any_held = false;
    for_each_held([&](const ToolSlot& slot, Before& kept, const Tool&) {
        kept = {slot.proxy.memory(), slot.wrench,
                slot.proxy.touching().empty() && slot.proxy.meetings().empty()};
        any_held = true;
    });
    if (!any_held) {
        return false;
    }
    loop.touch_tools();
    bool any = false;
    for_each_held([&](ToolSlot& slot, const Before& kept, Tool& tool) {
        tool.uncorrected = slot.wrench;
        tool.jumped = slot.jumped;
        slot.proxy.recall(kept.memory, loop.scene());
        slot.wrench = kept.wrench;
        any = any || (kept.free && glm::length(tool.uncorrected.force) > no_force);
    });
    return any;
}

// Bodies that the replay would put right might leave a tool no room that it has lost: the next replay has it
// again, where the far side has told it. Where none does for long, the bodies are put right nevertheless.
bool OperatorSide::waits_for_tool(SessionLoop& loop) {
    constexpr std::uint32_t max_replays = 8;
    for (std::size_t i = 0; i < max_tools; ++i) {
        const ToolSlot* const slot = loop.tool(i);
        const ToolSlot* const replayed = resimulator_.twin()->tool(i);
        if (slot && slot->proxy.is_present() && replayed && !replayed->proxy.is_present()) {
            return ++replays_without_tool_ < max_replays;
        }
    }
    replays_without_tool_ = 0;
    return false;
}

// To where the replay has led them. One that it has lost, squeezed by what was put in, stays where it is.
void OperatorSide::recall_tools(SessionLoop& loop) {
    std::array<ToolMemory, max_tools> replayed;
    SessionLoop::ToolPlaces places{};
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (const ToolSlot* const slot = resimulator_.twin()->tool(i); slot && slot->proxy.is_present()) {
            replayed[i] = slot->proxy.memory();
            places[i] = &replayed[i];
        }
    }
    loop.put_tools(places);
}

void OperatorSide::feel_tools(SessionLoop& loop) {
    for (std::size_t i = 0; i < max_tools; ++i) {
        ToolSlot* const slot = loop.tool(i);
        if (slot && slot->hand.holds) {
            feel(loop, i, *slot);
            continue;
        }
        tools_[i].felt.forget();
        tools_[i].passivity.rest();
        tools_[i].known = false;
        if (slot) {
            slot->fading.clear();
        }
    }
}

// As modelled_force() for a pointer: what touch leaps by fades, what a correction changes does not count as
// such a leap.
Wrench OperatorSide::modelled_wrench(const SessionLoop& loop, Tool& tool, ToolSlot& slot, bool changed) {
    if (!corrected_) {
        tool.uncorrected = slot.wrench;
        tool.jumped = slot.jumped;
    }
    const double limit = loop.force_limit(slot);
    tool.uncorrected =
        slot.fading.felt(tool.uncorrected, limit, tool.jumped && !changed, slot.step(), slot.turn());
    tool.uncorrected.force = limited_force(tool.uncorrected.force, limit);
    return slot.fading.goes_on_with(slot.wrench, limit);
}

Wrench OperatorSide::far_wrench(std::size_t index, ToolSlot& slot, bool& changed) {
    Tool& tool = tools_[index];
    const bool answers = traditional_.tool_answers(index, sample_, channel_.link().hears_peer(), silence());
    changed |= std::exchange(tool.answered, answers) != answers;
    Wrench wrench = answers ? traditional_.far_tool(index).wrench : Wrench{};
    const ToolHand& hand = slot.hand;
    wrench.torque =
        hand.fixed ? Vec3(0.0) : wrench.torque + glm::cross(hand.goal.position - hand.place, wrench.force);
    if (tool.known) {
        tool.passivity.moved(tool.given, hand.place - tool.place,
                             turn_vector(hand.goal.rotation * glm::conjugate(tool.hand.rotation)));
    }
    if (!answers) {
        tool.passivity.rest();
    } else if (settings().passivity != Passivity::none) {
        wrench = tool.passivity.pass(wrench, hand.velocity_at(hand.place), hand.spin, slot.coupling_length(),
                                     seconds_);
    }
    traditional_.describe(index, slot, wrench, !settings().robot);
    return wrench;
}

void OperatorSide::feel(SessionLoop& loop, std::size_t index, ToolSlot& slot) {
    Tool& tool = tools_[index];
    const double length = slot.coupling_length();
    bool changed = changed_ || (!corrected_ && has_leapt(loop, slot.state));
    // No hand feels more than its device may give: nothing of what is beyond needs hiding.
    Wrench modelled = settings().traditional ? far_wrench(index, slot, changed)
                                             : modelled_wrench(loop, tool, slot, changed);
    const Vec3 whole = modelled.force;
    modelled.force = limited_force(whole, loop.force_limit(slot));
    hide_changes(tool, modelled, slot, changed);
    const TouchedBody touched = touched_body(loop, slot.state);
    const double force = glm::length(modelled.force);
    if (changed && tool.known &&
        change_to_come(tool.touched, touched, force) > just_noticeable(settings().stealth, force)) {
        tool.felt.let_go();
    }
    tool.touched = touched;
    const bool same_model = tool.known && !settings().traditional && !corrected_ && !changed;
    const double way = glm::distance(slot.hand.goal.position, tool.hand.position) +
                       length * angle_between(slot.hand.goal.rotation, tool.hand.rotation);
    const double own_doing = 2.0 * slot.use.settings.stiffness * way;
    // See feel() for a pointer.
    const Vec3 damped =
        settings().traditional ? whole - traditional_.far_tool(index).wrench.force : Vec3(0.0);
    const double damped_more = glm::distance(damped, std::exchange(tool.damped, damped));
    if (!tool.known) {
        slot.own_change = 0.0;
    } else if (settings().traditional) {
        slot.own_change = settings().passivity != Passivity::none && tool.answered ? damped_more : 0.0;
    } else {
        slot.own_change = std::min(glm::distance(modelled.force, tool.modelled.force), own_doing);
    }
    const Wrench felt =
        tool.felt.feel(settings().stealth,
                       {modelled, slot.hand.velocity_at(slot.hand.place), slot.hand.spin,
                        slot.state.contact_count > 0 ? slot.use.settings.stiffness * slot.hand.share : 0.0,
                        length, seconds_});
    slot.state.force = felt.force == modelled.force ? whole : felt.force;
    slot.state.torque = felt.torque;
    tool.modelled_before = same_model ? tool.modelled : modelled;  // a change is no trend
    tool.modelled = modelled;
    tool.hand = slot.hand.goal;
    tool.place = slot.hand.place;
    tool.known = true;
    slot.state.status |= felt_status(tool.felt.state());
    statistics_.let_go += tool.felt.begins_to_let_go() ? 1 : 0;
    add_energy(tool.felt.energy());
    note_cost(tool.felt.faded(), force);
}

// See hide_changes() for a pointer.
void OperatorSide::hide_changes(Tool& tool, const Wrench& modelled, const ToolSlot& slot, bool changed) {
    const double length = slot.coupling_length();
    if (changed && tool.known) {
        const Wrench expected{2.0 * tool.modelled.force - tool.modelled_before.force,
                              2.0 * tool.modelled.torque - tool.modelled_before.torque};
        const Wrench& uncorrected = corrected_ ? tool.uncorrected : modelled;
        const double way = glm::distance(slot.hand.goal.position, tool.hand.position) +
                           length * angle_between(slot.hand.goal.rotation, tool.hand.rotation);
        if (apart(expected, uncorrected, length) > 2.0 * slot.use.settings.stiffness * way + no_force) {
            tool.felt.hide(expected, uncorrected, length);
        }
    }
    if (corrected_) {
        const double jump = apart(modelled, tool.uncorrected, length);
        const bool hides = is_stealthy(settings().correction) || settings().correction == Correction::passive;
        if (hides) {
            tool.felt.hide(tool.uncorrected, modelled, length);
        }
        statistics_.cost.force_step = std::max(statistics_.cost.force_step, hides ? 0.0 : jump);
    }
}

void OperatorSide::note_denied(const SessionLoop& loop, Tool& tool, const ToolSlot& slot) const {
    const Vec3& pressed = settings().traditional ? tool.modelled.force : slot.wrench.force;
    const Vec3 shown = limited_force(slot.state.force, loop.force_limit(slot));
    tool.sent.denied.step({glm::length(pressed), glm::length(tool.modelled.force), glm::length(shown),
                           glm::length(tool.given.force), seconds_});
}

// Where the hand would have the tool, whatever its grasp is: the tool at the far side does the same with it.
void OperatorSide::send_tool(SessionLoop& loop, std::size_t index, const ToolSlot& slot, Nanoseconds now) {
    Tool& tool = tools_[index];
    const DeviceSample device = loop.device_sample(slot.use.device);
    const Pose& frame = settings().frame;
    note_denied(loop, tool, slot);
    const DeniedPress& denied = tool.sent.denied;
    const bool is_nearer = denied.binds() && !settings().traditional;
    Pose goal = slot.hand.goal;
    if (is_nearer) {
        const Pose& reached = slot.state.pose;
        goal = {nearer(goal.position, reached.position, slot.wrench.force, denied.share()),
                glm::slerp(reached.rotation, goal.rotation, denied.share())};
    }
    const Pose place = compose(inverse(frame), goal);
    OperatorSample sample;
    sample.sequence = sample_;
    sample.time = channel_.link().local_time(now);
    sample.pointer = static_cast<std::uint16_t>(first_tool + index);
    sample.connected = is_told(tool.sent, slot.proxy.starts(), device.connected && slot.use.enabled,
                               (slot.state.status & tool_absent) == 0);
    sample.buttons = device.buttons;
    sample.position = place.position;
    sample.velocity = is_nearer ? Vec3(0.0) : direction_to_local(frame, slot.hand.velocity);
    sample.has_turn = true;
    sample.rotation = place.rotation;
    sample.spin = is_nearer ? Vec3(0.0) : direction_to_local(frame, slot.hand.spin);
    const Vec3 force =
        settings().traditional ? far_bound(denied, tool.modelled.force) : denied.share() * slot.state.force;
    sample.force = glm::clamp(direction_to_local(frame, force), -plausible::max_force, plausible::max_force);
    const bool says_nothing_new = is_guessed(tool.sent, sample);
    if (!says_nothing_new || is_due(tool.sent, now)) {
        send(tool.sent, sample, says_nothing_new, now);
    }
}

}  // namespace tactus
