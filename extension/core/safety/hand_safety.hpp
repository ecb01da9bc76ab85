// The last place before a device: whatever the loop asks for, what leaves here is safe for a hand.
//
//     reading is no number, jumps or is frozen, no button is held        no force, at once
//     just begun, reconnected, let go of the clutch                      the force grows from nothing
//     touch would make energy                                            HandPassivity damps it
//     larger, faster or more powerful than the device allows             ForceExit cuts it
//
// A torque goes the same way, by limits of its own. It is always the scene's to give: only its power is
// limited.
//
// Pure values: no clock, no allocation.
#pragma once

#include <limits>

#include "core/math/types.hpp"
#include "core/safety/force_exit.hpp"
#include "core/safety/hand_passivity.hpp"

namespace tactus {

enum class HandState : std::uint8_t {
    working,
    ramping,       // the force grows from nothing
    disabled,      // by its owner: switched off, or the clutch is held
    released,      // nobody holds the dead-man button
    disconnected,  // the device does not answer
    no_number,     // it has said what is no place
    jumped,        // it says that it is, goes or has turned to where no hand can come to in a tick
    frozen,        // it repeats its position, and says that it moves
};

// What was done to the force, as bits.
enum HandLimited : std::uint32_t {
    hand_limited_force = 1u << 0,      // by size, slew or power
    hand_limited_passivity = 1u << 1,  // it would have made energy
    hand_limited_command = 1u << 2,    // it was no number
};

struct SafetySettings {
    static constexpr double none = std::numeric_limits<double>::infinity();

    ForceLimits limits{none, none, none};
    double max_force = none;                      // (unit: newtons)
    ForceLimits torque_limits{none, none, none};  // the slew in newton meters per second
    double max_torque = 0.0;                      // (unit: newton meters); 0: there is none to give
    double max_speed = none;         // of a hand; faster ones are no readings (unit: meters per second)
    double max_turn = none;          // of a handle from one reading to the next (unit: radians)
    double ramp = 0.0;               // until the whole force is given (unit: seconds), >= 0
    std::uint32_t dead_man = 0;      // buttons, any of which must be held; 0: none
    bool passive = false;            // observe energy and keep it from being made
    double damping = 0.0;            // of the device itself (unit: newton seconds per meter), >= 0
    double max_damping = 0.0;        // that may be added (the same unit), >= 0
    double velocity_smoothed = 0.0;  // see DeviceCapabilities (unit: seconds), >= 0
    bool sees_frozen = false;        // a position that stays although the hand moves is no reading
};

struct SafetySample {
    Vec3 wanted{0.0};    // (unit: newtons)
    Vec3 torque{0.0};    // wanted on the handle, which the scene gives as it likes (unit: newton meters)
    Vec3 position{0.0};  // of the hand, in the device's own measure (unit: meters)
    Vec3 velocity{0.0};  // (unit: meters per second)
    Quat rotation{1.0, 0.0, 0.0, 0.0};  // of the handle
    std::uint32_t buttons = 0;
    bool connected = true;
    bool sound = true;  // false: some field of the reading is no place, velocity or rotation
    bool enabled = true;
    double source = 0.0;      // see PassivitySample
    double own_change = 0.0;  // see ForceExit::leave
    double seconds = 0.001;   // of a tick
};

struct SafeForce {
    Vec3 force{0.0};   // (unit: newtons)
    Vec3 torque{0.0};  // (unit: newton meters)
    HandState state = HandState::working;
    std::uint32_t limited = 0;  // HandLimited
};

class HandSafety {
public:
    SafeForce pass(const SafetySettings& settings, const SafetySample& sample);

    // Ticks stop: what comes next begins at nothing.
    void rest();

    double energy() const { return passivity_.energy(); }
    // That its forces have done on the hand so far (unit: joules); below zero: taken from it. A force is held
    // for a tick, so this is exact.
    double work() const { return work_; }

private:
    HandState state_of(const SafetySettings& settings, const SafetySample& sample) const;
    Vec3 torque_of(const SafetySettings& settings, const SafetySample& sample, double share, const Vec3& spin,
                   std::uint32_t& limited);

    ForceExit exit_, torque_exit_;
    HandPassivity passivity_;
    double ramped_ = 0.0;  // since the hand was last given nothing (unit: seconds)
    bool known_ = false;   // position_ is where the hand was one tick ago
    Vec3 position_{0.0};
    double stayed_ = 0.0;   // the path of the velocity since the position changed last (unit: meters)
    double stopped_ = 0.0;  // the speed that it said then (unit: meters per second)
    Vec3 given_{0.0};       // in the last tick
    double work_ = 0.0;
    Quat rotation_{1.0, 0.0, 0.0, 0.0};
};

// For people, with what to do.
const char* text_of(HandState state);

}  // namespace tactus
