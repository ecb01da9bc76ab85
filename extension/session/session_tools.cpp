// Tools in the loop: what the hand holds, what it feels of it, and what the bodies do that it touches.
#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "core/haptics/surface_feel.hpp"
#include "core/haptics/surface_way.hpp"
#include "core/math/body_motion.hpp"
#include "session/session_loop.hpp"

namespace tactus {

bool SessionLoop::carry_out(command::AddTool& c, Retired&) {
    tools_[c.handle] = std::move(c.tool);
    ToolSlot& added = *tools_[c.handle];
    note_hand_change(added.use.device);
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (added.pairs[i] && tools_[i]) {
            added.pairs[i]->join(tools_[i]->proxy, added.proxy);
        }
    }
    return false;
}

bool SessionLoop::carry_out(command::SetTool& c, Retired&) {
    if (ToolSlot* const changed = tools_[c.handle].get()) {
        if (changed->use.device != c.use.device) {
            changed->proxy.restart();
            changed->fading.clear();
        }
        note_hand_change(changed->use.device);
        note_hand_change(c.use.device);
        changed->use = c.use;
        changed->settle_settings();
    }
    return false;
}

bool SessionLoop::carry_out(command::RemoveTool& c, Retired& retired) {
    retired.kind = Retired::Kind::tool;
    retired.handle = c.handle;
    retired.tool = std::move(tools_[c.handle]);
    if (retired.tool) {
        note_hand_change(retired.tool->use.device);
    }
    for (std::size_t i = 0; i < max_tools && retired.tool; ++i) {
        if (tools_[i] && tools_[i]->pairs[c.handle]) {
            retired.tool->pairs[i] = std::move(tools_[i]->pairs[c.handle]);
        }
        if (retired.tool->pairs[i]) {
            retired.tool->pairs[i]->part();
        }
    }
    return true;
}

namespace {

// What of a touch's stiffness is its own. The coupling presses with all of a body's touches together: where
// n of them give way alike, it loosens once, not n times. Those along which it presses at right angles do not
// know of each other.
double own_share(std::span<const ToolTouch> touches, const ToolTouch& one) {
    const double own = glm::dot(one.force, one.normal);
    double all = 0.0;
    for (const ToolTouch& touch : touches) {
        const double alike = glm::dot(touch.normal, one.normal);
        all += touch.body == one.body ? std::max(0.0, alike) * glm::dot(touch.force, touch.normal) : 0.0;
    }
    return all > 0.0 ? std::clamp(own / all, 1e-3, 1.0) : 1.0;
}

}  // namespace

// Where the devices have the hands; a side may have them elsewhere.
void SessionLoop::hold_tools(Nanoseconds now) {
    for (const std::unique_ptr<ToolSlot>& slot : tools_) {
        if (slot) {
            const SessionHandle device = slot->use.device;
            slot->hand.holds = slot->use.enabled && is_there(device);
            if (slot->hand.holds) {
                slot->hand = hand_at(*slot, now);
            }
        }
    }
}

// What acts on the hand besides touch comes first: the coupling is as stiff as the damping that is left
// bears.
ToolHand SessionLoop::hand_at(ToolSlot& slot, Nanoseconds now) const {
    const ToolUse& use = slot.use;
    const DeviceSlot& device = devices_[use.device];
    const AidedHand hand = aided_hand(use.device, {device.hand, device.hand_velocity}, now);
    const AidForce aid = aid_force(use.aids, hand, slot.field, slot.aids);
    const Wall safe = safe_wall(hand.lag, aid.damping, {use.settings.stiffness, 0.0});
    const Vec3 spin = device.hand_turn / seconds_;
    const Pose goal = compose({device.hand, device.orientation}, use.grasp);
    return {goal,
            device.hand_velocity + glm::cross(spin, goal.position - device.hand),
            spin,
            device.hand,
            safe.stiffness / use.settings.stiffness,
            fade_of(use.device),
            FadingWrench::max_torque_step * device.workspace.scale / device.workspace.force_scale,
            true,
            false,
            aid};
}

