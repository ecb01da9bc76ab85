#include "session/session_loop.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <span>

#include "core/haptics/surface_feel.hpp"
#include "core/math/bit_hash.hpp"
#include "core/math/body_motion.hpp"
#include "realtime/thread_role.hpp"

namespace tactus {

namespace {

PhysicsSettings with_room(const SessionSettings& settings) {
    PhysicsSettings physics = settings.physics;
    physics.max_bodies = settings.max_bodies;
    physics.full_rate_bodies = settings.full_rate_bodies;
    return physics;
}

// The pose that is one of `ticks` equal parts of the way on.
Pose part_of_the_way(const Pose& from, const Pose& to, int ticks) {
    const double share = 1.0 / ticks;
    return {from.position + (to.position - from.position) * share,
            glm::slerp(from.rotation, to.rotation, share)};
}

}  // namespace

SessionLoop::SessionLoop(const SessionSettings& settings, TripleBuffer<SessionSnapshot>& snapshots,
                         InputRecorder* recorder)
    : settings_(settings),
      seconds_(to_seconds(settings.period)),
      snapshots_(snapshots),
      recorder_(recorder),
      scene_(settings.max_bodies, settings.max_parts),
      physics_(with_room(settings)),
      bodies_(settings.max_bodies),
      handle_of_slot_(settings.max_bodies, no_handle),
      handle_of_id_(settings.max_bodies, no_handle),
      state_changes_(settings.max_bodies),
      state_of_(settings.max_bodies, no_handle),
      gravity_(settings.physics.gravity) {
    travelling_.reserve(settings.max_bodies);
    forming_.reserve(settings.max_bodies);
    giving_.reserve(settings.max_bodies);
    magnets_.reserve(settings.max_bodies);
    pushed_.reserve(settings.max_bodies);
    helped_.reserve(settings.max_bodies);
    guessed_.reserve(settings.max_bodies);
    led_.reserve(max_led);
    joints_.resize(settings.physics.max_joints);
    states_.reserve(settings.max_bodies);
    hands_.reserve(max_proxies + max_tools);
}

TickStatus SessionLoop::tick(Nanoseconds now, TickTrace* trace, Nanoseconds late) {
    TACTUS_ASSERT_HAPTIC_THREAD();
    ++tick_;
    time_ = now;
    scene_.begin_tick();
    take_forms();
    take_soft_forms();
    follow_physics();
    travel();
    put_led_right();
    {
        const TraceScope scope(trace, TickStage::read_device);
        read_devices(now);
    }
    if (side_) {
        const TraceScope scope(trace, TickStage::receive_link);
        side_->set_hands(*this, now);
    }
    {
        const TraceScope scope(trace, TickStage::move_proxy);
        touch_all(now);
        touch_tools();
    }
    if (side_) {
        const TraceScope scope(trace, TickStage::correct_model);
        side_->set_forces(*this, now);
    } else {
        fade_jumps();
    }
    press_all();
    note_events();
    {
        const TraceScope scope(trace, TickStage::write_device);
        write_devices(now);
    }
    {
        const TraceScope scope(trace, TickStage::step_physics);
        if (!side_ || side_->simulates()) {
            step_physics();
            step_soft();
            note_led();
        } else {
            guess();
        }
    }
    if (side_) {
        const TraceScope scope(trace, TickStage::send_link);
        side_->report(*this, now);
    }
    {
        const TraceScope scope(trace, TickStage::publish_snapshot);
        publish(now);
    }
    if (recording_count_ > 0) {
        const TraceScope scope(trace, TickStage::append_record);
        for (const Recording& recording : std::span(recordings_).first(recording_count_)) {
            append_record(recording, now, late);
        }
    }
    return std::exchange(status_, 0u);
}

void SessionLoop::place(SessionHandle handle, const Pose& pose, bool teleport) {
    BodyMotion now = motion(handle);
    now.pose = pose;
    place(handle, now, teleport);
}

void SessionLoop::place(SessionHandle handle, const BodyMotion& now, bool teleport) {
    scene_.set_pose(bodies_[handle].slot, now.pose, teleport);
    if (state_of_[handle] != no_handle) {
        note_state(handle, now);
    }
}

void SessionLoop::note_state(SessionHandle handle, const BodyMotion& now) {
    const std::uint32_t state = state_of_[handle];
    states_[state] = {.handle = handle,
                      .pose = now.pose,
                      .linear_velocity = now.linear_velocity,
                      .angular_velocity = now.angular_velocity,
                      .asked = bodies_[handle].asked};
    note_change(state);
}

void SessionLoop::note_change(std::uint32_t state) {
    states_[state].changed_at = tick_;
    state_changes_.touch(state);
}

void SessionLoop::follow_physics() {
    for (const BodyId id : physics_.moved()) {
        const SessionHandle handle = handle_of_id_[id.index()];
        if (handle != no_handle && bodies_[handle].id == id) {
            place(handle, physics_.state(id), false);
        }
    }
}

// Ways that the owner asked for. A kinematic body gets the velocity that takes it one tick further, so that
// it pushes; a static one is simply put there.
void SessionLoop::travel() {
    for (std::size_t i = 0; i < travelling_.size();) {
        const SessionHandle handle = travelling_[i];
        Body& moving = bodies_[handle];
        const Pose pose = moving.ticks_left > 1 ? part_of_the_way(scene_.body(moving.slot).pose,
                                                                  moving.target, moving.ticks_left)
                                                : moving.target;
        if (moving.motion == Motion::Kinematic) {
            if (moving.ticks_left > 0) {
                physics_.move_to(moving.id, pose, seconds_);
            } else {
                physics_.set_velocity(moving.id, Vec3(0.0), Vec3(0.0));
            }
        } else if (moving.ticks_left > 0) {
            physics_.set_pose(moving.id, pose);
            place(handle, pose, false);
        }
        // A kinematic body needs one tick more: the last step's velocity has to be taken from it.
        if (moving.ticks_left-- > (moving.motion == Motion::Kinematic ? 0 : 1)) {
            ++i;
            continue;
        }
        moving.ticks_left = 0;
        travelling_[i] = travelling_.back();
        travelling_.pop_back();
    }
}

void SessionLoop::push_bodies() {
    for (const SessionHandle handle : pushed_) {
        const Body& pushed = bodies_[handle];
        if (pushed.motion == Motion::Dynamic) {
            physics_.apply_force(pushed.id, pushed.push, physics_.center_of_mass(pushed.id));
            physics_.apply_torque(pushed.id, pushed.twist);
        }
    }
}

void SessionLoop::set_residual(SessionHandle handle, const Residual& linear, const Residual& turn) {
    Body* const changed = body(handle);
    const Residual none;
    if (changed && changed->motion == Motion::Dynamic && (linear != none || turn != none)) {
        changed->residual = linear;
        changed->residual_turn = turn;
        helped_.push_back(handle);
    }
}

void SessionLoop::clear_residuals() {
    for (const SessionHandle handle : helped_) {
        Body& helped = bodies_[handle];
        helped.residual = helped.residual_turn = {};
        helped.helped = helped.helped_turn = Vec3(0.0);
    }
    helped_.clear();
}

void SessionLoop::help_bodies() {
    for (const SessionHandle handle : helped_) {
        Body& helped = bodies_[handle];
        helped.helped = helped.helped_turn = Vec3(0.0);
        if (helped.motion != Motion::Dynamic || !physics_.awake(helped.id)) {
            continue;
        }
        const BodyMotion now = physics_.state(helped.id);
        helped.helped = residual_step(helped.residual, now.linear_velocity, seconds_);
        helped.helped_turn = residual_step(helped.residual_turn, now.angular_velocity, seconds_);
        if (helped.helped_turn != Vec3(0.0)) {
            physics_.set_velocity(helped.id, now.linear_velocity, now.angular_velocity + helped.helped_turn);
        }
        physics_.apply_force(helped.id, helped.helped * (physics_.mass(helped.id) / seconds_),
                             physics_.center_of_mass(helped.id));
    }
}

// The opposite of what the hand feels goes to what it touches, where it touches it.
void SessionLoop::press_bodies(const ProxySlot& slot) {
    for (int i = 0; i < slot.parts.contact_count; ++i) {
        const ContactForce& part = slot.parts.contacts[i];
        const Body& pressed = bodies_[handle_of_slot_[static_cast<std::size_t>(part.body)]];
        if (pressed.motion != Motion::Dynamic && !pressed.soft) {
            continue;
        }
        const TouchMaterial& material = *feel_at(scene_, part.body, part.feature).material;
        const bool sticks = !slot.sliding && material.static_friction > 0.0;
        SpringForce spring{
            -part.on_hand, part.point, part.wall.stiffness, part.wall.damping, slot.hand_velocity,
            sticks,        {}};
        if (pressed.soft) {
            if (spring.stiffness > 0.0) {
                pressed.soft->press(scene_.body(part.body).pose, part.feature, spring);
            }
            continue;
        }
        if (i < slot.torsion.count) {
            const Torsion& held = slot.torsion.items[static_cast<std::size_t>(i)];
            spring.twist = {held.normal, held.twist, held.stiffness, held.limit, held.finger_spin};
        }
        physics_.apply_spring_force(pressed.id, spring);
    }
}

void SessionLoop::step_physics() {
    push_bodies();
    help_bodies();
    hands_.clear();
    for (const ProxySlot& slot : proxies_) {
        if (slot.proxy && slot.description.enabled) {
            hands_.push_back(slot.proxy->position());
        }
    }
    for (const std::unique_ptr<ToolSlot>& slot : tools_) {
        if (slot && slot->use.enabled) {
            hands_.push_back(slot->state.pose.position);
        }
    }
    physics_.set_hands(hands_);
    const std::uint32_t step = physics_.step(seconds_);
    status_ |= step & step_pairs_full ? static_cast<TickStatus>(session_step_pairs_full) : 0u;
    status_ |= step & step_contacts_full ? static_cast<TickStatus>(session_step_contacts_full) : 0u;
    status_ |= step & step_body_lost ? static_cast<TickStatus>(session_body_lost) : 0u;
    status_ |= step & step_memory_full ? static_cast<TickStatus>(session_step_memory_full) : 0u;
}

// What is only seen goes on as it moves, until its next image.
void SessionLoop::guess() {
    std::erase_if(guessed_, [this](SessionHandle handle) {
        const Body& seen = bodies_[handle];
        const BodyMotion now = motion(handle);
        const Pose next =
            carried_on(scene_.body(seen.slot).pose, now.linear_velocity, now.angular_velocity, seconds_);
        physics_.set_pose(seen.id, next);
        place(handle, next, false);
        return time_ >= seen.guessed_until;
    });
}

void SessionLoop::publish(Nanoseconds now) {
    SessionSnapshot& out = snapshots_.back();
    // The slot holds an older snapshot: only bodies that changed since then are written, or all where some
    // came or went.
    const std::uint64_t known = states_changed_at_ >= out.tick ? 0 : out.tick;
    for (std::size_t i = state_changes_.newest(); i != state_changes_.end() && states_[i].changed_at >= known;
         i = state_changes_.older(i)) {
        out.bodies[i] = states_[i];
    }
    out.body_count = states_.size();
    out.tick = tick_;
    out.time = now;
    out.led_count = led_.size();
    for (std::size_t i = 0; i < led_.size(); ++i) {
        out.led[i] = led_[i].state;
    }
    out.awake_bodies = physics_.awake_count();
    out.slowed_bodies = physics_.slowed_count() + slowed_soft_;
    out.physics_steps = physics_.steps();
    out.proxy_count = 0;
    for (std::size_t i = 0; i < proxies_.size(); ++i) {
        if (proxies_[i].proxy) {
            proxies_[i].state.handle = static_cast<SessionHandle>(i);
            out.proxies[out.proxy_count++] = proxies_[i].state;
            out.touch_events[i] = proxies_[i].events;
        }
    }
    out.received = received_;
    out.tool_count = 0;
    for (std::size_t i = 0; i < tools_.size(); ++i) {
        if (tools_[i]) {
            tools_[i]->state.handle = static_cast<SessionHandle>(i);
            out.tools[out.tool_count++] = tools_[i]->state;
            out.touch_events[hand_of_tool(static_cast<SessionHandle>(i))] = tools_[i]->events;
        }
    }
    out.device_count = 0;
    for (std::size_t i = 0; i < devices_.size(); ++i) {
        const DeviceSlot& slot = devices_[i];
        if (slot.device) {
            out.devices[out.device_count++] = {static_cast<SessionHandle>(i),
                                               slot.hand,
                                               slot.workspace.pose.rotation * slot.sample.rotation,
                                               slot.hand_velocity,
                                               slot.force * slot.workspace.force_scale,
                                               slot.asked * slot.workspace.force_scale,
                                               direction_to_parent(slot.workspace.pose, slot.safe.torque),
                                               slot.sample.buttons,
                                               slot.sample.connected,
                                               slot.safe.state,
                                               slot.safe.limited,
                                               slot.wanted_stiffness,
                                               slot.used_stiffness,
                                               {seconds_, slot.capabilities.delay},
                                               slot.capabilities,
                                               slot.safety.work()};
        }
    }
    snapshots_.publish();
}

std::uint64_t SessionLoop::outcome() const {
    BitHash hash;
    for (const ProxySlot& slot : proxies_) {
        if (slot.proxy) {
            hash.add(slot.state.position);
            hash.add(slot.state.force);
            hash.add(std::uint64_t{slot.state.status});
        }
    }
    for (const std::unique_ptr<ToolSlot>& slot : tools_) {
        if (slot) {
            hash.add(slot->state.pose.position);
            hash.add(slot->state.pose.rotation);
            hash.add(slot->state.force);
            hash.add(slot->state.torque);
        }
    }
    for (const DeviceSlot& slot : devices_) {
        if (slot.device) {
            hash.add(slot.safe.force);
            hash.add(slot.safe.torque);
        }
    }
    for (std::size_t i = state_changes_.newest(); i != state_changes_.end() && states_[i].changed_at == tick_;
         i = state_changes_.older(i)) {
        const BodyState& state = states_[i];
        hash.add(std::uint64_t{state.handle});
        hash.add(state.pose.position);
        hash.add(state.pose.rotation);
        hash.add(state.linear_velocity);
        hash.add(state.angular_velocity);
    }
    for (const SessionHandle handle : giving_) {
        const SoftBody& giving = bodies_[handle].soft->body;
        hash.add(std::uint64_t{giving.is_asleep()});
        for (const Lanes& place : giving.is_asleep() ? std::span<const Lanes>() : giving.places()) {
            hash.add(Vec3(place[0], place[1], place[2]));
        }
    }
    return hash.value();
}

}  // namespace tactus
