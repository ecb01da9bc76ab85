// How a loop is corrected, and how it goes back and does a tick again.
#include <algorithm>
#include <utility>

#include "session/loop_memento.hpp"
#include "session/session_loop.hpp"

namespace tactus {

DeviceSample SessionLoop::device_sample(SessionHandle device) const {
    return device < max_devices && devices_[device].device ? devices_[device].sample : DeviceSample{};
}

BodyMotion SessionLoop::motion(SessionHandle handle) {
    return physics_.state(bodies_[handle].id);
}

Pose SessionLoop::on_joints(SessionHandle handle, const Pose& pose) const {
    return physics_.on_joints(bodies_[handle].id, pose);
}

bool SessionLoop::asleep(SessionHandle handle) {
    return !physics_.awake(bodies_[handle].id);
}

bool SessionLoop::touching(SessionHandle first, SessionHandle second) const {
    return physics_.touching(bodies_[first].id, bodies_[second].id);
}

void SessionLoop::set_factors(SessionHandle handle, const BodyFactors& factors) {
    physics_.set_factors(bodies_[handle].id, factors);
}

// How it is touched alone: what it is made of stays its owner's.
void SessionLoop::set_touch(SessionHandle handle, const TouchMaterial& material) {
    scene_.set_material(bodies_[handle].slot, material);
}

double SessionLoop::mass(SessionHandle handle) const {
    return physics_.mass(bodies_[handle].id);
}

Vec3 SessionLoop::given_force(const ProxySlot& slot) const {
    return slot.description.device < max_devices
               ? slot.state.force - devices_[slot.description.device].refused
               : slot.state.force;
}

Vec3 SessionLoop::given_force(const ToolSlot& slot) const {
    return slot.use.device < max_devices ? slot.state.force - devices_[slot.use.device].refused
                                         : slot.state.force;
}

Vec3 SessionLoop::given_torque(const ToolSlot& slot) const {
    return slot.use.device < max_devices
               ? torque_in_scene(devices_[slot.use.device].workspace, devices_[slot.use.device].safe.torque)
               : Vec3(0.0);
}

Vec3 SessionLoop::pushed(SessionHandle handle) const {
    Vec3 force(0.0);
    if (handle >= bodies_.size() || bodies_[handle].slot < 0 || bodies_[handle].motion != Motion::Dynamic) {
        return force;
    }
    for (const ProxySlot& slot : proxies_) {
        for (int i = 0; slot.proxy && i < slot.parts.contact_count; ++i) {
            if (slot.parts.contacts[i].body == bodies_[handle].slot) {
                force -= slot.parts.contacts[i].on_hand;
            }
        }
    }
    for (const std::unique_ptr<ToolSlot>& slot : tools_) {
        for (const ToolTouch& touch : slot ? slot->proxy.touching() : std::span<const ToolTouch>()) {
            if (touch.body == bodies_[handle].slot) {
                force -= touch.force * slot->hand.share;
            }
        }
    }
    return force * (seconds_ / physics_.mass(bodies_[handle].id));
}

bool SessionLoop::rests_on(const Proxy& proxy, SessionHandle handle) const {
    const int slot = bodies_[handle].slot;
    return std::ranges::any_of(proxy.touching(), [slot](const Touch& c) { return c.body == slot; });
}

bool SessionLoop::rests_on(const ToolProxy& proxy, SessionHandle handle) const {
    const int slot = bodies_[handle].slot;
    return std::ranges::any_of(proxy.touching(), [slot](const ToolTouch& c) { return c.body == slot; });
}

bool SessionLoop::is_touched(SessionHandle handle) const {
    return std::ranges::any_of(
               proxies_, [&](const ProxySlot& p) { return p.present() && rests_on(*p.proxy, handle); }) ||
           std::ranges::any_of(tools_, [&](const auto& t) { return t && rests_on(t->proxy, handle); });
}

void SessionLoop::put_right(SessionHandle handle, const BodyMotion& to, bool with_velocity, bool rides,
                            const Pose* previous) {
    Body* const corrected = body(handle);
    if (!corrected) {
        return;
    }
    const Pose motion = displacement(scene_.body(corrected->slot).pose, to.pose);
    for (ProxySlot& slot : proxies_) {
        if (slot.proxy && rests_on(*slot.proxy, handle)) {
            slot.proxy->go_along(to_parent(motion, slot.proxy->position()) - slot.proxy->position(),
                                 corrected->slot);
            rides = true;
        }
    }
    for (const std::unique_ptr<ToolSlot>& slot : tools_) {
        if (slot && rests_on(slot->proxy, handle)) {
            slot->proxy.go_along(scene_, motion, corrected->slot);
            rides = true;
        }
    }
    if (previous) {
        scene_.set_pose(corrected->slot, *previous, true);
    } else if (rides) {
        scene_.displace(corrected->slot, motion);
    }
    scene_.set_pose(corrected->slot, to.pose);
    physics_.set_pose(corrected->id, to.pose);
    if (with_velocity && corrected->motion != Motion::Static) {
        physics_.set_velocity(corrected->id, to.linear_velocity, to.angular_velocity);
    }
    if (state_of_[handle] == no_handle) {
        show_state(handle);
    }
    note_state(handle,
               {to.pose, physics_.linear_velocity(corrected->id), physics_.angular_velocity(corrected->id)});
}

void SessionLoop::begin_replay_tick() {
    ++tick_;
    scene_.begin_tick();
    take_forms();
    // No device is read here: a replay says itself which hands there are (ProxySlot::idle, ToolHand::holds).
    for (DeviceSlot& slot : devices_) {
        slot.silent = 0.0;
    }
    if (std::exchange(follows_all_, false)) {
        for (const BodyState& state : states_) {
            place(state.handle, motion(state.handle), false);
        }
    } else {
        follow_physics();
    }
}

void SessionLoop::end_replay_tick(Nanoseconds now) {
    touch_all(now);
    touch_tools();
    press_all();
    step_physics();
}

bool SessionLoop::save(LoopMemento& memento) {
    memento.place_count = 0;
    memento.physics_bytes = 0;
    if (states_.size() > memento.places.size()) {
        return false;
    }
    for (const BodyState& state : states_) {
        if (bodies_[state.handle].motion == Motion::Static) {
            continue;
        }
        memento.places[memento.place_count++] = {state.handle, scene_.body(bodies_[state.handle].slot).pose};
    }
    for (std::size_t i = 0; i < proxies_.size(); ++i) {
        if (proxies_[i].proxy) {
            memento.pointers[i] = {proxies_[i].proxy->memory(), proxies_[i].effects, proxies_[i].torsion,
                                   proxies_[i].force, proxies_[i].aids};
        }
    }
    for (std::size_t i = 0; i < tools_.size(); ++i) {
        if (tools_[i]) {
            memento.tools[i] = tools_[i]->proxy.memory();
        }
    }
    memento.physics_bytes = physics_.save_everything(memento.physics);
    return memento.physics_bytes > 0;
}

bool SessionLoop::restore(const LoopMemento& memento) {
    if (memento.physics_bytes == 0 ||
        !physics_.restore(std::span(memento.physics).first(memento.physics_bytes))) {
        return false;
    }
    physics_.set_gravity(gravity_);  // as it is now, like all settings; the memento holds an older one
    for (std::size_t i = 0; i < memento.place_count; ++i) {
        if (const Body* const placed = body(memento.places[i].handle)) {
            scene_.set_pose(placed->slot, memento.places[i].pose, true);
        }
    }
    follows_all_ = true;
    for (std::size_t i = 0; i < proxies_.size(); ++i) {
        if (proxies_[i].proxy) {
            proxies_[i].proxy->recall(memento.pointers[i].proxy);
            proxies_[i].effects = memento.pointers[i].effects;
            proxies_[i].torsion = memento.pointers[i].torsion;
            proxies_[i].force = memento.pointers[i].force;
            proxies_[i].aids = memento.pointers[i].aids;
        }
    }
    for (std::size_t i = 0; i < tools_.size(); ++i) {
        if (tools_[i]) {
            tools_[i]->proxy.recall(memento.tools[i], scene_);
        }
    }
    return true;
}

void SessionLoop::follow_still(SessionLoop& other) {
    for (const BodyState& state : other.states_) {
        const Body* const still = body(state.handle);
        if (!still || still->motion != Motion::Static) {
            continue;
        }
        const Pose there = other.physics_.pose(other.bodies_[state.handle].id);
        const Pose here = physics_.pose(still->id);
        if (here.position != there.position || here.rotation != there.rotation) {
            put_right(state.handle, {there, Vec3(0.0), Vec3(0.0)}, false, false, &there);
        }
    }
}

}  // namespace tactus
