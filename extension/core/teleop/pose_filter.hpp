// Places that the far side sees only roughly, as a camera does, made steady.
//
// From one state to the next a body goes a way that its velocities and the model tell well (PoseStep). What
// is seen besides, e_k, is chance n_k and what the way leaves open, q_k, whose mean square is known:
//
//     e_k = n_k - n_(k-1) + q_k        mean of |e_k|^2 = 2 R + Q        mean of e_k . e_(k-1) = -R
//
// R follows from both, the smaller of the two: one jump of a body makes the first large and leaves the second
// as it is, a way that is told badly and ever anew makes the second zero. All bodies are seen by the same
// eyes: what the others have taught counts for a few states of a body's own. Where R is no more than an
// honest far side and rounding make, all is believed, to the last bit.
//
// Else there are two beliefs, both carried along each way and drawn towards what is seen by Kalman's gain
// (with the variance in units of R, the gain after one state is the variance before the next):
//     trusting    the model was right at the start: of variance zero there
//     seeing      nothing was known at the start
// The first holds until what is seen contradicts it: a correction that chance explains is not made. At rest
// no way leaves anything open: both gains fall like 1 / k, and the body is estimated at rest. Where a belief
// and the model differ by less than the belief is sure of, the model keeps its place to the bit: a body that
// stands would else be put some micrometers above its ground, and slide without friction until it has fallen.
//
// A pose that the body's joint does not allow tells of n_k with the first state. A still body then waits with
// its model until R is known.
#pragma once

#include "core/math/pose.hpp"

namespace tactus {

struct PoseFilterSettings {
    double place = 5e-5;        // a deviation below this is none (unit: meters), > 0
    double turn = 5e-4;         // (unit: radians), > 0
    double states = 200;        // over which R is averaged, >= 2
    double contradicted = 5.0;  // deviations that chance does not explain, > 0
    double unsaid = 2.0;  // deviations of what is believed within which the model is left as it is, >= 0
};

// How a body came from the last state to this one.
struct PoseStep {
    Vec3 way{0.0};                  // (unit: meters)
    Quat turn{1.0, 0.0, 0.0, 0.0};  // about its own origin, in the parent's frame
    double open_way = 0.0;          // root mean square of what the way leaves open (unit: meters), >= 0
    double open_turn = 0.0;         // (unit: radians), >= 0
};

// What e_k were, on average.
struct Chance {
    double count = 0.0;    // of e_k
    double squares = 0.0;  // mean of |e_k|^2
    double lagged = 0.0;   // mean of e_k . e_(k-1)
    double open = 0.0;     // Q

    void note(const Vec3& e, const Vec3& before, bool before_known, double left_open, double states);
    // R, of one axis, and what it is at most after so few states.
    double variance() const;
    double variance_at_most() const;
};

// `own` and what others have taught.
Chance together(const Chance& own, const Chance& others);

// A vector that is seen roughly.
class RoughVector {
public:
    // The two beliefs, off the newest that was seen.
    struct Off {
        Vec3 trusting{0.0}, seeing{0.0};
    };

    // What is to be believed of the first that is seen, off it.
    // `still`: see see().
    Vec3 begin(const PoseFilterSettings& settings, double none, const Off& off, bool still,
               const Chance& others);

    // `e`: how far off the place to which the step has led the last one; `open`: root mean square of what the
    // step leaves open. What is to be believed, off the newest. A body that is `still` keeps the model's pose
    // where there is chance and its amount is not known yet.
    Vec3 see(const PoseFilterSettings& settings, double none, const Vec3& e, const Off& off, double open,
             bool still, Chance& others);

    Off off() const { return {trusting_.off, seeing_.off}; }

    // Mean square of how far off what is believed may be; 0 where all is believed.
    double doubt(double none, const Chance& others) const;

private:
    struct Belief {
        Vec3 off{0.0};
        double gain = 0.0;
    };

    void note(const PoseFilterSettings& settings, const Vec3& e, double open, Chance& others);
    Vec3 believed(const PoseFilterSettings& settings, const Chance& chance, bool still);

    Belief trusting_, seeing_{Vec3(0.0), 1.0};
    Chance chance_;
    Vec3 before_{0.0};   // e_(k-1)
    Vec3 leaning_{0.0};  // mean of what is seen off `trusting`, lately
    int jumps_ = 0;      // in succession
};

// What all bodies have taught about the far side's eyes.
struct FarEyes {
    Chance place, turn;

    // A pose is `seen` that no honest far side has, and `allowed` is the nearest one that it may have. The
    // difference is an n_k by itself, of the directions that are not allowed: it counts as e_k of 2 R, until
    // enough states have told.
    void note_forbidden(const PoseFilterSettings& settings, const Pose& seen, const Pose& allowed);
};

class PoseFilter {
public:
    // `model`: where the model has it at the same sample.
    Pose filter(const PoseFilterSettings& settings, const Pose& seen, const Pose& model, const PoseStep& step,
                FarEyes& eyes);

    // What was believed last, or `model` where the two differ by no more than the doubt about it.
    Pose unless_said(const PoseFilterSettings& settings, const Pose& believed, const Pose& model,
                     const FarEyes& eyes) const;

    void forget() { *this = {}; }

private:
    bool known_ = false;
    Pose seen_, trusting_, seeing_;
    RoughVector place_, turn_;
};

}  // namespace tactus
