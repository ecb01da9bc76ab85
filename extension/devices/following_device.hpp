// A hand that is told where to be: by the mouse, keys, a gamepad, a node of the scene. They speak up a
// hundred times a second at best and in jumps; the loop needs a smooth position and its true velocity a
// thousand times a second: the hand follows its target like a critically damped spring, as fast as it can
// without ever overshooting a target at rest.
//
// Threads: aim() belongs to the Godot side, read() and write() to the haptic thread.
#pragma once

#include <optional>

#include "core/ports/device.hpp"
#include "realtime/triple_buffer.hpp"

namespace tactus {

struct HandTarget {
    Vec3 position{0.0};                 // where the hand is wanted, in the device's own frame (unit: meters)
    std::uint32_t buttons = 0;          // bit i: button i is held
    bool is_there = true;               // false: what leads the hand is missing, and the hand with it
    Quat rotation{1.0, 0.0, 0.0, 0.0};  // of the handle
};

// No hand goes farther from the origin (unit: meters).
constexpr double farthest_hand = 1e6;

// A point of the screen as its camera sees it, in the scene (unit: meters).
struct ScreenRay {
    Vec3 eye{0.0};
    Vec3 direction{0.0, 0.0, -1.0};  // of length 1
    Vec3 forward{0.0, 0.0, -1.0};    // that the camera looks along, of length 1
};

// Where on the ray a hand is that was at `before`: as deep in the scene as it was, and deeper by this much.
// Nothing where the ray leads to no place.
std::optional<Vec3> under_pointer(const ScreenRay& ray, const Vec3& before, double deeper);

// The follower's state and its step: x″ = ω²·(target − x) − 2ω·x′, solved exactly for a target at rest. With
// y = x − target and c = x′ + ω·y at the start of a step of length t
//     y(t) = (y + c·t)·e^(−ωt),   x′(t) = (x′ − c·ω·t)·e^(−ωt)
// so that steps of any length agree and none is unstable.
struct Follower {
    Vec3 position{0.0};  // (unit: meters)
    Vec3 velocity{0.0};  // (unit: meters per second)
};
Follower follow(const Follower& from, const Vec3& target, double rate, double seconds);

// The same of a rotation: x is the rotation vector from the target to it.
struct TurnFollower {
    Quat rotation{1.0, 0.0, 0.0, 0.0};
    Vec3 velocity{0.0};  // (unit: radians per second)
};
TurnFollower follow(const TurnFollower& from, const Quat& target, double rate, double seconds);

class FollowingDevice final : public Device {
public:
    struct Settings {
        Vec3 rest{0.0};                   // where the hand waits for the first target (unit: meters)
        Quat turned{1.0, 0.0, 0.0, 0.0};  // how it is turned there
        double rate = 80.0;    // ω (unit: 1/s), > 0: nine tenths of a jump are made up in 3.9/ω, 49 ms
        bool is_there = true;  // before the first target
        bool rotates = false;  // its targets have a rotation
    };

    explicit FollowingDevice(const Settings& settings);

    // The newest target wins; the hand holds still at it until there is another.
    void aim(const HandTarget& target) { targets_.publish(target); }

    DeviceCapabilities capabilities() const override { return {.rotates = rotates_}; }
    DeviceSample read(Nanoseconds now) override;
    void write(Nanoseconds, const Vec3&) override {}

private:
    double rate_;
    bool rotates_;
    TripleBuffer<HandTarget> targets_;
    Follower hand_;
    TurnFollower turn_;
    Nanoseconds previous_ = 0;
    bool started_ = false;
};

}  // namespace tactus
