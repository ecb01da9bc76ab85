#include "devices/following_device.hpp"

#include <cmath>

namespace tactus {

Follower follow(const Follower& from, const Vec3& target, double rate, double seconds) {
    const double decay = std::exp(-rate * seconds);
    const Vec3 offset = from.position - target;
    const Vec3 c = from.velocity + rate * offset;
    return {target + decay * (offset + seconds * c), decay * (from.velocity - rate * seconds * c)};
}

FollowingDevice::FollowingDevice(const Settings& settings)
    : rate_(settings.rate), targets_(HandTarget{settings.rest, 0}), hand_{settings.rest, Vec3(0.0)} {}

// The target of the time since the last tick is the one known then: what has just come in counts from now on.
DeviceSample FollowingDevice::read(Nanoseconds now) {
    if (started_) {
        hand_ = follow(hand_, targets_.front().position, rate_, to_seconds(now - previous_));
    }
    started_ = true;
    previous_ = now;
    targets_.refresh();

    DeviceSample sample;
    sample.position = hand_.position;
    sample.velocity = hand_.velocity;
    sample.buttons = targets_.front().buttons;
    sample.connected = true;
    return sample;
}

}  // namespace tactus
