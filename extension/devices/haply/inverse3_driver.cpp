#include "devices/haply/inverse3_driver.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <glm/geometric.hpp>

#include "platform/clock.hpp"

namespace tactus {

namespace {

// Their base frame has x to the right, y away from the user and z up; ours y up and z to the user.
Vec3 from_device(const Vec3& v) {
    return {v.x, v.z, -v.y};
}
Vec3 to_device(const Vec3& v) {
    return {v.x, -v.z, v.y};
}

// Amid the workspace, in the base frame (unit: meters).
constexpr Vec3 middle{0.04, -0.17, 0.16};

// Zeros, which are no rotation, where it is none.
Quat rotation_of(const JsonValue& turn) {
    Vec3 axis(0.0);
    if (!turn.vector(axis) || !turn["w"].has_number()) {
        return {0.0, 0.0, 0.0, 0.0};
    }
    const Vec3 ours = from_device(axis);
    const Quat rotation(turn["w"].number(), ours.x, ours.y, ours.z);
    return glm::dot(rotation, rotation) > 0.0 ? glm::normalize(rotation) : Quat(0.0, 0.0, 0.0, 0.0);
}

constexpr Nanoseconds first_state = 2'000'000'000;
constexpr Nanoseconds look_again = 2'000'000;

// A device's name is sent back with each force (unit: bytes).
constexpr std::size_t longest_id = 64;

bool can_be_sent_back(const std::string& id) {
    return id.size() <= longest_id &&
           std::ranges::none_of(id, [](unsigned char c) { return c < 0x20 || c == '"' || c == '\\'; });
}

// A state waits for the force that it leads to where the loop looks for it within that time, and writes that
// force within another one. Both together with the period of the service are less than a force lives
// (ForceLife).
constexpr Nanoseconds soon = 250'000;
constexpr Nanoseconds write_after_look = 100'000;

}  // namespace

std::string Inverse3Driver::open(const std::atomic<bool>& stop) {
    if (std::string problem = json_.load(); !problem.empty()) {
        return problem;
    }
    if (const std::string why = socket_.open(port_, stop); !why.empty()) {
        return "Haply's service does not run here (" + why + "): install and start Haply Hub";
    }
    std::string problem = "Haply's service says nothing: start Haply Hub anew";
    for (const Nanoseconds end = monotonic_now() + first_state; monotonic_now() < end && !stop.load();) {
        const int came = socket_.receive(text_, look_again);
        if (came == 0) {
            continue;
        }
        owed_ = came;
        problem = choose(json_.read(text_));
        if (problem.empty()) {
            return {};
        }
    }
    return problem;
}

// The first that no other driver has; empty, or why there is none.
std::string Inverse3Driver::choose(const JsonValue& state) {
    const JsonValue all = state["inverse3"];
    const std::string wanted = id_.empty() ? wanted_ : id_;
    std::string problem = wanted_.empty() ? "Haply's service has no Inverse3: plug it in, with its power"
                                          : "Haply's service has no Inverse3 " + wanted_;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::string id = all[i]["device_id"].text();
        if (!wanted.empty() && id != wanted) {
            continue;
        }
        if (!can_be_sent_back(id)) {
            problem = "Haply's service gives a device a name that no command can carry: start Haply Hub anew";
            continue;
        }
        if (claim_.take("Inverse3 " + std::to_string(port_) + " " + id)) {
            id_ = id;
            return {};
        }
        problem =
            "another HapticDevice has the Inverse3 " + id + ": plug in a second one, or let one node have it";
    }
    return problem;
}

void Inverse3Driver::close() {
    if (!socket_.is_gone() && sent_ != Vec3(0.0)) {
        send(Vec3(0.0));
    }
    socket_.close();
    sent_ = Vec3(0.0);
    owed_ = 0;
    claim_.give_back();
}

JsonValue Inverse3Driver::device_in(const JsonValue& state) const {
    const JsonValue all = state["inverse3"];
    const std::string& wanted = id_.empty() ? wanted_ : id_;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (wanted.empty() || all[i]["device_id"].text() == wanted) {
            return all[i];
        }
    }
    return all[all.size()];
}

