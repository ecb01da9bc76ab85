#include "session/session_loop.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <span>

#include "core/geometry/surface_query.hpp"
#include "core/haptics/surface_feel.hpp"
#include "core/haptics/surface_spring.hpp"
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

void SessionLoop::touch_all(Nanoseconds now) {
    if (side_ && !side_->simulates()) {
        for (ProxySlot& slot : proxies_) {
            slot.parts = {};  // nothing is touched here, so nothing is pressed
            slot.punctures.clear();
            if (!slot.present()) {
                slot.state = {};
            }
        }
        return;
    }
    for (ProxySlot& slot : proxies_) {
        if (slot.proxy) {
            slot.force_before = slot.force;
            touch(slot, now);
        }
    }
}

void SessionLoop::fade_jumps() {
    for (ProxySlot& slot : proxies_) {
        if (slot.proxy && slot.description.device < max_devices) {
            slot.state.force = slot.fading.felt(slot.force, force_limit(slot), slot.jumped, slot.step);
        }
    }
    fade_tools();
}

FadingForce::Step SessionLoop::step_of(const ProxySlot& slot) const {
    FadingForce::Step step{slot.hand, slot.hand_velocity, slot.walls.most};
    step.fade = fade_of(slot.description.device);
    step.proxy = slot.proxy->position();
    for (const Touch& contact : slot.proxy->touching()) {
        step.damping = std::max(step.damping, feel_at(scene_, contact).material->damping);
    }
    return step;
}

// At the depth that one surface is pressed to, another one that is softer or stiffer presses otherwise: who
// drags across their border, or against a wall, has not gone that deep into it.
bool SessionLoop::touches_other_walls(ProxySlot& slot) const {
    Stiffnesses now;
    for (const Touch& contact : slot.proxy->touching()) {
        const Feel feel = feel_at(scene_, contact);
        const double stiffness = std::max(spring_of(*feel.material).steepest(),
                                          feel.curve() != nullptr ? feel.curve()->steepest : 0.0);
        now.least = now.most == 0.0 ? stiffness : std::min(now.least, stiffness);
        now.most = std::max(now.most, stiffness);
    }
    const Stiffnesses before = std::exchange(slot.walls, now);
    return before.most > 0.0 && now.most > 0.0 && before != now;
}

// Bodies get their part only now: what a correction of this tick changes is in it.
void SessionLoop::press_all() {
    for (ProxySlot& slot : proxies_) {
        if (slot.proxy) {
            press_bodies(slot);
            for (const ShaftForce& force : slot.punctures.forces()) {
                const Body& pierced = bodies_[handle_of_slot_[static_cast<std::size_t>(force.body)]];
                if (pierced.motion == Motion::Dynamic) {
                    physics_.apply_hand_force(pierced.id, -force.on_hand, force.point);
                }
            }
            if (is_held(slot)) {
                attract(slot, true);
            }
        }
    }
    for (const std::unique_ptr<ToolSlot>& slot : tools_) {
        if (slot) {
            press_bodies(*slot);
        }
    }
}

void SessionLoop::touch(ProxySlot& slot, Nanoseconds now) {
    slot.parts = {};
    if (!is_held(slot)) {
        slot.force = slot.effects.besides = Vec3(0.0);
        slot.torsion.count = 0;
        slot.aids = {};
        slot.punctures.clear();
        slot.proxy->restart();
        slot.walls = {};
        const ProxyState before = std::exchange(slot.state, {});
        slot.state.position = slot.idle ? before.position : slot.hand;
        slot.state.hand = slot.idle ? before.hand : slot.hand;
        slot.state.status = slot.idle ? far_hand_away : touch_unheld;
        slot.step = step_of(slot);
        slot.jumped = true;
        return;
    }
    // A path goes on where it stopped; a real hand may be deep inside a body by now.
    if (std::exchange(slot.rested, false) &&
        glm::distance(slot.hand, slot.state.hand) > slot.proxy->settings().radius) {
        slot.proxy->restart();
    }
    const ProxyTick tick = slot.proxy->move(scene_, slot.hand, seconds_);
    HandForce& force = slot.parts;
    DeviceSlot& device = devices_[slot.description.device];
    const HandMotion motion{slot.hand, slot.hand_velocity};
    const AidedHand hand = aided_hand(slot.description.device, motion, now);
    const AidForce aid = aid_force(slot.description.aids, hand, slot.field, slot.aids);
    const bool changed = std::exchange(slot.changed, false);
    const Wall within = feel_punctures(slot, hand, aid.damping);
    const double left = aid.damping - damping_needed(within.stiffness, hand.lag) - within.damping;
    force = contact_force(scene_, slot.proxy->touching(), tick.slide, slot.hand_velocity, seconds_,
                          {hand.lag, left, slot.description.finger.stiffness});
    slot.pressed = force.total;
    note_walls(slot, device);
    break_surfaces(slot, force);
    add_surface_effects(scene_, slot.proxy->touching(), motion, now, seconds_, slot.effects, force);
    slot.jumped = touches_other_walls(slot) || tick.jumped || aid.jumped || changed;
    if (slot.description.force_law == ForceLaw::smoothed && !slot.jumped) {
        smooth(force, slot.force_before - slot.effects.besides);
    }
    const double max_change = max_pull_rate * seconds_ / device.workspace.force_scale;
    slot.effects.besides = aid.force + slot.punctures.total() +
                           gradual_pull(attract(slot, false), max_change, magnet_changes_, slot.effects);
    slot.force = force.total + slot.effects.besides;
    slot.step = step_of(slot);
    slot.step.stiffness += aid.wall.stiffness + within.stiffness;
    slot.step.damping += aid.wall.damping + within.damping;
    slot.sliding = (tick.status & proxy_sliding) != 0;
    hold_against_turning(slot);
    status_ |= tick.status & proxy_unfinished ? static_cast<TickStatus>(session_proxy_unfinished) : 0u;
    describe(slot, tick);
}

