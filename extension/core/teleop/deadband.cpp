#include "core/teleop/deadband.hpp"

#include <glm/geometric.hpp>

namespace tactus {

bool hand_is_due(const DeadbandSettings& settings, const SaidHand& said) {
    const bool rests = said.stands && said.acknowledged;
    const Nanoseconds longest = rests ? settings.longest_silence
                                      : std::min(settings.longest_silence, from_seconds(longest_hand_guess));
    return !settings.enabled || said.since_sample >= longest;
}

bool position_needs_sending(const DeadbandSettings& settings, const Vec3& guessed, const Vec3& actual,
                            const Vec3& velocity) {
    const double allowed = settings.position + settings.position_weber * 0.1 * glm::length(velocity);
    return !settings.enabled || glm::length(actual - guessed) > allowed;
}

bool motion_needs_sending(const DeadbandSettings& settings, const BodyMotion& guessed,
                          const BodyMotion& actual) {
    return !settings.enabled ||
           glm::length(actual.pose.position - guessed.pose.position) > settings.position ||
           angle_between(actual.pose.rotation, guessed.pose.rotation) > settings.angle;
}

bool force_needs_sending(const DeadbandSettings& settings, const Vec3& last_sent, const Vec3& actual) {
    const double allowed = settings.force + settings.force_weber * glm::length(last_sent);
    return !settings.enabled || glm::length(actual - last_sent) > allowed;
}

}  // namespace tactus
