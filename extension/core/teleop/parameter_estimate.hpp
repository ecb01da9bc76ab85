// What the model gets wrong about a body's mass and friction, learnt from how the far side's body came to
// move otherwise from the same state under the same hand.
//
// Between two states of the far side, T apart, the model's body began as the first says and was pushed by the
// hand's impulse P and by its contacts' C: m dv' = P + C + m g T. Along the motion's direction d, with
// h = P.d / (m T) and c = C.d / (m T), a body whose inverse mass is e^p and whose friction e^q times the
// model's would have gained
//
//     (dv - dv').d / T = h p + c q
//
// more, to first order: a contact's share of the acceleration is friction times gravity, whatever the mass.
// p and q follow from many such lines by recursive least squares. Both factors stay positive: whatever is
// learnt, contacts only take energy away.
//
// What else acts on the body looks like another friction. So a line that no factors within their bounds
// explain is left out, and so is what a body does that no hand of ours has pushed since it last stood still.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

struct EstimateSettings {
    double gain = 1.0;            // 0: nothing is learnt, 0 … 1
    double slow = 0.02;           // slower bodies teach nothing (unit: meters per second), > 0
    double uncertainty = 0.5;     // of both at the start, standard deviation of p and q (dimensionless), > 0
    double wander = 0.02;         // which they gain in a second of learning, >= 0
    double doubt = 0.2;           // of a line, standard deviation (unit: meters per second squared), > 0
    double relative_doubt = 0.1;  // and this share of what hand and contacts do (dimensionless), >= 0
    double largest = 4.0;         // no factor beyond this, or below its inverse, > 1
};

// What has become of the velocities of both within `seconds` (unit: meters per second).
struct MotionLesson {
    Vec3 truth_before{0.0};  // of the far side's body then
    Vec3 truth{0.0};         // now
    Vec3 model_before{0.0};  // of the model's then: nearly the same
    Vec3 model{0.0};         // now
    Vec3 pushed{0.0};        // velocity that the hand gave the model's in between
    Vec3 fell{0.0};          // velocity that gravity gave it
    double seconds = 0.0;    // > 0
};

class ParameterEstimate {
public:
    explicit ParameterEstimate(const EstimateSettings& settings = {}) { forget(settings); }

    void forget(const EstimateSettings& settings);
    // `share`: of the mass that the lesson is about, 0 … 1. The others are taken to be as wrong as this body,
    // so p and q follow all that is missing. Yet they are as certain as the share alone makes them.
    void learn(const EstimateSettings& settings, const MotionLesson& lesson, double share = 1.0);

    // Who has measured the mass knows it better: its factor and how sure that is (standard deviation, share
    // of it).
    void take_over_mass(const EstimateSettings& settings, double factor, double deviation);

    double mass_factor() const;
    double friction_factor() const;
    bool is_none() const { return p_ == 0.0 && q_ == 0.0; }

private:
    double p_ = 0.0, q_ = 0.0;               // logarithms of the inverse mass's and the friction's factor
    double pp_ = 0.0, pq_ = 0.0, qq_ = 0.0;  // their covariance
    bool moved_by_hand_ = false;             // since it stood still
};

}  // namespace tactus