double SessionLoop::force_limit(const ToolSlot& slot) const {
    return slot.use.device < max_devices ? force_limit(slot.use.device) : 0.0;
}

// A side that does not simulate has nothing here to touch.
bool SessionLoop::takes_hold(ToolSlot& slot) const {
    if ((side_ && !side_->simulates()) || !slot.hand.holds) {
        slot.let_go();
        return false;
    }
    if (std::exchange(slot.is_fixed, slot.hand.fixed) != slot.hand.fixed) {
        slot.settle_settings();
    }
    if (std::exchange(slot.rested, false) &&
        glm::distance(slot.hand.goal.position, slot.state.hand.position) > slot.proxy.shape().reach) {
        slot.proxy.restart();  // the hand may be deep inside a body by now
    }
    return true;
}

// Null: no two tools are there that may meet.
ToolGroup* SessionLoop::tool_group() const {
    for (const std::unique_ptr<ToolSlot>& slot : tools_) {
        if (slot && slot->group) {
            return slot->group.get();
        }
    }
    return nullptr;
}

void SessionLoop::touch_tools() {
    ToolGroup* const group = tool_group();
    if (!group) {
        for (const std::unique_ptr<ToolSlot>& slot : tools_) {
            if (slot && takes_hold(*slot)) {
                feel(*slot, slot->proxy.move(scene_, slot->hand.goal));
            }
        }
        return;
    }
    std::array<ToolSlot*, max_tools> held;
    std::size_t count = 0;
    group->clear();
    for (const std::unique_ptr<ToolSlot>& slot : tools_) {
        if (slot && takes_hold(*slot)) {
            group->add(slot->proxy, slot->hand.goal, slot->hand.share);
            held[count++] = slot.get();
        }
    }
    group->move(scene_);
    for (std::size_t i = 0; i < count; ++i) {
        feel(*held[i], group->tick_of(i));
    }
}

void SessionLoop::put_tools(const ToolPlaces& places) {
    std::array<ToolMemory, max_tools> before;
    std::array<bool, max_tools> is_put{};
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (ToolSlot* const slot = tools_[i].get(); slot && places[i]) {
            before[i] = slot->proxy.memory();
            slot->proxy.recall(*places[i], scene_);
            is_put[i] = true;
        }
    }
    // One that stays may be in the way of another.
    for (bool all_fit = false; !all_fit;) {
        all_fit = true;
        for (std::size_t i = 0; i < max_tools; ++i) {
            if (!is_put[i] || fits_beside_tools(*tools_[i])) {
                continue;
            }
            tools_[i]->proxy.recall(before[i], scene_);
            is_put[i] = all_fit = false;
        }
    }
}

bool SessionLoop::fits_beside_tools(ToolSlot& slot) {
    WorkBudget work(slot.use.settings.max_work, 0, cost::pack_look);
    return std::ranges::all_of(slot.proxy.pairs(), [&](ToolPair* pair) { return pair->fits_now(work); });
}

void SessionLoop::feel(ToolSlot& slot, const ToolTick& tick) {
    const Pose& goal = slot.hand.goal;
    tool_work_ += slot.proxy.work_spent();
    slot.wrench.force = tick.force * slot.hand.share;
    // A hand whose turn means nothing is given no torque: it would only be turned by it.
    slot.wrench.torque = slot.hand.fixed ? Vec3(0.0)
                                         : tick.torque * slot.hand.share +
                                               glm::cross(goal.position - slot.hand.place, slot.wrench.force);
    slot.wrench.force += slot.hand.aid.force;
    slot.jumped = tick.jumped || slot.hand.aid.jumped || std::exchange(slot.changed, false);
    slot.turned += slot.hand.spin * seconds_;
    double given = 0.0;
    for (const ToolTouch& touch : slot.proxy.touching()) {
        const Vec3 way = way_of_surface(scene_, surface_of(touch));
        given += glm::dot(touch.force, way) * slot.hand.share;
    }
    for (const ToolMeeting& meeting : slot.proxy.meetings()) {
        const Vec3 way = meeting.other->way().at(meeting.point - meeting.other->pose().position);
        given += glm::dot(meeting.force, way) * slot.hand.share;
    }
    const Vec3 velocity = slot.hand.velocity_at(slot.hand.place);
    slot.source = std::max(0.0, given) + std::max(0.0, seconds_ * glm::dot(slot.hand.aid.force, velocity));
    status_ |= tick.status & tool_unfinished ? static_cast<TickStatus>(session_proxy_unfinished) : 0u;
    slot.state.torque = slot.wrench.torque;
    describe(slot, tick);
}

