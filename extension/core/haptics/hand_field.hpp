// A force on the hand that is computed elsewhere, a few dozen times a second, and felt at every tick.
//
// Each time it is told as it is about one place and one velocity: the force there, along a line through there
// (core/haptics/field_line.hpp), and how it changes with place and velocity. In between the hand feels
//
//     G(s) + A (x - x0 - s d) + B (v - v0),    s = d (x - x0),
//
// wherever it has gone to by now, and from one time to the next the one goes over into the other. So a spring
// and a thick fluid answer within a tick, and not a frame late, which would let them swing; and a force that
// leaps is felt where it does. Of a computation that has fallen silent nothing is felt soon.
//
// What is felt between two moments is a guess, which may give the hand more than the force itself would. What
// was given is the force that was held, times the way that it acted on; what was due is the work of the force
// itself on that way,
//
//     W = integral of F along the line, of the moments at both ends in the mean.
//
// What was given beyond that is taken back by a damper (a passivity observer and controller, Hannaford and
// Ryu 2002). It also brakes a hand that gets farther than a rough force was looked at closely.
#pragma once

#include <limits>
#include <optional>

#include "core/haptics/field_line.hpp"
#include "core/haptics/surface_effects.hpp"
#include "core/math/types.hpp"
#include "core/safety/stiffness_limit.hpp"

namespace tactus {

struct FieldMoment {
    Vec3 place{0.0};        // x0, in the world (unit: meters)
    Vec3 velocity{0.0};     // v0, in the world (unit: meters per second)
    Vec3 force{0.0};        // F, of both (unit: newtons)
    Mat3 by_place{0.0};     // A (unit: newtons per meter)
    Mat3 by_velocity{0.0};  // B (unit: newton seconds per meter)
    FieldLine line{};       // of F through x0; where there is none A serves in all directions
};

class HandField {
public:
    // No field is felt steeper, whatever the device bears: a hand is held by little damping of its own (unit:
    // newtons per meter).
    static constexpr double stiffest = 2000.0;

    // No farther from its place and its velocity is it believed how the force changes (units: meters, meters
    // per second).
    static constexpr double reach = 0.02;
    static constexpr double speed_reach = 0.5;
    // The damper that takes back what was given too much is no thicker (unit: newton seconds per meter), and
    // does so within this (unit: seconds). What is less than `tolerated` is left to the hand, and no more of
    // what was given too little is kept for later (unit: joules).
    static constexpr double thickest = 30.0;
    static constexpr double taken_back_within = 0.003;
    static constexpr double tolerated = 5e-4;
    // Silent for so long it begins to fade, and is gone after as long again.
    static constexpr Nanoseconds lives = 100'000'000;

    // From the next tick on.
    void set(const FieldMoment& moment) { next_ = moment, is_new_ = true; }

    // A tick begins, at a time that does not fall: what stiffness and damping it has at most. Nothing where
    // nothing is felt of it. `strongest`: of the forces that the hand can be given (unit: newtons).
    Wall begin_tick(Nanoseconds now, double strongest = std::numeric_limits<double>::infinity());

    // On that hand in this tick (unit: newtons). It is made as weak as `safe`. `most_damping`: of its damper
    // (unit: newton seconds per meter).
    Vec3 force(const HandMotion& hand, const Wall& safe, double most_damping = thickest);

    // It is steeper, or damps more, than is safe, or has given too much, and was made weaker in this tick.
    bool is_limited() const { return is_limited_; }

private:
    // As fast as a screen can be, and as slow.
    static constexpr Nanoseconds shortest_over = 2'000'000;
    static constexpr Nanoseconds longest_over = 50'000'000;

    struct Model {
        Vec3 place{0.0}, velocity{0.0};  // x0, v0
        Mat3 across{0.0};                // A, of what is not along the line
        Mat3 by_velocity{0.0};           // B
        Vec3 moving{0.0};                // what of the force comes from v0 (unit: newtons)
        FieldProfile line;               // F and G
    };

    static Model model_of(const FieldMoment& told);
    void take(Nanoseconds now, double strongest);
    Model felt_now(const Model& next) const;
    void weigh(Nanoseconds now);
    void account(const Model& next);
    void observe(const Vec3& place);
    double unknown(const Vec3& place) const;
    Vec3 damper(const HandMotion& hand, double most_damping);
    double work(const Model& model, const Vec3& from, const Vec3& to) const;
    Vec3 felt(const HandMotion& hand) const;
    Vec3 felt(const Model& model, const HandMotion& hand) const;

    Model before_, last_;
    FieldMoment next_;
    bool is_new_ = false;    // next_
    Nanoseconds since_ = 0;  // last_ goes over from before_ since then,
    Nanoseconds over_ = 0;   // within this; 0: there has never been one
    Nanoseconds began_ = 0;  // the first moment after a silence
    bool is_whole_ = false;  // it has grown from nothing

    // In this tick: the weights of both, which add up to what is left of it.
    double of_before_ = 0.0, of_last_ = 0.0;
    Wall steepest_;
    double safe_stiffness_ = stiffest;

    // Work (unit: joules): what was given beyond W, which reaches to where last_ was told, and what of that
    // the damper has to take.
    double balance_ = 0.0, excess_ = 0.0;
    double damping_ = 0.0;  // of the damper (unit: newton seconds per meter)
    // Where the hand was in the last tick (unit: meters), and what it was given there (unit: newtons).
    std::optional<Vec3> hand_;
    Vec3 given_{0.0};

    double across_share_ = 1.0, damped_share_ = 1.0;  // what is safe of A and B
    bool is_limited_ = false;
};

}  // namespace tactus