// False where it says nothing of this device. What is no JSON, or no place, is a hand that is not there.
bool Inverse3Driver::take(const JsonValue& state, DeviceSample& sample) {
    const JsonValue device = device_in(state);
    if (state.exists() && !device.exists()) {
        return false;
    }
    Vec3 position, velocity;
    if (!device["state"]["cursor_position"].vector(position) ||
        !device["state"]["cursor_velocity"].vector(velocity)) {
        sample.connected = false;
        sample.velocity = Vec3(0.0);
        return true;
    }
    sample.position = from_device(position - middle);
    sample.velocity = from_device(velocity);
    is_calibrated_ = device["status"]["calibrated"].is_true();
    is_powered_ = device["status"]["power_supply"].is_true();
    sample.connected = is_calibrated_ && is_powered_;
    const JsonValue grip = state["wireless_verse_grip"][std::size_t{0}]["state"];
    // One that sleeps repeats what it said before.
    const JsonValue status = state["wireless_verse_grip"][std::size_t{0}]["status"];
    const auto is_not = [&status](const char* name) {
        return status[name].exists() && !status[name].is_true();
    };
    const bool is_awake = !is_not("connected") && !is_not("awake");
    if (const JsonValue turn = grip["orientation"]; is_awake && turn.exists()) {
        sample.rotation = rotation_of(turn);
    }
    sample.buttons = 0;
    const char* const names[] = {"a", "b", "c"};
    for (unsigned i = 0; i < 3; ++i) {
        sample.buttons |= is_awake && grip["buttons"][names[i]].is_true() ? 1u << i : 0u;
    }
    return true;
}

void Inverse3Driver::send(const Vec3& force) {
    const Vec3 theirs = to_device(force);
    char text[512];
    std::snprintf(text, sizeof text,
                  "{\"session\":{},\"inverse3\":[{\"device_id\":\"%s\",\"commands\":{\"set_cursor_force\":"
                  "{\"vector\":"
                  "{\"x\":%.6f,\"y\":%.6f,\"z\":%.6f},\"execute\":true}}}]}",
                  id_.c_str(), theirs.x, theirs.y, theirs.z);
    socket_.send(text);
    sent_ = force;
}

// What is owed for the last state, since the service sends the next one when it has an answer.
void Inverse3Driver::answer(ForceSlot& forces, Nanoseconds until) {
    if (const Nanoseconds look = forces.next_look(); look - monotonic_now() < soon) {
        forces.wait_for_write(std::min(until, look + write_after_look));
    }
    send(forces.living(monotonic_now()));
    forces.given(monotonic_now());
    owed_ = 0;
}

Driver::Exchange Inverse3Driver::exchange(ForceSlot& forces, Nanoseconds until, DriverReading& reading) {
    if (owed_ > 0) {
        answer(forces, until);
    }
    for (;;) {
        const std::array files{socket_.file()};
        if (sent_ != Vec3(0.0)) {
            forces.wait_for_write(std::min(until, forces.end() + 1), files);
        } else {
            forces.wait_for_files(until, files);
        }
        const int came = socket_.receive(text_, 0);
        if (socket_.is_gone()) {
            return Exchange::lost;
        }
        const Nanoseconds now = monotonic_now();
        owed_ += came;
        if (came > 0 && take(json_.read(text_), reading.sample)) {
            reading.at = now;
            forces.heard(now, now);
            forces.living(now);
            if (owed_ <= 0) {
                socket_.acknowledge();
            } else if (!reading.sample.connected) {
                send(Vec3(0.0));
                owed_ = 0;
            }
            if (!reading.sample.connected) {
                forces.taken();  // whether or not the loop sees this reading
            }
            return Exchange::reading;
        }
        // A newer force of the loop waits for the next state. That none is left does not, since the loop has
        // written so or the force has ended: it is the answer to the next state. One message more than there
        // are states would wait there, and all behind it; one less, and the service waits. Two states may
        // come at once where the first had its answer.
        const bool may_be_none = sent_ != Vec3(0.0) && (forces.is_written() || now > forces.end());
        if (may_be_none && forces.living(now) == Vec3(0.0)) {
            send(Vec3(0.0));
            --owed_;
            if (forces.is_alive()) {
                forces.given(monotonic_now());
            }
        }
        if (now >= until) {
            return Exchange::nothing;
        }
    }
}

DeviceCapabilities Inverse3Driver::capabilities() const {
    DeviceCapabilities device;
    device.feels = true;
    device.rotates = true;
    device.radius = 0.1;
    device.rate = 1000.0;
    device.delay = 0.001;
    device.max_force = 10.0;
    device.max_slew = 4000.0;
    device.max_power = 8.0;
    device.max_energy = 0.5;
    device.max_speed = 5.0;
    device.damping = 2.0;
    device.max_damping = 10.0;
    device.velocity_smoothed = unstated_smoothing;
    device.ramp = 0.3;
    return device;
}

std::string Inverse3Driver::advice() const {
    return !is_powered_ ? "the Inverse3 has no power: plug in its supply"
           : !is_calibrated_
               ? "the Inverse3 does not know where it is yet: put its cursor into the calibration dock"
               : "";
}

}  // namespace tactus
