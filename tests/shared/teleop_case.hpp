// What an experiment of teleoperation is made of: a scene and a case, as plain values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
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
    // Only where the model is discovered (TeleopCase::discovers).
    std::optional<double> touch_friction_is;  // of the pointer on the body, in place of the true one
    double magnet_force = 0.0;                // as well (unit: newtons)
    double ball = 0.0;    // taken for a ball of this radius (unit: meters); 0: its own shape
    bool absent = false;  // the model does not know it
    bool ghost = false;   // only the model has it
};

// Something happens while the hand touches.
struct TeleopEvent {
    enum class Kind : std::uint8_t {
        told,      // the body is described anew, as it is
        removed,   // the operator is told that there is no such body
        gravity,   // the operator is told the true gravity
        correct,   // states are believed from now on
        scheme,    // corrections are brought in by the scheme `amount`, see Correction
        scenario,  // 2 or 4, `amount`
        restart,   // the far side goes away, and comes back after `amount` seconds
        cut,       // nothing gets through any more: forth (1), back (2) or both ways (3), `amount`
    };
    double at = 0.0;  // (unit: seconds)
    Kind kind = Kind::told;
    std::string body;
    double amount = 0.0;
};

// A hinge between a body and the world, at a place on the body where the scene (not the model) has it.
struct TeleopHinge {
    std::size_t body = 0;  // of the scene
    Vec3 at{0.0};          // in the world (unit: meters)
    Vec3 axis{0.0, 1.0, 0.0};
};

// Something of the scene acts on a body's center of mass and no side is told of it: another hand, a wall, a
// spring, a draft.
struct TeleopActor {
    std::string body;
    // A spring to where the body began; with a normal it only pushes, against the normal, where the body is
    // beyond a plane.
    double stiffness = 0.0;  // (unit: newtons per meter)
    double damping = 0.0;    // while it pushes (unit: newton seconds per meter)
    Vec3 normal{0.0};        // of length 1; 0: a spring
    // Of the plane, along the normal from where the body began: it goes to `gap - way` and back in a period.
    double gap = 0.0, way = 0.0;  // (unit: meters)
    double period = 1.0;          // (unit: seconds)
    Vec3 draft{0.0};              // a force (unit: newtons)
    double from = 0.0, to = 1e9;  // all of it acts then (unit: seconds)
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
    double history = 1.024;  // that the model keeps of its past (unit: seconds)
    Nanoseconds phase = 0;   // of the far side's ticks after the operator's, 0 … period - 1
    bool robot = false;      // scenario 3: the scene is a real place, and an emulated robot is there
    // What its controller takes its mass and friction for, as factors.
    double robot_mass = 1.0, robot_friction = 1.0;
    Nanoseconds late = 0;             // the far side starts so much after the operator's, >= 0
    Vec3 path_shift{0.0};             // the hand's path lies so far off the scene's (unit: meters)
    double pose_noise = 0.0;          // standard deviation of what the far side says of places (unit: meters)
    bool correct_from_touch = false;  // the model is left wrong until either hand touches something
    // The model is what the far side has described over the link, made wrong: without it, it is there at
    // once.
    bool discovers = false;
    Vec3 gravity_believed{0.0, -9.81, 0.0};  // until it is told (unit: meters per second squared)
    std::vector<TeleopEvent> events;
    std::vector<TeleopActor> actors;  // of the scene, unknown to the model
    std::map<std::string, Vec3>
        hidden_hinges;  // unknown to the model, by body: about y, here in the world (unit: meters)
    double measured_from = 0.0, measured_to = 1e9;  // ticks that count as felt excess (unit: seconds)
    std::optional<double>
        known_after;     // the figures are those of a way that is right so long after the first
                         // mistake has shown, and is not felt to become so (unit: seconds)
    std::string object;  // the body whose place is compared; empty: none. box_position_error
                         // is that of the dynamic body that is off most
    std::string rows;    // CSV of every tick; empty: none
};

}  // namespace tactus::shared
