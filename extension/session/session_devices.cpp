// How the loop reads its devices, and what leaves for them.
#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "core/math/body_motion.hpp"
#include "core/math/shortened.hpp"
#include "physics/limits.hpp"
#include "realtime/thread_role.hpp"
#include "session/input_recorder.hpp"
#include "session/session_loop.hpp"

namespace tactus {

namespace {

// Without a far side nothing comes over a link: a device's longest force is limit enough.
constexpr double no_limit = std::numeric_limits<double>::infinity();
constexpr ForceLimits local_touch{no_limit, no_limit, no_limit};

// No handle turns farther from one tick to the next, also where its rotation comes a hundred times a second
// (unit: radians).
constexpr double farthest_turn = 1.0;

SafetySettings settings_of(const DeviceCapabilities& device, const Workspace& workspace,
                           const ForceLimits& side, bool drives) {
    SafetySettings settings;
    settings.limits = {std::min(side.slew, device.max_slew), std::min(side.energy, device.max_energy),
                       std::min(side.power, device.max_power)};
    settings.max_force = std::min(workspace.force_limit, device.max_force);
    settings.torque_limits = {device.max_torque_slew, device.max_energy, device.max_power};
    settings.max_torque = device.max_torque;
    settings.max_speed = device.max_speed;
    settings.max_turn = device.feels ? farthest_turn : SafetySettings::none;
    settings.ramp = device.ramp;
    settings.dead_man = workspace.dead_man;
    settings.passive = device.feels && !drives;
    settings.damping = device.damping;
    settings.max_damping = device.max_damping;
    settings.velocity_smoothed = device.velocity_smoothed;
    settings.sees_frozen = device.feels;
    return settings;
}

}  // namespace

void SessionLoop::read_devices(Nanoseconds now) {
    for (DeviceSlot& slot : devices_) {
        if (!slot.device) {
            continue;
        }
        const DeviceSample sample = slot.device->read(now);
        slot.heard = sample;
        slot.displayed = slot.device->displayed();
        const DeviceCapabilities before = std::exchange(slot.capabilities, slot.device->capabilities());
        slot.jumped = slot.jumped || slot.capabilities != before;
        if (recorder_) {
            recorder_->note_reading(static_cast<SessionHandle>(&slot - devices_.data()), sample,
                                    slot.capabilities);
        }
        slot.is_sound = limits::is_place(sample.position) && limits::is_place(sample.velocity) &&
                        limits::is_rotation(sample.rotation);
        if (slot.is_sound) {
            slot.sample = sample;
        } else {
            slot.sample.velocity = Vec3(0.0);  // nonsense: it stays where it was
            slot.sample.connected = false;
        }
        slot.silent = slot.sample.connected ? 0.0 : slot.silent + seconds_;
        place_hand(slot);
        slot.has_pressed = false;
        slot.force = Vec3(0.0);
        slot.torque = Vec3(0.0);
    }
    for (ProxySlot& slot : proxies_) {
        if (slot.proxy && slot.description.device < max_devices) {
            slot.hand = devices_[slot.description.device].hand;
            slot.hand_velocity = devices_[slot.description.device].hand_velocity;
        }
    }
    hold_tools(now);
}

void SessionLoop::place_hand(DeviceSlot& slot) const {
    const Vec3 reached = into_scene(slot.workspace, slot.sample.position);
    const bool held = slot.workspace.clutch;
    Vec3 drift(0.0);
    if (held && slot.was_held) {
        slot.offset = slot.hand - reached;
    } else if (!held && slot.sample.connected) {
        drift = drift_at_edge(slot.workspace, slot.capabilities.radius, slot.sample.position);
        slot.offset += drift * seconds_;
    }
    // Rotations are taken that are nearly one: what is off would grow with each use of the clutch.
    const Quat turned = glm::normalize(slot.workspace.pose.rotation * slot.sample.rotation);
    if (held && slot.was_held) {
        slot.turn_offset = slot.orientation * glm::conjugate(turned);
    }
    slot.orientation = glm::normalize(slot.turn_offset * turned);
    slot.was_held = held;
    slot.hand = reached + slot.offset;
    slot.hand_velocity = held ? Vec3(0.0) : velocity_in_scene(slot.workspace, slot.sample.velocity) + drift;
    if (slot.capabilities.rotates) {
        const Quat before = std::exchange(slot.rotation, turned);
        slot.hand_turn = held ? Vec3(0.0) : turn_vector(turned * glm::conjugate(before));
    }
}

double SessionLoop::force_limit(SessionHandle device) const {
    if (device >= max_devices) {
        return Workspace{}.force_limit;
    }
    const DeviceSlot& slot = devices_[device];
    return std::min(slot.workspace.force_limit, slot.capabilities.max_force) / slot.workspace.force_scale;
}

// FadingForce::Step::fade of who is in that hand (unit: newtons of the scene).
double SessionLoop::fade_of(SessionHandle device) const {
    return FadingForce::max_step / (device < max_devices ? devices_[device].workspace.force_scale : 1.0);
}

RobotView SessionLoop::robot(SessionHandle device) const {
    if (device >= max_devices || !devices_[device].device) {
        return {};
    }
    const DeviceSlot& slot = devices_[device];
    return {slot.sample.connected, slot.capabilities, slot.workspace};
}

void SessionLoop::write_devices(Nanoseconds now) {
    for (const ProxySlot& slot : proxies_) {
        if (slot.proxy && slot.description.device < max_devices) {
            devices_[slot.description.device].force += slot.state.force;
        }
    }
    for (const std::unique_ptr<ToolSlot>& slot : tools_) {
        if (slot && slot->use.device < max_devices) {
            devices_[slot->use.device].force += slot->state.force;
            devices_[slot->use.device].torque += slot->state.torque;
        }
    }
    for (std::size_t i = 0; i < devices_.size(); ++i) {
        DeviceSlot& slot = devices_[i];
        if (!slot.device) {
            continue;
        }
        slot.force += slot.workspace.force;
        slot.asked = slot.force;
        const Vec3 asked_of_device = force_on_device(slot.workspace, slot.asked);
        const SafetySample sample = safety_sample(slot, i);
        const SafetySettings settings =
            settings_of(slot.capabilities, slot.workspace, side_ ? side_->limits() : local_touch,
                        side_ && side_->drives());
        slot.safe = slot.safety.pass(settings, sample);
        if (slot.safe.force != asked_of_device) {
            slot.force = force_in_scene(slot.workspace, slot.safe.force);
        }
        slot.refused = slot.asked - slot.force;
        const bool limited = slot.safe.limited != 0;
        status_ |= limited ? static_cast<TickStatus>(session_force_limited) : 0u;
        for (ProxySlot& proxy : proxies_) {
            if (limited && side_ && proxy.proxy && proxy.description.device == i) {
                proxy.state.status |= felt_limited;
            }
        }
        slot.device->twist(slot.safe.torque);
        slot.device->write(now, with_arm_carried(slot, settings.max_force));
    }
}

// The motors carry the device's own arm where they may give a force at all, and within its limit. It weighs
// the same wherever the hand is, so that carrying it makes no energy on any closed path.
Vec3 SessionLoop::with_arm_carried(DeviceSlot& slot, double max_force) const {
    constexpr double carrying_time = 0.5;  // until all of it is carried (unit: seconds)
    const double weight = slot.capabilities.weight;
    const bool is_on = slot.safe.state == HandState::working || slot.safe.state == HandState::ramping;
    slot.carried = is_on ? std::min(slot.carried + weight * seconds_ / carrying_time, weight) : 0.0;
    const Vec3 force = slot.safe.force;
    return slot.carried > 0.0 ? shortened(force + Vec3(0.0, slot.carried, 0.0), max_force) : force;
}

// Of what is in that hand: one jump fades after the other.
bool SessionLoop::touch_fades(std::size_t device) const {
    const auto pointer_fades = [&](const ProxySlot& slot) {
        return slot.proxy && slot.description.device == device && slot.fading.fades();
    };
    const auto tool_fades = [&](const std::unique_ptr<ToolSlot>& slot) {
        return slot && slot->use.device == device && slot->fading.fades();
    };
    return std::ranges::any_of(proxies_, pointer_fades) || std::ranges::any_of(tools_, tool_fades);
}

// What is not pressed by a surface at rest may give energy to the hand: bodies on their way, and what a scene
// means to add. Over a link without a model nothing is known of that, and everything is held to be passive.
SafetySample SessionLoop::safety_sample(DeviceSlot& slot, std::size_t index) const {
    SafetySample sample;
    const bool fades = touch_fades(index);
    const bool waits = std::exchange(slot.touch_faded, fades) || fades;
    const double pace = waits ? 0.0 : 1.0;
    FadingForce::Step step, turn;
    step.fade = pace * FadingForce::max_step;
    turn.fade = pace * FadingWrench::max_torque_step;
    const Wrench wanted = slot.fading.felt(
        {force_on_device(slot.workspace, slot.force), torque_on_device(slot.workspace, slot.torque)},
        slot.workspace.force_limit, std::exchange(slot.jumped, false), step, turn);
    sample.wanted = wanted.force;
    sample.torque = direction_to_local(slot.workspace.pose, slot.workspace.torque) + wanted.torque;
    sample.rotation = slot.sample.rotation;
    sample.position = slot.heard.position;
    sample.velocity = slot.heard.velocity;
    sample.buttons = slot.heard.buttons;
    sample.connected = slot.heard.connected;
    sample.sound = slot.is_sound;
    sample.enabled = !slot.workspace.clutch;
    sample.seconds = seconds_;
    sample.source = std::max(0.0, seconds_ * glm::dot(slot.fading.force_offset(), slot.heard.velocity));
    sample.source += energy_on_device(
        slot.workspace, std::max(0.0, seconds_ * glm::dot(slot.workspace.force, slot.hand_velocity)));
    for (const ProxySlot& proxy : proxies_) {
        if (proxy.proxy && proxy.description.device == index && (!side_ || side_->simulates())) {
            const double added = seconds_ * glm::dot(proxy.state.force - proxy.pressed, slot.hand_velocity);
            sample.source +=
                energy_on_device(slot.workspace, std::max(0.0, added) + std::max(0.0, proxy.parts.source));
        }
        if (proxy.proxy && proxy.description.device == index) {
            sample.own_change += proxy.own_change;
        }
    }
    for (const std::unique_ptr<ToolSlot>& tool : tools_) {
        if (tool && tool->use.device == index) {
            sample.source += energy_on_device(slot.workspace, tool->source);
            sample.own_change += tool->own_change;
        }
    }
    return sample;
}

// A hand of that device, for what acts on it besides touch.
AidedHand SessionLoop::aided_hand(SessionHandle handle, const HandMotion& motion, Nanoseconds now) const {
    const DeviceSlot& device = devices_[handle];
    const DeviceCapabilities& can = device.capabilities;
    const double most_damping =
        can.feels ? std::min(HandField::thickest, damping_in_scene(device.workspace, can.max_damping))
                  : HandField::thickest;
    return {motion,       {seconds_, can.delay}, damping_in_scene(device.workspace, can.damping),
            most_damping, force_limit(handle),   now};
}

// For the owner to tell: which wall was not safe.
void SessionLoop::note_walls(const ProxySlot& slot, DeviceSlot& device) const {
    for (int i = 0; i < slot.parts.contact_count; ++i) {
        const ContactForce& part = slot.parts.contacts[i];
        if (!std::exchange(device.has_pressed, true)) {
            device.wanted_stiffness = device.used_stiffness = 0.0;
        }
        const double left_out = part.wanted_stiffness - part.wall.stiffness;
        if (left_out > device.wanted_stiffness - device.used_stiffness) {
            device.wanted_stiffness = part.wanted_stiffness;
            device.used_stiffness = part.wall.stiffness;
        }
    }
}

void SessionLoop::rest() {
    TACTUS_ASSERT_HAPTIC_THREAD();
    for (DeviceSlot& slot : devices_) {
        if (slot.device) {
            slot.force = slot.asked = Vec3(0.0);
            slot.fading.clear();
            slot.safety.rest();
            slot.safe.torque = Vec3(0.0);
            slot.device->twist(Vec3(0.0));
            slot.device->write(time_, slot.force);
        }
    }
    for (ProxySlot& slot : proxies_) {
        slot.force = Vec3(0.0);
        slot.state.force = Vec3(0.0);
        slot.fading.clear();
        slot.rested = true;
    }
    for (const std::unique_ptr<ToolSlot>& slot : tools_) {
        if (slot) {
            slot->wrench = {};
            slot->state.force = Vec3(0.0);
            slot->state.torque = Vec3(0.0);
            slot->fading.clear();
            slot->rested = true;
        }
    }
    publish(time_);
}

}  // namespace tactus
