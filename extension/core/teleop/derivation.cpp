#include "core/teleop/derivation.hpp"

#include <algorithm>

namespace tactus {

namespace {

BodyMotion extrapolated(const BodyMotion& from, const Vec3& linear_rate, const Vec3& angular_rate,
                        double seconds) {
    return {carried_on(from.pose, linear_rate, angular_rate, seconds), linear_rate, angular_rate};
}

// The mean rate over the way is x' + x'' dt / 2, the rate at its end x' + x'' dt.
BodyMotion accelerated(const DerivationInput& in, double seconds) {
    const BodyMotion& r = in.received;
    BodyMotion now = extrapolated(r, r.linear_velocity + in.linear_acceleration * (0.5 * seconds),
                                  r.angular_velocity + in.angular_acceleration * (0.5 * seconds), seconds);
    now.linear_velocity = r.linear_velocity + in.linear_acceleration * seconds;
    now.angular_velocity = r.angular_velocity + in.angular_acceleration * seconds;
    return now;
}

BodyMotion with_own_changes(const DerivationInput& in) {
    const Quat turned = in.own_now.pose.rotation * glm::conjugate(in.own_then.pose.rotation);
    return {{in.received.pose.position + (in.own_now.pose.position - in.own_then.pose.position),
             glm::normalize(turned * in.received.pose.rotation)},
            in.received.linear_velocity + (in.own_now.linear_velocity - in.own_then.linear_velocity),
            in.received.angular_velocity + (in.own_now.angular_velocity - in.own_then.angular_velocity)};
}

}  // namespace

BodyMotion derive(Derivation derivation, const DerivationInput& in) {
    const double seconds = std::min(in.seconds, in.max_extrapolation);
    const BodyMotion& r = in.received;
    switch (derivation) {
        case Derivation::none:
            return r;
        case Derivation::velocity:
            return extrapolated(r, r.linear_velocity, r.angular_velocity, seconds);
        case Derivation::acceleration:
            return accelerated(in, seconds);
        case Derivation::averaged: {
            BodyMotion now = extrapolated(r, 0.5 * (r.linear_velocity + in.own_then.linear_velocity),
                                          0.5 * (r.angular_velocity + in.own_then.angular_velocity), seconds);
            // Only the way is averaged: half of a wrong rate of the model's own, kept at each state, would
            // stay in it for ever.
            now.linear_velocity = r.linear_velocity;
            now.angular_velocity = r.angular_velocity;
            return now;
        }
        case Derivation::history:
        case Derivation::resimulate:
            return with_own_changes(in);
    }
    return r;
}

}  // namespace tactus
