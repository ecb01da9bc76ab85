// How the loop carries out each command of the owner.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/math/body_motion.hpp"
#include "realtime/thread_role.hpp"
#include "session/session_loop.hpp"

namespace tactus {

namespace {

// Whether what a pointer touches, or the pointer itself, may be another one afterwards.
bool changes_touch(const Command& command) {
    return std::holds_alternative<command::AddBody>(command) ||
           std::holds_alternative<command::RemoveBody>(command) ||
           std::holds_alternative<command::TeleportBody>(command) ||
           std::holds_alternative<command::ShiftBody>(command) ||
           std::holds_alternative<command::SeeBody>(command) ||
           std::holds_alternative<command::SetTouchMaterial>(command) ||
           std::holds_alternative<command::SetBodyLayers>(command) ||
           std::holds_alternative<command::SetProxy>(command);
}

}  // namespace

bool SessionLoop::take(Command& command, Retired& retired) {
    TACTUS_ASSERT_HAPTIC_THREAD();
    touch_changed_ = touch_changed_ || changes_touch(command);
    return std::visit([&](auto& c) { return carry_out(c, retired); }, command);
}

void SessionLoop::follow(const SessionLoop& other, const Command& command) {
    if (const auto* const joint = std::get_if<command::AddJoint>(&command)) {
        for (const SessionHandle handle : {joint->first, joint->second}) {
            if (const Body* const joined = body(handle)) {
                physics_.take_state(joined->id, other.physics_);
            }
        }
    }
    if (const auto* const added = std::get_if<command::AddBody>(&command)) {
        if (const Body* const former = body(added->former.body)) {
            physics_.take_state(former->id, other.physics_);
        }
    }
}

// Who gives this hand a force, or where it is in the scene, is another one from the next tick on.
void SessionLoop::note_hand_change(SessionHandle device) {
    if (device < max_devices) {
        devices_[device].jumped = true;
    }
    for (ProxySlot& slot : proxies_) {
        slot.changed = slot.changed || slot.description.device == device;
    }
    for (const std::unique_ptr<ToolSlot>& slot : tools_) {
        if (slot && slot->use.device == device) {
            slot->changed = true;
        }
    }
}

SessionLoop::Body* SessionLoop::body(SessionHandle handle) {
    return handle < bodies_.size() && bodies_[handle].slot >= 0 ? &bodies_[handle] : nullptr;
}

const SessionLoop::Body* SessionLoop::body(SessionHandle handle) const {
    return handle < bodies_.size() && bodies_[handle].slot >= 0 ? &bodies_[handle] : nullptr;
}

// Enters the touch scene and the physics world together, or neither.
bool SessionLoop::carry_out(command::AddBody& c, Retired& retired) {
    const auto give_back = [&] {
        status_ |= session_full;
        retired = {Retired::Kind::body, c.handle, std::move(c.body), std::move(c.shape), nullptr,
                   std::move(c.detail), nullptr};
        return true;
    };
    const BodyId id = physics_.add(c.body);
    if (!id.valid()) {
        return give_back();
    }
    const int slot = scene_.add(*c.shape, c.pose, c.material, c.layer);
    if (slot < 0) {
        c.body = physics_.remove(id);
        return give_back();
    }
    bodies_[c.handle] = {};
    bodies_end_ = std::max(bodies_end_, c.handle + 1);
    Body& added = bodies_[c.handle];
    added.id = id;
    added.slot = slot;
    added.shape = std::move(c.shape);
    added.detail = std::move(c.detail);
    added.motion = c.motion;
    added.soft = std::move(c.soft);
    added.only_touched = c.only_touched;
    if (added.soft) {
        giving_.push_back(c.handle);
    }
    note_magnet(c.handle);
    handle_of_slot_[static_cast<std::size_t>(slot)] = c.handle;
    handle_of_id_[id.index()] = c.handle;
    if (c.motion != Motion::Static) {
        show_state(c.handle);
    }
    go_on_from(c);
    return false;
}

// Where its former is not near, it has been put elsewhere. Of another shape, how it lies is told.
void SessionLoop::go_on_from(const command::AddBody& added) {
    const Body* const former = body(added.former.body);
    if (!former) {
        return;
    }
    BodyMotion now = motion(added.former.body);
    if (glm::distance(now.pose.position, added.pose.position) > added.former.within) {
        return;
    }
    if (former->shape->reach != bodies_[added.handle].shape->reach) {
        now.pose.rotation = added.pose.rotation;
        now.angular_velocity = motion(added.handle).angular_velocity;
    }
    const BodyId id = bodies_[added.handle].id;
    physics_.set_pose(id, now.pose);
    physics_.set_velocity(id, now.linear_velocity, now.angular_velocity);
    place(added.handle, now.pose, true);
}

// From the next snapshot on, the body is among those that can move.
void SessionLoop::show_state(SessionHandle handle) {
    state_of_[handle] = static_cast<std::uint32_t>(states_.size());
    states_.emplace_back();
    note_state(handle, motion(handle));
    states_changed_at_ = tick_ + 1;
}

void SessionLoop::note_magnet(SessionHandle handle) {
    forget_magnet(handle);
    if (scene_.body(bodies_[handle].slot).material.magnet_force > 0.0) {
        magnets_.push_back(handle);
        ++magnet_changes_;
    }
}

void SessionLoop::forget_magnet(SessionHandle handle) {
    magnet_changes_ += std::erase(magnets_, handle);
}

bool SessionLoop::carry_out(command::RemoveBody& c, Retired& retired) {
    Body* const removed = body(c.handle);
    if (!removed) {
        return false;
    }
    end_travel(c.handle);
    forget_magnet(c.handle);
    std::erase(pushed_, c.handle);
    std::erase(helped_, c.handle);
    std::erase(guessed_, c.handle);
    std::erase_if(led_, [&c](const Led& one) { return one.state.handle == c.handle; });
    std::erase(forming_, c.handle);
    std::erase(giving_, c.handle);
    forget_obstacle(removed->slot);
    scene_.remove(removed->slot);
    handle_of_slot_[static_cast<std::size_t>(removed->slot)] = no_handle;
    handle_of_id_[removed->id.index()] = no_handle;
    if (const std::uint32_t state = std::exchange(state_of_[c.handle], no_handle); state != no_handle) {
        states_[state] = states_.back();
        states_.pop_back();
        state_changes_.remove(states_.size());
        if (state < states_.size()) {
            state_of_[states_[state].handle] = state;
            note_change(state);
        }
        states_changed_at_ = tick_ + 1;
    }
    retired = {Retired::Kind::body,
               c.handle,
               physics_.remove(removed->id),
               std::move(removed->shape),
               nullptr,
               std::move(removed->detail),
               nullptr,
               std::move(removed->former)};
    *removed = {};
    while (bodies_end_ > 0 && !body(bodies_end_ - 1)) {
        --bodies_end_;
    }
    return true;
}

// The new form stands in the touch scene from the coming tick on, and there the way to it. A form that comes
// before the last one has been touched takes its place.
bool SessionLoop::carry_out(command::DeformBody& c, Retired& retired) {
    Body* const deformed = body(c.handle);
    const bool fits =
        deformed && !deformed->soft && !c.soft && c.shape->parts.size() == deformed->shape->parts.size();
    retired.kind = Retired::Kind::form;
    if (deformed && deformed->soft && c.soft) {
        if (deformed->soft->exchange_make(*c.soft)) {
            fade_in(c.handle);
        }
        retired.shape = std::move(c.shape);
    } else if (fits) {
        physics_.reshape(deformed->id, c.body);
        if (deformed->takes_form) {
            retired.shape = std::exchange(deformed->shape, std::move(c.shape));
        } else {
            retired.shape =
                std::exchange(deformed->former, std::exchange(deformed->shape, std::move(c.shape)));
            deformed->takes_form = true;
            forming_.push_back(c.handle);
        }
    } else {
        retired.shape = std::move(c.shape);
    }
    retired.body = std::move(c.body);
    return true;
}

// One that is about to take another form is of that one's triangles.
bool SessionLoop::carry_out(command::NarrowTouch& c, Retired& retired) {
    Body* const narrowed = body(c.handle);
    if (narrowed && !narrowed->soft && !narrowed->takes_form && scene_.narrow(narrowed->slot, *c.shape)) {
        std::swap(narrowed->shape, c.shape);
    }
    retired.kind = Retired::Kind::form;
    retired.shape = std::move(c.shape);
    return true;
}

void SessionLoop::take_forms() {
    for (const SessionHandle handle : forming_) {
        Body& taking = bodies_[handle];
        taking.takes_form = false;
        forget_obstacle(taking.slot);
        scene_.deform(taking.slot, *taking.shape);
    }
    forming_.clear();
}

bool SessionLoop::carry_out(command::TeleportBody& c, Retired&) {
    if (Body* const moved = body(c.handle)) {
        put(c.handle, written(physics_.pose(moved->id), c.pose, c.axes));
    }
    return false;
}

bool SessionLoop::carry_out(command::ShiftBody& c, Retired&) {
    if (Body* const moved = body(c.handle)) {
        put(c.handle, shifted(physics_.pose(moved->id), c.by, c.turn));
    }
    return false;
}

// As the owner has asked for.
void SessionLoop::put(SessionHandle handle, const Pose& pose) {
    Body& moved = bodies_[handle];
    end_travel(handle);
    ++moved.asked;
    physics_.set_pose(moved.id, pose);
    place(handle, pose, true);
}

void SessionLoop::start_travel(SessionHandle handle, const Pose& target, double seconds) {
    Body& moved = bodies_[handle];
    if (moved.ticks_left == 0 && std::ranges::find(travelling_, handle) == travelling_.end()) {
        travelling_.push_back(handle);
    }
    moved.target = target;
    moved.ticks_left = std::max(1, static_cast<int>(std::lround(seconds / seconds_)));
}

void SessionLoop::end_travel(SessionHandle handle) {
    bodies_[handle].ticks_left = 0;
    std::erase(travelling_, handle);
}

bool SessionLoop::carry_out(command::MoveBody& c, Retired&) {
    if (body(c.handle)) {
        start_travel(c.handle, c.pose, c.seconds);
    }
    return false;
}

bool SessionLoop::carry_out(command::SetBodyVelocity& c, Retired&) {
    if (Body* const changed = body(c.handle)) {
        ++changed->asked;
        const BodyMotion now = with_velocity(motion(c.handle), {{}, c.linear, c.angular}, c.axes);
        physics_.set_velocity(changed->id, now.linear_velocity, now.angular_velocity);
        if (state_of_[c.handle] != no_handle) {
            note_state(c.handle, motion(c.handle));
        }
    }
    return false;
}

bool SessionLoop::carry_out(command::SetTouchMaterial& c, Retired& retired) {
    if (Body* const changed = body(c.handle)) {
        scene_.set_material(changed->slot, c.material);
        std::swap(changed->detail, c.detail);
        note_magnet(c.handle);
    }
    if (!c.detail) {
        return false;
    }
    retired = {Retired::Kind::detail, no_handle, {}, nullptr, nullptr, std::move(c.detail), nullptr};
    return true;
}

bool SessionLoop::carry_out(command::SetBodySurface& c, Retired&) {
    if (const Body* const changed = body(c.handle)) {
        physics_.set_material(changed->id, c.surface);
    }
    return false;
}

bool SessionLoop::carry_out(command::SetBodyLayers& c, Retired&) {
    if (const Body* const changed = body(c.handle)) {
        if (changed->soft) {
            changed->soft->mask = c.layers.mask;
        } else if (!changed->only_touched) {
            physics_.set_collision(changed->id, c.layers);
        }
        scene_.set_layer(changed->slot, c.layers.layer);
    }
    return false;
}

bool SessionLoop::carry_out(command::SetBodyMotion& c, Retired&) {
    if (Body* const changed = body(c.handle);
        changed && !changed->soft && physics_.set_motion(changed->id, c.motion)) {
        end_travel(c.handle);
        changed->motion = c.motion;
        if (c.motion != Motion::Static && state_of_[c.handle] == no_handle) {
            show_state(c.handle);
        }
    }
    return false;
}

bool SessionLoop::carry_out(command::SetBodyGravityScale& c, Retired&) {
    if (const Body* const changed = body(c.handle)) {
        physics_.set_gravity_scale(changed->id, c.scale);
    }
    return false;
}

bool SessionLoop::carry_out(command::SetBodyDamping& c, Retired&) {
    if (const Body* const changed = body(c.handle)) {
        physics_.set_damping(changed->id, c.linear, c.angular);
    }
    return false;
}

bool SessionLoop::carry_out(command::PushBody& c, Retired&) {
    if (const Body* const pushed = body(c.handle)) {
        const Vec3 point = c.push.central ? physics_.center_of_mass(pushed->id)
                                          : physics_.pose(pushed->id).position + c.push.point;
        physics_.apply_force(pushed->id, c.push.impulse / seconds_, point);
        physics_.apply_torque(pushed->id, c.push.turn / seconds_);
    }
    return false;
}

bool SessionLoop::carry_out(command::SetBodyPush& c, Retired&) {
    Body* const changed = body(c.handle);
    if (!changed) {
        return false;
    }
    changed->push = c.force;
    changed->twist = c.torque;
    std::erase(pushed_, c.handle);
    if (c.force != Vec3(0.0) || c.torque != Vec3(0.0)) {
        pushed_.push_back(c.handle);
    }
    return false;
}

bool SessionLoop::carry_out(command::SeeBody& c, Retired&) {
    Body* const seen = body(c.handle);
    if (seen == nullptr) {
        return false;
    }
    const BodyMotion& then = c.sighting.motion;
    const double age = std::min(c.sighting.age, longest_guess);
    const bool moves = then.linear_velocity != Vec3(0.0) || then.angular_velocity != Vec3(0.0);
    const Pose now =
        moves ? carried_on(then.pose, then.linear_velocity, then.angular_velocity, age) : then.pose;
    end_travel(c.handle);
    physics_.set_pose(seen->id, now);
    place(c.handle, now, true);
    if (seen->motion != Motion::Dynamic) {
        return false;  // its owner leads it on
    }
    physics_.set_velocity(seen->id, then.linear_velocity, then.angular_velocity);
    seen->doubt = c.sighting.doubt;
    seen->guessed_until = time_ + from_seconds(longest_guess - age);
    std::erase(guessed_, c.handle);
    if (moves) {
        guessed_.push_back(c.handle);
    }
    return false;
}

// Where a body found no place in the world there is nothing to join.
bool SessionLoop::carry_out(command::AddJoint& c, Retired&) {
    const Body* const first = body(c.first);
    const Body* const second = body(c.second);
    const Body* const anchor = first ? first : second;
    if (!anchor || (c.first != no_handle && !first) || (c.second != no_handle && !second)) {
        return false;
    }
    const Pose at = physics_.pose(anchor->id);
    JointDescription joint = c.joint;
    joint.frame = compose(at, c.joint.frame);
    if (joint.second_frame && second) {
        joint.second_frame = compose(physics_.pose(second->id), *joint.second_frame);
    }
    joints_[c.handle] =
        physics_.add_joint(joint, first ? first->id : BodyId{}, second ? second->id : BodyId{});
    status_ |= joints_[c.handle].valid() ? 0u : static_cast<TickStatus>(session_full);
    return false;
}

bool SessionLoop::carry_out(command::RemoveJoint& c, Retired& retired) {
    physics_.remove_joint(std::exchange(joints_[c.handle], JointId{}));
    retired.kind = Retired::Kind::joint;
    retired.handle = c.handle;
    return true;
}

bool SessionLoop::carry_out(command::SetGravity& c, Retired&) {
    gravity_ = c.gravity;
    physics_.set_gravity(c.gravity);
    return false;
}

bool SessionLoop::carry_out(command::AddDevice& c, Retired&) {
    devices_[c.handle] = {};
    devices_[c.handle].device = c.device;
    devices_[c.handle].workspace = c.workspace;
    return false;
}

bool SessionLoop::carry_out(command::SetWorkspace& c, Retired&) {
    DeviceSlot& slot = devices_[c.handle];
    slot.workspace = c.workspace;
    slot.wanted_stiffness = slot.used_stiffness = 0.0;  // another scale makes other walls of them
    note_hand_change(c.handle);
    return false;
}

bool SessionLoop::carry_out(command::RemoveDevice& c, Retired& retired) {
    if (devices_[c.handle].device) {
        devices_[c.handle].device->write(time_, Vec3(0.0));
    }
    devices_[c.handle] = {};
    retired = {Retired::Kind::device, c.handle, {}, nullptr, nullptr, nullptr, nullptr};
    return true;
}

bool SessionLoop::carry_out(command::AddProxy& c, Retired&) {
    proxies_[c.handle] = {};
    proxies_[c.handle].proxy = std::move(c.proxy);
    proxies_[c.handle].description = c.description;
    note_hand_change(c.description.device);
    return false;
}

bool SessionLoop::carry_out(command::SetProxy& c, Retired&) {
    ProxySlot& changed = proxies_[c.handle];
    if (changed.proxy) {
        if (changed.description.device != c.description.device) {
            changed.proxy->restart();
            changed.fading.clear();
        }
        note_hand_change(changed.description.device);
        note_hand_change(c.description.device);
        changed.description = c.description;
        changed.proxy->set_settings(c.description.settings);
    }
    return false;
}

SessionLoop::HandSlot SessionLoop::hand_slot(SessionHandle hand) {
    if (hand < max_proxies) {
        return {&proxies_[hand], nullptr};
    }
    return {nullptr, hand < hand_of_tool(max_tools) ? tools_[hand - max_proxies].get() : nullptr};
}

bool SessionLoop::carry_out(command::SetField& c, Retired&) {
    const HandSlot hand = hand_slot(c.handle);
    if (hand.proxy != nullptr) {
        hand.proxy->field.set(c.moment);
    } else if (hand.tool != nullptr) {
        hand.tool->field.set(c.moment);
    }
    return false;
}

// They are moved evenly from where they were, so that no force jumps.
bool SessionLoop::carry_out(command::SetGuideFrames& c, Retired&) {
    const HandSlot hand = hand_slot(c.handle);
    HandAids* const aids = hand.proxy != nullptr  ? &hand.proxy->description.aids
                           : hand.tool != nullptr ? &hand.tool->use.aids
                                                  : nullptr;
    for (std::size_t i = 0; aids != nullptr && i < c.frames.size(); ++i) {
        aids->guides[i].frame = c.frames[i];
    }
    return false;
}

bool SessionLoop::carry_out(command::RemoveProxy& c, Retired& retired) {
    retired = {
        Retired::Kind::proxy, c.handle, {}, nullptr, std::move(proxies_[c.handle].proxy), nullptr, nullptr};
    note_hand_change(proxies_[c.handle].description.device);
    proxies_[c.handle] = {};
    return true;
}

bool SessionLoop::carry_out(command::Record& c, Retired&) {
    const auto recorded = std::span(recordings_).first(recording_count_);
    const auto same = std::ranges::find(recorded, c.ring, &Recording::ring);
    Recording& recording = same != recorded.end() ? *same : recordings_[recording_count_++];
    recording = {c.ring, c.proxy, c.object};
    return false;
}

bool SessionLoop::carry_out(command::EndRecording& c, Retired&) {
    const auto recorded = std::span(recordings_).first(recording_count_);
    const auto ended = std::ranges::find(recorded, c.ring, &Recording::ring);
    if (ended != recorded.end()) {
        *ended = recordings_[--recording_count_];
    }
    return false;
}

bool SessionLoop::carry_out(command::Attach& c, Retired& retired) {
    std::swap(side_, c.side);
    clear_residuals();
    for (DeviceSlot& slot : devices_) {
        slot.jumped = true;
    }
    if (!c.side) {
        return false;
    }
    retired = {Retired::Kind::side, no_handle, {}, nullptr, nullptr, nullptr, std::move(c.side)};
    return true;
}

namespace {

struct Duplicate {
    Command& same;

    bool operator()(command::AddBody& c) {
        same = command::AddBody{c.handle,   std::move(c.same_body),
                                {},         c.shape,
                                c.material, c.detail,
                                c.layer,    c.pose,
                                c.motion,   c.former,
                                nullptr,    c.only_touched};
        return true;
    }
    bool operator()(command::DeformBody& c) {
        same = command::DeformBody{c.handle, std::move(c.same_body), {}, c.shape, nullptr};
        return !c.soft;  // it is touched at rest there
    }
    bool operator()(command::AddProxy& c) {
        same = command::AddProxy{c.handle, std::move(c.same_proxy), nullptr, c.description};
        return true;
    }
    bool operator()(command::MoveBody&) { return false; }
    bool operator()(command::AddTool& c) {
        same = command::AddTool{c.handle, std::move(c.same_tool), nullptr};
        return true;
    }
    bool operator()(command::Record&) { return false; }
    bool operator()(command::EndRecording&) { return false; }
    bool operator()(command::Attach&) { return false; }
    template <typename Plain>
    bool operator()(Plain& c) {
        same = c;
        return true;
    }
};

}  // namespace

bool duplicate(Command& command, Command& same) {
    return std::visit(Duplicate{same}, command);
}

}  // namespace tactus
