#include "devices/hand_path.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tactus {

namespace {

bool is_finite(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

constexpr double farthest_point = 1e6;  // from the origin (unit: meters)

std::string problem_with_circle(const CircleWave& path) {
    if (path.turn_time <= 0) {
        return "the time for one turn has to be above zero";
    }
    if (!is_finite(path.centre) || !std::isfinite(path.radius) || !std::isfinite(path.amplitude)) {
        return "center, radius and amplitude have to be finite numbers";
    }
    if (path.radius < 0.0 || path.amplitude < 0.0) {
        return "radius and amplitude may not be negative";
    }
    return {};
}

std::string problem_with_keyframes(const KeyframePath& path) {
    const std::vector<Keyframe>& keys = path.keyframes;
    if (keys.empty()) {
        return "the path has no points";
    }
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (!(glm::length(keys[i].position) <= farthest_point)) {
            return "point " + std::to_string(i) + " is no place within 1,000,000 m: set it anew";
        }
        if (i > 0 && keys[i].time <= keys[i - 1].time) {
            return "point " + std::to_string(i) + " is not later than the one before it";
        }
    }
    if (path.loop && keys.size() < 2) {
        return "a path that repeats needs at least two points";
    }
    if (path.loop && keys.back().position != keys.front().position) {
        return "a path that repeats has to end where it begins";
    }
    return {};
}

HandSample sample_circle(const CircleWave& path, Nanoseconds time) {
    const Nanoseconds since_turn = std::max<Nanoseconds>(time, 0) % path.turn_time;
    const double rate =
        2.0 * std::numbers::pi / to_seconds(path.turn_time);  // dθ/dt (unit: radians per second)
    const double angle = rate * to_seconds(since_turn);
    const double wave = static_cast<double>(path.waves);
    const Vec3 offset{path.radius * std::cos(angle), path.amplitude * std::sin(wave * angle),
                      path.radius * std::sin(angle)};
    const Vec3 by_angle{-path.radius * std::sin(angle), path.amplitude * wave * std::cos(wave * angle),
                        path.radius * std::cos(angle)};
    return {path.centre + offset, time < 0 ? Vec3(0.0) : rate * by_angle};
}

// The chord from one keyframe to another, as a velocity.
Vec3 mean_velocity(const Keyframe& from, const Keyframe& to) {
    return (to.position - from.position) / to_seconds(to.time - from.time);
}

// Catmull and Rom's choice, for keyframes at uneven times: the velocity between the neighbours on either
// side. At an end that does not join the other one, that of the only segment there.
Vec3 velocity_at_keyframe(const KeyframePath& path, std::size_t i) {
    const std::vector<Keyframe>& keys = path.keyframes;
    const std::size_t last = keys.size() - 1;
    if (i > 0 && i < last) {
        return mean_velocity(keys[i - 1], keys[i + 1]);
    }
    if (path.loop) {
        const Vec3 across = keys[1].position - keys[last - 1].position;
        return across / to_seconds(keys[1].time - keys[0].time + keys[last].time - keys[last - 1].time);
    }
    return i == 0 ? mean_velocity(keys[0], keys[1]) : mean_velocity(keys[last - 1], keys[last]);
}

HandSample sample_line(const Keyframe& from, const Keyframe& to, Nanoseconds time) {
    const Vec3 velocity = mean_velocity(from, to);
    return {from.position + velocity * to_seconds(time - from.time), velocity};
}

// The cubic with the given ends and end velocities (Hermite). With u = t/h in 0 … 1
//     p = (2u³−3u²+1)·p0 + (u³−2u²+u)·h·v0 + (3u²−2u³)·p1 + (u³−u²)·h·v1,  velocity = dp/du / h
HandSample sample_cubic(const KeyframePath& path, std::size_t segment, Nanoseconds time) {
    const Keyframe& from = path.keyframes[segment];
    const Keyframe& to = path.keyframes[segment + 1];
    const double h = to_seconds(to.time - from.time);
    const double u = to_seconds(time - from.time) / h;
    const Vec3 chord = to.position - from.position;
    const Vec3 m0 = h * velocity_at_keyframe(path, segment);
    const Vec3 m1 = h * velocity_at_keyframe(path, segment + 1);
    const Vec3 position =
        from.position + u * u * (3.0 - 2.0 * u) * chord + u * (1.0 - u) * ((1.0 - u) * m0 - u * m1);
    const Vec3 by_u =
        6.0 * u * (1.0 - u) * chord + (1.0 - u) * (1.0 - 3.0 * u) * m0 + u * (3.0 * u - 2.0) * m1;
    return {position, by_u / h};
}

HandSample sample_keyframes(const KeyframePath& path, Nanoseconds time) {
    const std::vector<Keyframe>& keys = path.keyframes;
    const Nanoseconds begin = keys.front().time;
    const Nanoseconds end = keys.back().time;
    if (path.loop && time >= end) {
        time = begin + (time - begin) % (end - begin);
    }
    if (time < begin || keys.size() == 1) {
        return {keys.front().position, Vec3(0.0)};
    }
    if (time >= end) {
        return {keys.back().position, Vec3(0.0)};
    }
    const auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                        [](Nanoseconds t, const Keyframe& key) { return t < key.time; });
    const auto segment = static_cast<std::size_t>(after - keys.begin()) - 1;
    return path.interpolation == PathInterpolation::linear
               ? sample_line(keys[segment], keys[segment + 1], time)
               : sample_cubic(path, segment, time);
}

}  // namespace

KeyframePath at_speed(const std::vector<Vec3>& places, double speed, bool loop) {
    KeyframePath path;
    path.interpolation = PathInterpolation::linear;
    path.loop = loop;
    double way = 0.0;
    for (const Vec3& place : places) {
        way += path.keyframes.empty() ? 0.0 : glm::distance(place, path.keyframes.back().position);
        path.keyframes.push_back({from_seconds(way / speed), place});
    }
    return path;
}

std::string problem_with(const HandPath& path) {
    const auto* circle = std::get_if<CircleWave>(&path);
    return circle != nullptr ? problem_with_circle(*circle)
                             : problem_with_keyframes(*std::get_if<KeyframePath>(&path));
}

HandSample sample_path(const HandPath& path, Nanoseconds time) {
    const auto* circle = std::get_if<CircleWave>(&path);
    return circle != nullptr ? sample_circle(*circle, time)
                             : sample_keyframes(*std::get_if<KeyframePath>(&path), time);
}

Nanoseconds path_duration(const HandPath& path) {
    const auto* circle = std::get_if<CircleWave>(&path);
    return circle != nullptr ? circle->turn_time : std::get_if<KeyframePath>(&path)->keyframes.back().time;
}

bool path_repeats(const HandPath& path) {
    const auto* keyframes = std::get_if<KeyframePath>(&path);
    return keyframes == nullptr || keyframes->loop;
}

}  // namespace tactus
