#include "devices/following_device.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/math/body_motion.hpp"

namespace tactus {

namespace {

// The hand stays at least this far in front of the camera (unit: meters).
constexpr double nearest_depth = 0.02;

}  // namespace

std::optional<Vec3> under_pointer(const ScreenRay& ray, const Vec3& before, double deeper) {
    const double depth = std::max(nearest_depth, glm::dot(before - ray.eye, ray.forward) + deeper);
    const double slant = glm::dot(ray.direction, ray.forward);
    if (!(slant > 0.0)) {
        return std::nullopt;
    }
    const Vec3 place = ray.eye + ray.direction * (depth / slant);
    return glm::length(place) < farthest_hand ? std::optional(place) : std::nullopt;
}

Follower follow(const Follower& from, const Vec3& target, double rate, double seconds) {
    const double decay = std::exp(-rate * seconds);
    const Vec3 offset = from.position - target;
    const Vec3 c = from.velocity + rate * offset;
    return {target + decay * (offset + seconds * c), decay * (from.velocity - rate * seconds * c)};
}

TurnFollower follow(const TurnFollower& from, const Quat& target, double rate, double seconds) {
    const Vec3 offset = turn_vector(from.rotation * glm::conjugate(target));
    const Follower now = follow({offset, from.velocity}, Vec3(0.0), rate, seconds);
    return {glm::normalize(turn_by(now.position, 1.0) * target), now.velocity};
}

FollowingDevice::FollowingDevice(const Settings& settings)
    : rate_(settings.rate),
      rotates_(settings.rotates),
      targets_(HandTarget{settings.rest, 0, settings.is_there, settings.turned}),
      hand_{settings.rest, Vec3(0.0)},
      turn_{settings.turned, Vec3(0.0)} {}

// The target of the time since the last tick is the one known then: what has just come in counts from now on.
DeviceSample FollowingDevice::read(Nanoseconds now) {
    if (started_) {
        const double seconds = to_seconds(now - previous_);
        hand_ = follow(hand_, targets_.front().position, rate_, seconds);
        turn_ = rotates_ ? follow(turn_, targets_.front().rotation, rate_, seconds) : turn_;
    }
    started_ = true;
    previous_ = now;
    targets_.refresh();

    DeviceSample sample;
    sample.position = hand_.position;
    sample.velocity = hand_.velocity;
    sample.rotation = turn_.rotation;
    sample.buttons = targets_.front().buttons;
    sample.connected = targets_.front().is_there;
    return sample;
}

}  // namespace tactus
