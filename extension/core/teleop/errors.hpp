// What is called an error of teleoperation, said once and used everywhere.
//
//   force_error           |F on the hand - F that direct, undelayed touch of the true environment gives for
//                         the same hand at the same time| (the intent of thesis eq. 5.1)
//   force_error_shifted   |F on the hand - F at the far side's hand, moved by the delay| (what the thesis
//                         plots for traditional touch)
//   box_position_error    |place of the object in the model - its place in the environment| after the same
//                         sample of the operator
//   felt_excess           how much more the felt force has changed within a window than that of direct touch
//   energy_created        the most that a port has given on balance at any moment of a contact
//   correction_force_step |F just after a correction - F just before it|, same hand, same tick
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "core/math/body_motion.hpp"
#include "core/teleop/stealth.hpp"

namespace tactus {

// (unit: newtons)
inline double force_error(const Vec3& on_hand, const Vec3& of_direct_touch) {
    return glm::length(on_hand - of_direct_touch);
}

// (unit: newtons). `far_force`: that of the far side one delay ago.
inline double force_error_shifted(const Vec3& on_hand, const Vec3& far_force) {
    return glm::length(on_hand - far_force);
}

// Direct touch: the same hand, at the same places and times, on the true scene without a delay; its force is
// D, the felt one F. What a hand may take for an event is a change that touch does not explain. With the
// error E = F - D, a window of w seconds asks how the hand would have felt at t had nothing but direct touch
// gone on since t - w:
//     G(t) = F(t - w) + (D(t) - D(t - w))            expected
//     F(t) - G(t) = E(t) - E(t - w)                  felt_excess, a vector (unit: newtons)
// A constant error has none, however large; a right model has none whatever it is pushed into; a step that
// is hidden now and let out later has all of it later. The hand compares F with G, so Weber's law is taken at
// the expected one: |F - G| / just_noticeable(|G|), in just-noticeable differences. 1 ms shows steps, 100 ms
// what comes too slowly for a step and too fast to escape notice (StealthSettings::window).
struct FeltExcess {
    double newtons = 0.0;
    double jnd = 0.0;  // in just-noticeable differences
};

// `before`: one window ago (unit: newtons).
inline FeltExcess felt_excess(const Vec3& felt, const Vec3& direct, const Vec3& felt_before,
                              const Vec3& direct_before, const StealthSettings& settings = {}) {
    const Vec3 expected = felt_before + (direct - direct_before);
    const double newtons = glm::length(felt - expected);
    return {newtons, newtons / just_noticeable(settings, glm::length(expected))};
}

// The energy that a port gives, and the most it has given in one contact: from the first tick with a force
// to the last one. Whatever is passive and begins at rest can never have given anything on balance:
// `created` is 0 for it. `force` is held while the hand goes `way`, so force * way is exact.
class PortEnergy {
public:
    // (units: newtons, meters)
    void add(const Vec3& force, const Vec3& way) {
        const double given = glm::dot(force, way);
        total_ += given;
        contact_ = force == Vec3(0.0) ? 0.0 : contact_ + given;
        created_ = contact_ > created_ ? contact_ : created_;
    }
    double total() const { return total_; }      // given so far; below 0: taken (unit: joules)
    double created() const { return created_; }  // (unit: joules), >= 0

private:
    double total_ = 0.0, contact_ = 0.0, created_ = 0.0;
};

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

    CorrectionCost& operator+=(const CorrectionCost& other) {
        moved += other.moved;
        force_step += other.force_step;
        faded += other.faded;
        jnd_share += other.jnd_share;
        return *this;
    }
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
