// How stiff, how rough and how heavy what is touched is: learnt where it is touched, from the tip's motion
// and the force on it, each with its uncertainty.
//
//     stiffness   f = k x + b v + c    x: how deep the tip has gone along the touch's normal, from where the
//                                      touch began; c: what the place of the surface was wrong by
//     friction    |f_t| = mu f_n       while the tip slides; while it sticks, mu is only known to be more
//     mass        a = f_d / m + c      along the way d of a body that is pushed; c: what its support resists,
//                                      which does not change as long as it slides. Forces are told well,
//                                      accelerations roughly: what is rough must stand alone
//
// Force and motion are the far side's own, sampled together every tick. A body's acceleration is the change
// of its velocity over a stretch of time, and its force the mean over the same stretch: velocities that come
// seldom or rough give a line with its own deviation, no peak.
#pragma once

#include "core/estimation/recursive_least_squares.hpp"
#include "core/estimation/touch_value.hpp"
#include "core/math/types.hpp"

namespace tactus {

struct TouchEstimateSettings {
    double force_deviation = 0.03;  // of a force (unit: newtons), > 0
    double place_deviation = 3e-5;  // of a place of the tip (unit: meters), > 0
    double speed_deviation = 0.01;  // of a body's velocity (unit: meters per second), > 0
    double least_force = 0.2;       // a lighter touch teaches nothing (unit: newtons), > 0
    double slides_from = 0.005;     // of the tip along the surface (unit: meters per second), > 0
    double moves_from = 0.01;       // of a body (unit: meters per second), > 0
    double stretch = 0.05;          // over which an acceleration is taken (unit: seconds), > 0
    double max_stiffness = 2e4;     // (unit: newtons per meter)
    double max_friction = 3.0;      // (dimensionless)
    double max_mass = 50.0;         // (unit: kilograms)
};

// A tick of touch, at the far side. Forces are those on what is touched.
struct TipSample {
    double seconds = 1e-3;       // since the last one, > 0
    Vec3 normal{0.0, 1.0, 0.0};  // out of the surface, unit
    Vec3 tip{0.0};               // in the frame of what is touched, with the world's axes (unit: meters)
    Vec3 tip_velocity{0.0};      // against it (unit: meters per second)
    Vec3 force{0.0};             // of the tip (unit: newtons)
    Vec3 body_velocity{0.0};     // of what is touched (unit: meters per second)
};

class TouchEstimate {
public:
    explicit TouchEstimate(const TouchEstimateSettings& settings = {});

    // One tick with touch.
    void feel(const TipSample& sample);
    // A tick without.
    void let_go();

    TouchValue stiffness() const;  // (unit: newtons per meter)
    TouchValue friction() const;   // (dimensionless)
    TouchValue mass() const;       // (unit: kilograms)

private:
    struct Stretch {
        double seconds = 0.0;
        Vec3 force{0.0};     // integrated (unit: newton seconds)
        Vec3 velocity{0.0};  // of the body when it began
        bool moves = true;   // all the time
    };

    void feel_stiffness(const TipSample& sample, double pressing);
    void feel_friction(const TipSample& sample, double pressing);
    void feel_mass(const TipSample& sample);
    void end_stretch(const Vec3& velocity);

    TouchEstimateSettings settings_;
    RecursiveLeastSquares<3> stiffness_;  // k, b, c
    RecursiveLeastSquares<1> friction_;
    RecursiveLeastSquares<2> mass_;  // 1 / m, c
    bool touching_ = false;
    Vec3 began_{0.0};  // tip where the touch began
    Stretch stretch_;
};

}  // namespace tactus
