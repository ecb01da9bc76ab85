// C': what stands in for the operator at the far side. Each scheme says where the far side's hand is to be,
// given what the operator sent; proxy and force law make the force of it there.
#pragma once

#include <cstdint>
#include <optional>

#include "core/math/pose.hpp"

namespace tactus {

enum class ControlScheme : std::uint8_t {
    spring,                   // a spring to the operator's hand, whatever is in between
    position,                 // thesis 1: in free space no faster than a given speed; in contact the spring
    position_force,           // thesis 2: in free space to the position; in contact the operator's force
    position_force_relative,  // thesis 3: near an object to the place relative to it; in contact the force
};

inline bool uses_force(ControlScheme scheme) {
    return scheme == ControlScheme::position_force || scheme == ControlScheme::position_force_relative;
}

struct StandInSettings {
    double speed = 1.0;  // of the hand in free space, scheme 1 (unit: meters per second), > 0
    double near = 0.03;  // how near an object is near, scheme 3 (unit: meters), > 0
    // A force, or a place relative to an object, leads the hand no farther from the operator's place, schemes
    // 2 and 3 (unit: meters), >= 0. Longer is worse: a box with less friction than believed runs away from a
    // force.
    double leash = 5e-4;
};

struct StandInInput {
    Vec3 hand{0.0};                // the operator's (unit: meters)
    Vec3 velocity{0.0};            // the operator's (unit: meters per second)
    Vec3 force{0.0};               // on the operator's hand (unit: newtons)
    std::optional<Vec3> relative;  // the operator's hand in the frame of its nearest object (unit: meters)
    Pose object;                   // of that object, here

    Vec3 own_hand{0.0};       // here, one tick ago (unit: meters)
    Vec3 own_proxy{0.0};      // here, one tick ago, carried along with what it touches (unit: meters)
    bool in_contact = false;  // here, one tick ago
    double stiffness = 0.0;   // of what is touched here (unit: newtons per meter)
    double seconds = 0.0;     // of a tick
};

// Where the far side's hand goes in this tick (unit: meters).
Vec3 stand_in_hand(ControlScheme scheme, const StandInSettings& settings, const StandInInput& input);

}  // namespace tactus
