#include "core/teleop/pose_filter.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

Vec3 cut(const Vec3& v, double most) {
    const double length = glm::length(v);
    return length > most ? v * (most / length) : v;
}

}  // namespace

BodyMotion PoseFilter::filter(const PoseFilterSettings& settings, const BodyMotion& received,
                              const BodyMotion& expected, double seconds) {
    const Vec3 y = received.pose.position - expected.pose.position;
    if (!known_) {
        known_ = true;
        before_ = y;
        return received;
    }
    const double share = 1.0 - std::exp(-std::max(0.0, seconds) / settings.memory);
    // A body that is really elsewhere now changes y once; chance does so every time.
    const Vec3 change = cut(y - before_, 3.0 * (std::sqrt(chance_) + settings.trusted));
    chance_ += share * (0.5 * glm::dot(change, change) - chance_);
    stays_ += share * (glm::dot(y, before_) - stays_);
    before_ = y;
    const bool rests = glm::length(received.linear_velocity) < settings.still_speed &&
                       glm::length(received.angular_velocity) < settings.still_spin;
    at_rest_ = rests ? std::min(at_rest_ + 1.0, settings.most_at_rest) : 0.0;
    if (chance_ <= settings.trusted * settings.trusted) {
        return received;
    }
    const double stays = std::max(0.0, stays_);
    double believed = stays / (stays + chance_);
    believed = std::max(believed, rests ? 1.0 / at_rest_ : 0.02);
    BodyMotion result = received;
    result.pose.position = expected.pose.position + believed * y;
    result.pose.rotation =
        glm::normalize(glm::slerp(expected.pose.rotation, received.pose.rotation, believed));
    return result;
}

}  // namespace tactus
