// A hand that feels: an arm with mass, damping and muscle stiffness that means to follow a path and is pushed
// back by the force it gets. It closes the loop that a scripted path leaves open (thesis 5.3, inference 5).
#pragma once

#include "core/ports/device.hpp"
#include "devices/hand_path.hpp"
#include "devices/path_clock.hpp"
#include "realtime/triple_buffer.hpp"

namespace tactus {

// m x'' = k (p - x) + d (p' - x') + F, where p is the intended path.
struct ArmSettings {
    double mass = 0.5;         // of hand and forearm as the finger feels it (unit: kilograms), > 0
    double damping = 10.0;     // of the muscles (unit: newton-seconds per meter), >= 0
    double stiffness = 150.0;  // of the muscles (unit: newtons per meter), >= 0
};

struct ArmState {
    Vec3 position{0.0};  // (unit: meters)
    Vec3 velocity{0.0};  // (unit: meters per second)
};

// The arm `seconds` later: the implicit midpoint rule, stable for any step, and exact in energy for an arm
// without damping. `intended`: the path in the middle of the step. `force`: on the hand (unit: newtons).
ArmState step_arm(const ArmSettings& settings, const ArmState& from, const HandSample& intended,
                  const Vec3& force, double seconds);

// Begins at rest relative to the path, with the first tick that reads it.
class SimulatedArm final : public Device {
public:
    // Needs a path that problem_with() finds nothing wrong with.
    SimulatedArm(HandPath path, const ArmSettings& settings)
        : path_(std::move(path)), settings_(settings), changed_(settings) {}

    // Any one thread, any time: from the next tick on the arm is another one, where it is.
    void change(const ArmSettings& settings) { changed_.publish(settings); }

    // Where its path begins anew, it means to go there from where it is.
    PathClock& clock() { return clock_; }

    DeviceSample read(Nanoseconds now) override;
    void write(Nanoseconds, const Vec3& force) override { force_ = force; }

private:
    HandPath path_;
    ArmSettings settings_;
    TripleBuffer<ArmSettings> changed_;
    ArmState arm_;
    Vec3 force_{0.0};  // held until the next one (unit: newtons)
    PathClock clock_;
    Nanoseconds read_at_ = 0;
    bool started_ = false;
};

}  // namespace tactus
