// A force on the hand that is computed elsewhere, a few dozen times a second, and felt at every tick.
//
// Each time it is told as it is about one place and one velocity: the force there, and how it changes with
// either. In between the hand feels
//
//     F + A (x - x0) + B (v - v0),
//
// wherever it has gone to by now, and from one time to the next the one goes over into the other. So a spring
// and a thick fluid answer within a tick, and not a frame late, which would let them swing. Of a computation
// that has fallen silent nothing is felt soon.
//
// A force that leaps at some place would come a frame late on the way in and on the way out, and give back
// more than it took. What two times tell of either side of such a border is therefore felt by place, and not
// by time: between both places the force goes over from the one to the other, as steeply as is safe. Of a
// spring that is steeper than is safe, the part that is left out stays left out.
//
// What is felt between two moments is a guess, which may give the hand more than the force itself would: its
// work along the way is known only afterwards,
//
//     W = sum of (F_i + F_i+1) / 2 (x_i+1 - x_i).
//
// What was given beyond that is taken back by a damper (a passivity observer and controller, Hannaford and
// Ryu 2002).
#pragma once

#include <optional>

#include "core/haptics/surface_effects.hpp"
#include "core/math/types.hpp"
#include "core/safety/stiffness_limit.hpp"

namespace tactus {

struct FieldMoment {
    Vec3 place{0.0};        // x0, in the world (unit: meters)
    Vec3 velocity{0.0};     // v0, likewise (unit: meters per second)
    Vec3 force{0.0};        // F, of both (unit: newtons)
    Mat3 by_place{0.0};     // A (unit: newtons per meter)
    Mat3 by_velocity{0.0};  // B (unit: newton seconds per meter)
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
    // nothing is felt of it.
    Wall begin_tick(Nanoseconds now);

    // On that hand in this tick (unit: newtons). It is made as weak as `safe`. `most_damping`: of its damper
    // (unit: newton seconds per meter).
    Vec3 force(const HandMotion& hand, const Wall& safe, double most_damping = thickest);

    // It is steeper, or damps more, than is safe, or has given too much, and was made weaker in this tick.
    bool is_limited() const { return is_limited_; }

private:
    // As fast as a screen can be, and as slow.
    static constexpr Nanoseconds shortest_over = 2'000'000;
    static constexpr Nanoseconds longest_over = 50'000'000;

    // Forces at rest on both sides of a place where they leap (unit: newtons): from `below` to `above`, along
    // the normal, between two places on it (unit: meters).
    struct Border {
        Vec3 normal{0.0}, below{0.0}, above{0.0};
        double from = 0.0, to = 0.0;
    };
    struct Model {
        FieldMoment moment;  // the newest; its force is what is felt there
        std::optional<Border> border;
    };

    void take(Nanoseconds now);
    void weigh(Nanoseconds now);
    void account();
    void observe(const Vec3& place);
    Vec3 damper(const Vec3& velocity, double most_damping);
    Vec3 felt(const HandMotion& hand) const;
    Vec3 felt(const Model& model, const HandMotion& hand) const;
    Mat3 slope(const Model& model, const Vec3& place) const;
    double width(const Border& border) const;
    Model fitted(const FieldMoment& told) const;
    static std::optional<Border> goes_on(Border border, const FieldMoment& told);

    FieldMoment told_;  // last, as it came
    Model before_, last_;
    FieldMoment next_;
    bool is_new_ = false;    // next_
    Nanoseconds since_ = 0;  // last_ goes over from before_ since then,
    Nanoseconds over_ = 0;   // within this; 0: there has never been one
    Nanoseconds began_ = 0;  // the first moment after a silence

    // In this tick: the weights of both, which add up to what is left of it,
    double of_before_ = 0.0, of_last_ = 0.0;
    Wall steepest_;
    double safe_stiffness_ = stiffest;

    // Work (unit: joules): what was given beyond W, which reaches to told_, and what of that the damper has
    // to take.
    double balance_ = 0.0, excess_ = 0.0;
    double damping_ = 0.0;  // of the damper (unit: newton seconds per meter)
    // Where the hand was in the last tick (unit: meters), and what it was given there by place and by the
    // damper (unit: newtons).
    std::optional<Vec3> hand_;
    Vec3 given_{0.0}, damped_{0.0};

    double stiff_share_ = 1.0, damped_share_ = 1.0;  // and what is safe of A and B
    bool is_limited_ = false;
};

}  // namespace tactus
