// A scripted hand: time in, position and velocity out. Plain values; nothing here reads a clock or allocates
// once made.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/math/types.hpp"

namespace tactus {

struct HandSample {
    Vec3 position{0.0};  // (unit: meters)
    Vec3 velocity{0.0};  // the position's own derivative (unit: meters per second)
};

// The thesis path (section 5.1): a circle in X–Z with a sine in Y. With θ = 2π·t/turn_time
//     p(t) = centre + (radius·cos θ, amplitude·sin(waves·θ), radius·sin θ)
// It goes through the ground y = 0 with each wave where |centre.y| < amplitude.
struct CircleWave {
    Vec3 centre{0.0, 0.0, 0.0};              // (unit: meters)
    double radius = 0.25;                    // of the circle in X–Z (unit: meters), ≥ 0
    double amplitude = 0.05;                 // of the sine in Y (unit: meters), ≥ 0
    Nanoseconds turn_time = 10'000'000'000;  // of one turn of the circle, > 0
    int waves = 5;                           // sines in Y for each turn; whole, so that the path closes
};

struct Keyframe {
    Nanoseconds time = 0;  // since the path's start
    Vec3 position{0.0};    // (unit: meters)
};

enum class PathInterpolation {
    linear,       // straight lines; the velocity jumps at each keyframe
    catmull_rom,  // through all keyframes, the velocity is continuous
};

// Before the first keyframe the hand rests there; after the last it rests, or begins again where `loop` is
// set.
struct KeyframePath {
    std::vector<Keyframe> keyframes{};  // at least one; times strictly rising
    PathInterpolation interpolation = PathInterpolation::catmull_rom;
    bool loop = false;  // the last keyframe is the first one again, in the same place
};

using HandPath = std::variant<CircleWave, KeyframePath>;

// Straight from place to place, at that speed all along (unit: meters per second).
KeyframePath at_speed(const std::vector<Vec3>& places, double speed, bool loop);

// Empty, or what has to be put right before the path can be followed.
std::string problem_with(const HandPath& path);

// Where the hand is at `time` since the path's start; before it, where it starts. Needs a path without a
// problem.
HandSample sample_path(const HandPath& path, Nanoseconds time);

// From the start to the end, or to the beginning of the next round.
Nanoseconds path_duration(const HandPath& path);
// Whether it begins again at its end.
bool path_repeats(const HandPath& path);

}  // namespace tactus