SessionHandle SessionLoop::handle_of(const ToolProxy& tool) const {
    const auto found =
        std::ranges::find_if(tools_, [&](const auto& slot) { return slot && &slot->proxy == &tool; });
    return found == tools_.end() ? no_handle : static_cast<SessionHandle>(found - tools_.begin());
}

void SessionLoop::describe(ToolSlot& slot, const ToolTick& tick) const {
    ToolState& state = slot.state;
    state.pose = tick.pose;
    state.hand = slot.hand.goal;
    state.residual = tick.residual;
    state.status = tick.status | (slot.hand.fixed ? static_cast<std::uint32_t>(tool_turn_fixed) : 0u) |
                   (slot.field.is_limited() ? touch_field_limited : 0u);
    state.contact_count = 0;
    for (const ToolTouch& touch : slot.proxy.touching()) {
        const auto i = static_cast<std::size_t>(state.contact_count++);
        state.bodies[i] = handle_of_slot_[static_cast<std::size_t>(touch.body)];
        state.points[i] = touch.point;
        state.normals[i] = touch.normal;
        state.forces[i] = touch.force * slot.hand.share;
        state.tools[i] = no_handle;
    }
    for (const ToolMeeting& meeting : slot.proxy.meetings()) {
        if (state.contact_count == static_cast<int>(ToolState::max_contacts)) {
            break;
        }
        const auto i = static_cast<std::size_t>(state.contact_count++);
        state.bodies[i] = no_handle;
        state.points[i] = meeting.point;
        state.normals[i] = meeting.normal;
        state.forces[i] = meeting.force * slot.hand.share;
        state.tools[i] = handle_of(*meeting.other);
    }
}

void SessionLoop::fade_tools() {
    for (const std::unique_ptr<ToolSlot>& slot : tools_) {
        if (slot && slot->use.device < max_devices) {
            const Wrench felt = slot->fading.felt(slot->wrench, force_limit(slot->use.device), slot->jumped,
                                                  slot->step(), slot->turn());
            slot->state.force = felt.force;
            slot->state.torque = felt.torque;
        }
    }
}

// The opposite of what holds the tool goes to what it touches, where it touches it.
void SessionLoop::press_bodies(const ToolSlot& slot) {
    for (const ToolTouch& touch : slot.proxy.touching()) {
        const Body& pressed = bodies_[handle_of_slot_[static_cast<std::size_t>(touch.body)]];
        const Vec3 force = touch.force * slot.hand.share;
        if ((pressed.motion != Motion::Dynamic && !pressed.soft) || force == Vec3(0.0)) {
            continue;
        }
        const TouchMaterial& material = *feel_at(scene_, touch.body, touch.feature).material;
        const bool sticks = (slot.state.status & tool_sliding) == 0 && material.static_friction > 0.0;
        const Vec3 velocity = slot.hand.velocity_at(touch.point);
        SpringForce spring{-force, touch.point, touch.stiffness * slot.hand.share, 0.0, velocity, sticks, {}};
        if (pressed.soft) {
            spring.stiffness *= own_share(slot.proxy.touching(), touch);
            pressed.soft->press(scene_.body(touch.body).pose, touch.feature, spring);
            continue;
        }
        physics_.apply_spring_force(pressed.id, spring);
    }
}

}  // namespace tactus
