// How stiff, how rough and how heavy what is touched is: learnt where it is touched, from the tip's motion
// and the force f of the tip, each with its uncertainty.
//
// What is touched gives way like a spring: the tip at x holds the point of the surface that was touched at
//
//     p = x - f / k
//
//     stiffness   f_n = k d + b d' + c    d: how deep the tip has gone along the touch's normal, from where
//                                         the touch began; c: what the place of the surface was wrong by
//     friction    |f_t| = mu f_n          while p slides over the surface; while it sticks, mu is only known
//                                         to be more
//     mass        p'' = f_d / m + c       along the way d of a body that is pushed; c: what its support
//                                         resists, which does not change as long as it slides
//
// Eyes tell late that a body moves: what is felt of its surface is learnt from when they have seen it at rest
// for a while since. Of its mass they are not asked: p is where it is pushed, told a thousand times a second.
// No rough thing is derived: with a weight w that ends smoothly at both ends of a stretch of time T,
//
//     integral of w'' p  =  1 / m  integral of w f_d  +  c      w = 30 s^2 (1 - s)^2 / T,  s = t / T
#pragma once

#include <array>
#include <cstddef>

#include "core/estimation/recursive_least_squares.hpp"
#include "core/estimation/touch_value.hpp"
#include "core/math/types.hpp"

namespace tactus {

struct TouchEstimateSettings {
    double force_deviation = 0.12;  // of a force (unit: newtons), > 0
    double place_deviation = 5e-5;  // of a place of the tip (unit: meters), > 0
    double alike = 0.015;           // samples nearer in time than this err alike (unit: seconds), > 0
    double lag = 0.005;             // of forces behind places, to first order (unit: seconds), > 0
    double smoothing = 0.02;        // of what slides (unit: seconds), > 0
    double least_force = 0.2;       // a lighter touch teaches nothing (unit: newtons), > 0
    double slack = 2e-4;  // p has slid when it is farther from where it was than this, and than chance may
                          // make of its force (unit: meters)
    double slides_from = 0.02;   // of p: slower, a surface may creep (unit: meters per second), > 0
    double moves_from = 0.01;    // of a body (unit: meters per second), > 0
    double turns_from = 0.3;     // of a body whose mass is not learnt (unit: radians per second), > 0
    double stretch = 0.2;        // T (unit: seconds), > 0
    double max_stiffness = 2e4;  // (unit: newtons per meter)
    double max_friction = 3.0;   // (dimensionless)
    double max_mass = 50.0;      // (unit: kilograms)
};

// A tick of touch, at the far side; all in the world.
struct TipSample {
    double seconds = 1e-3;       // since the last one, > 0
    Vec3 normal{0.0, 1.0, 0.0};  // out of the surface, unit
    Vec3 tip{0.0};               // (unit: meters)
    Vec3 force{0.0};             // of the tip on what is touched (unit: newtons)
    // Of what is touched, as it is seen.
    Vec3 body{0.0};           // where it is (unit: meters)
    Vec3 body_velocity{0.0};  // exactly zero at rest (unit: meters per second)
    Vec3 body_turning{0.0};   // likewise (unit: radians per second)
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
    // Ticks that eyes are late by, at most.
    static constexpr std::size_t late = 128;

    // What a tick tells of the surface.
    struct Felt {
        double deep = 0.0, sinking = 0.0;  // d, d'
        double pressing = 0.0;             // f_n
        bool slides = false;               // p, smoothed; and then, likewise:
        double dragging = 0.0;             // f_t, along the way that p slides
        double pressed = 0.0;              // f_n
    };
    // A stretch of time in which a body is pushed.
    struct Push {
        double seconds = -1.0;  // since it began; below 0: it has not
        Vec3 way{0.0};          // d, unit
        Vec3 from{0.0};         // p
        double places = 0.0;    // integral of w'' p
        double forces = 0.0;    // integral of w f_d
        double gone = 0.0;      // along d
        int part = 0;           // of `parts`, the one that is on
    };
    static constexpr int parts = 4;

    double spring() const;
    void feel_surface(const TipSample& sample, double pressing);
    void follow_tip(const TipSample& sample);
    double slack() const;
    double slide(const Vec3& place, const Vec3& normal);
    void learn(const Felt& felt, double tick);
    void feel_mass(const TipSample& sample, double pressing);
    void follow(Push& push, const TipSample& sample, double pressing);
    void end(const Push& push);

    TouchEstimateSettings settings_;
    RecursiveLeastSquares<3> stiffness_;  // k, b, c
    RecursiveLeastSquares<1> friction_;
    RecursiveLeastSquares<2> mass_;  // 1 / m, c
    bool touching_ = false;          // and the body rests
    Vec3 began_{0.0};                // tip from the body where the touch began
    double deep_ = 0.0;              // d, a tick ago
    bool has_tip_ = false;
    Vec3 late_tip_{0.0};           // as late as the force, in the world
    Vec3 tip_{0.0}, force_{0.0};   // smoothed; the tip from the body
    Vec3 held_{0.0};               // p is no farther than the slack from here, from the body
    Vec3 way_{0.0};                // that it slid last, unit, smoothed
    double slid_ = 0.0;            // that way since it turned back (unit: meters)
    std::array<Felt, late> felt_;  // of the last ticks
    std::size_t felt_count_ = 0;
    double pushed_ = 0.0;         // f_n, smoothed
    std::array<Push, 2> pushes_;  // half a stretch apart
};

}  // namespace tactus
