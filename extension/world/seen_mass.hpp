// The mass of a body that an engine moves, from what pushes change of its velocity: another body may hang on
// it that only the engine knows.
//
// A push of impulse p changes the velocity by p / m, and other forces by something besides. So 1 / m is the
// slope of the line through the last frames' changes over their impulses (least squares that forget), where
// they are on a line. The last frame before a push tells what other forces do, so that one pushed frame is
// enough: a body that bounces off a finger touches it for a few frames in all.
//
// What pushes do not move at all is held, by friction or a wall that only the engine knows, and not heavy.
//
// Plain values.
#pragma once

#include <optional>

#include "core/math/types.hpp"

namespace tactus {

class SeenMass {
public:
    // What hangs on a body only makes it heavier than the engine says. Scattered pushes once told factors
    // of 0.5 and 10, and a pinched box was thrown away (dimensionless).
    static constexpr double least_factor = 1.0;
    static constexpr double most_factor = 4.0;

    // Of a frame. `change`: of the engine's velocity (unit: meters per second). `told`: the mass that the
    // body is said to have (unit: kilograms), > 0.
    void note(const Vec3& impulse, const Vec3& change, double told);

    // How often the told mass it is: 1 until it is pushed unevenly. Moves in steps that a hand notices.
    double factor() const { return factor_; }

private:
    void add(const Vec3& impulse, const Vec3& change);

    std::optional<Vec3> rest_;  // change of the last frame, if there was no push in it
    double count_ = 0.0;
    Vec3 impulse_{0.0}, change_{0.0};                              // means
    double of_impulses_ = 0.0, of_both_ = 0.0, of_changes_ = 0.0;  // sums of squares and products about them
    double factor_ = 1.0;
};

}  // namespace tactus
