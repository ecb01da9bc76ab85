// What an experiment of teleoperation is made of: a scene and a case, as plain values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "devices/hand_path.hpp"
#include "devices/simulated_arm.hpp"
#include "network/link_conditions.hpp"
#include "session/session.hpp"
#include "session/teleop_port.hpp"

namespace tactus::shared {

struct TeleopBody {
    std::string name;
    BodyAddition addition;
};

// What of a model is wrong, by the body's name.
struct WrongBody {
    Vec3 move{0.0};                 // (unit: meters)
    Quat turn{1.0, 0.0, 0.0, 0.0};  // about the body's own origin
    double swing = 0.0;             // about its hinge (unit: radians)
    double mass = 1.0;              // factor
    double friction = 1.0;          // factor, of the body on other bodies
    double touch_friction = 1.0;    // factor, of the pointer on the body
    double stiffness = 1.0;         // factor
};

// A hinge between a body and the world, at a place on the body where the scene (not the model) has it.
struct TeleopHinge {
    std::size_t body = 0;  // of the scene
    Vec3 at{0.0};          // in the world (unit: meters)
    Vec3 axis{0.0, 1.0, 0.0};
};

struct TeleopScene {
    std::vector<TeleopBody> bodies;
    std::vector<TeleopHinge> hinges;
    double radius = 0.01;  // of the pointer (unit: meters)
    double force_limit = 1e6;
    HandPath path = CircleWave{};
};

struct TeleopCase {
    std::string name;
    TeleopSettings settings;
    LinkConditions forth;  // from the operator
    LinkConditions back;
    std::uint64_t seed = 1;
    std::map<std::string, WrongBody> wrong;
    bool uses_arm = false;  // the hand is pushed back; beside it, an arm of its own touches without a link
    ArmSettings arm;
    double settled_from = 0.0, settled_to = 0.0;  // the arm holds still: how deep it settles (unit: seconds)
    double seconds = 10.0;
    Nanoseconds phase = 0;            // of the far side's ticks after the operator's, 0 … period - 1
    Nanoseconds late = 0;             // the far side starts so much after the operator's, >= 0
    Vec3 path_shift{0.0};             // the hand's path lies so far off the scene's (unit: meters)
    double pose_noise = 0.0;          // standard deviation of what the far side says of places (unit: meters)
    bool correct_from_touch = false;  // the model is left wrong until it is touched
    std::string object;               // the body whose place is compared; empty: none. box_position_error
                                      // is that of the dynamic body that is off most
    std::string rows;                 // CSV of every tick; empty: none
};

}  // namespace tactus::shared
