// What is called an error of teleoperation, said once and used everywhere.
//
//   force_error           |F on the hand - F that direct, undelayed touch of the true environment gives for
//                         the same hand at the same time| (the intent of thesis eq. 5.1)
//   force_error_shifted   |F on the hand - F at the far side's hand, moved by the delay| (what the thesis
//                         plots for traditional touch)
//   box_position_error    |place of the object in the model - its place in the environment| after the same
//                         sample of the operator
//   correction_force_step |F just after a correction - F just before it|, same hand, same tick
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "core/teleop/body_motion.hpp"

namespace tactus {

// (unit: newtons)
inline double force_error(const Vec3& on_hand, const Vec3& of_direct_touch) {
    return glm::length(on_hand - of_direct_touch);
}

// (unit: newtons). `far_force`: that of the far side one delay ago.
inline double force_error_shifted(const Vec3& on_hand, const Vec3& far_force) {
    return glm::length(on_hand - far_force);
}

// (unit: meters)
inline double position_error(const Pose& in_model, const Pose& in_environment) {
    return glm::length(in_model.position - in_environment.position);
}

// (unit: radians)
inline double rotation_error(const Pose& in_model, const Pose& in_environment) {
    return angle_between(in_model.rotation, in_environment.rotation);
}

// What one tick's correction cost.
struct CorrectionCost {
    double moved = 0.0;       // farthest that an object was put elsewhere (unit: meters)
    double force_step = 0.0;  // correction_force_step (unit: newtons)
    double faded = 0.0;       // change of the felt force by fading (unit: newtons)
    double jnd_share = 0.0;   // force_step + faded over the just-noticeable change (dimensionless)
};

// Sum, mean, root mean square and largest of a series, one value at a time.
struct Series {
    std::uint64_t count = 0;
    double sum = 0.0;
    double sum_of_squares = 0.0;
    double largest = 0.0;

    void add(double value) {
        ++count;
        sum += value;
        sum_of_squares += value * value;
        largest = value > largest ? value : largest;
    }
    double mean() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
    double rms() const { return count > 0 ? std::sqrt(sum_of_squares / static_cast<double>(count)) : 0.0; }
};

}  // namespace tactus
