// How touch vibrates, tick by tick: what hands that cannot be pushed back are given instead, by a motor that
// shakes or by ear. All of it comes from the force that a hand with motors would be given.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

// One tick of a proxy.
struct TouchSample {
    Vec3 force{0.0};     // on the hand (unit: newtons)
    double depth = 0.0;  // from the proxy to the hand, 0 where nothing is touched (unit: meters)
};

// A touch that has just begun: a finger of mass m that meets a surface of stiffness k with speed v is pushed
// with v·√(k·m)·sin(√(k/m)·t) by it. What is hard is hit with a higher and stronger ring, as Okamura,
// Cutkosky and Dennerlein (2001) found of real materials.
struct Tap {
    double size = 0.0;       // of its first swing, undamped; 0: none (unit: newtons)
    double frequency = 0.0;  // (unit: hertz)
};
Tap tap_of(double speed, double stiffness);

// A ring that dies away: one step is a turn by its frequency and a shrinking.
struct Ring {
    double sine = 0.0, cosine = 0.0;

    // Adds a tap's swing, which begins at 0.
    void strike(const Tap& tap) { cosine += tap.size; }
    void advance(double frequency, double seconds);
};

class TouchVibration {
public:
    // What vibrates in this tick of `seconds`, along the force and positive outwards: the force without what
    // is slower than a hand can feel as vibration, and the ring of the last tap (unit: newtons).
    double next(const TouchSample& sample, double seconds);

    // The tap that has been heard of in this tick; of size 0 where there was none.
    const Tap& tap() const { return tap_; }

private:
    Tap begun(const TouchSample& sample, double seconds) const;

    TouchSample before_;
    int ticks_touched_ = 0;
    Vec3 fast_{0.0};  // of the force
    Vec3 slow_{0.0};
    Ring ring_;
    double ring_frequency_ = 0.0;
    Tap tap_;
};

// How strongly to run the two motors of a gamepad, 0 to 1 each: the heavy one for what is slow, the light one
// for what is fast.
struct MotorLevels {
    double heavy = 0.0;
    double light = 0.0;
};

struct MotorSettings {
    double full_force = 2.0;  // a vibration of that size is a full one (unit: newtons)
    // The heavy motor's share for a steady force of that size: not vibration, but how firmly one presses.
    double steady_share = 0.25;
};

// Root mean squares from one frame of a picture to the next.
class MotorMeter {
public:
    void add(double vibration, const Vec3& force, double seconds);
    // Since the last call.
    MotorLevels take(const MotorSettings& settings);

private:
    double low_ = 0.0;  // the slow part of the vibration (unit: newtons)
    double low_squares_ = 0.0, high_squares_ = 0.0, force_sum_ = 0.0;
    int count_ = 0;
};

}  // namespace tactus
