// What may still move between two joined bodies, as plain values.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "core/math/pose.hpp"

namespace tactus {

// From where the frames of both bodies are the same. lower == upper: held there; lower > upper: free.
struct JointRange {
    double lower = 0.0;
    double upper = 0.0;

    static constexpr JointRange locked() { return {0.0, 0.0}; }
    static constexpr JointRange free() { return {1.0, -1.0}; }
    constexpr bool is_locked() const { return lower == 0.0 && upper == 0.0; }
    constexpr bool is_free() const { return lower > upper; }
};

enum class JointKind {
    Pin,      // free to turn about the frame's origin
    Hinge,    // turns about the frame's z axis within angular[2]
    Slider,   // slides along the frame's x axis within linear[0]
    SixAxes,  // linear and angular, each axis on its own
};

// What leads the one free axis of a hinge (radians, newton meters) or a slider (meters, newtons): a spring to
// `rest`, or to the nearest of rest + n pitch, and a damper.
struct JointDrive {
    double stiffness = 0.0;  // of the spring, >= 0; 0: there is none
    double damping = 0.0;    // >= 0
    double rest = 0.0;       // as ranges count
    double pitch = 0.0;      // from one detent to the next; 0: there is one place of rest
    double strength = 0.0;   // that spring and damper have together at most; 0: without a limit
    double reach = 0.0;      // the spring acts no farther from its place, as a latch; 0: everywhere

    bool operator==(const JointDrive&) const = default;
};

struct JointDescription {
    JointKind kind = JointKind::Pin;
    Pose frame;  // in the world, where the bodies are now
    // The same of the second body, where it is not where `frame` is now: what has moved since the two were
    // joined, elsewhere.
    std::optional<Pose> second_frame{};

    // Of the second body against the first, in the frame.
    std::array<JointRange, 3> linear{};   // (unit: meters)
    std::array<JointRange, 3> angular{};  // (unit: radians), within -pi..pi; right-handed

    // Keeps a hinge turning: towards motor_speed (unit: radians per second), with no more than motor_torque
    // (unit: newton meters). No torque, no motor.
    double motor_speed = 0.0;
    double motor_torque = 0.0;

    bool bodies_collide = false;  // with each other
    JointDrive drive{};           // of a hinge without a motor, or a slider
};

// Names a joint of one world for as long as it is in it.
struct JointId {
    std::uint32_t value = 0xffffffffu;

    bool valid() const { return value != 0xffffffffu; }
    friend bool operator==(JointId, JointId) = default;
};

// Nearest to `relative` that the joint allows: the pose of the second body's frame in the first body's. Each
// locked axis is at its zero. Limits of rotation count where one axis rotates.
Pose nearest_allowed(const JointDescription& joint, const Pose& relative);
// The same for the pose of one of the bodies. The joint's frames are in those of the bodies, both of them
// known.
Pose first_allowed(const JointDescription& joint, const Pose& first, const Pose& second);
Pose second_allowed(const JointDescription& joint, const Pose& first, const Pose& second);

// What is wrong with it and what to do; empty when nothing is.
std::string wrong_in(const JointDescription& joint);

}  // namespace tactus