// Magnetic surfaces pull from a distance, and are pulled where `press` says so.
Vec3 SessionLoop::attract(const ProxySlot& slot, bool press) {
    Vec3 pull(0.0);
    const ProxySettings& proxy = slot.proxy->settings();
    for (const SessionHandle handle : magnets_) {
        const Body& magnet = bodies_[handle];
        const TouchBody& surface = scene_.body(magnet.slot);
        const double far = proxy.radius + surface.material.magnet_range;
        if ((surface.layer & proxy.mask) == 0) {
            continue;
        }
        const SurfaceHit nearest = nearest_surface(*surface.shape, surface.pose, slot.proxy->position(), far);
        const double strength = magnet_pull(surface.material, nearest.distance - proxy.radius);
        const Vec3 on_hand = nearest.normal * -strength;
        pull += on_hand;
        if (press && magnet.motion == Motion::Dynamic) {
            physics_.apply_hand_force(magnet.id, -on_hand,
                                      slot.proxy->position() - nearest.normal * nearest.distance);
        }
    }
    return pull;
}

// What each contact of a soft finger holds the body by against turning. Over a link only places are told: a
// finger there does not turn, and neither does that of the model.
void SessionLoop::hold_against_turning(ProxySlot& slot) const {
    const SoftFinger& finger = slot.description.finger;
    if (!finger.is_soft()) {
        slot.torsion.count = 0;
        return;
    }
    const Vec3 hand_turn = side_ ? Vec3(0.0) : devices_[slot.description.device].hand_turn;
    const TorsionList before = std::exchange(slot.torsion, {});
    for (int i = 0; i < slot.parts.contact_count; ++i) {
        const Touch& contact = slot.proxy->touching()[static_cast<std::size_t>(i)];
        const TouchBody& body = scene_.body(contact.body);
        const Feel feel = feel_at(scene_, contact);
        const double share =
            friction_share(scene_, feel, contact.body, contact.feature, contact.point, contact.normal);
        const Vec3& on_hand = slot.parts.contacts[i].on_hand;
        const double pressing = std::max(0.0, glm::dot(on_hand, contact.normal));
        const double along = glm::length(on_hand - contact.normal * glm::dot(on_hand, contact.normal));
        const double slipping =
            torsion_limit(finger, share * feel.material->dynamic_friction, pressing, along);
        const double at_rest = torsion_limit(finger, share * feel.material->static_friction, pressing, along);
        const Vec3 body_turn =
            body.moved ? turn_vector(body.pose.rotation * glm::conjugate(body.previous.rotation)) : Vec3(0.0);
        Torsion torsion = before.grip_of(contact.body, contact.normal);
        turn_in_grip(torsion, {slot.sliding ? slipping : std::max(slipping, at_rest), slipping},
                     glm::dot(body_turn - hand_turn, contact.normal));
        torsion.finger_spin = glm::dot(hand_turn, contact.normal) / seconds_;
        slot.torsion.add(torsion);
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

void SessionLoop::describe(ProxySlot& slot, const ProxyTick& tick) {
    ProxyState& state = slot.state;
    state.position = tick.position;
    state.hand = slot.hand;
    state.hand_velocity = slot.hand_velocity;
    state.force = slot.force;
    state.residual = tick.residual;
    state.status = tick.status | (slot.field.is_limited() ? touch_field_limited : 0u);
    state.contact_count = 0;
    for (const Touch& contact : slot.proxy->touching()) {
        if (state.contact_count == HandForce::max_contacts) {
            break;
        }
        const auto i = static_cast<std::size_t>(state.contact_count++);
        state.bodies[i] = handle_of_slot_[static_cast<std::size_t>(contact.body)];
        state.points[i] = contact.point;
        state.normals[i] = contact.normal;
        state.forces[i] = slot.parts.contacts[i].on_hand;
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
