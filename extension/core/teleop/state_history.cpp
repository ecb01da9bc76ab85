#include "core/teleop/state_history.hpp"

#include <algorithm>

namespace tactus {

StateHistory::StateHistory(std::size_t bodies, std::size_t samples)
    : bodies_(bodies), samples_(std::max<std::size_t>(1, samples)), entries_(bodies * samples_) {}

void StateHistory::set(std::size_t body, std::uint64_t sample, const BodyMotion& motion) {
    entry(body, sample) = {sample, true, motion};
}

const BodyMotion* StateHistory::at(std::size_t body, std::uint64_t sample) const {
    if (body >= bodies_) {
        return nullptr;
    }
    const Entry& found = entry(body, sample);
    return found.known && found.sample == sample ? &found.motion : nullptr;
}

void StateHistory::carry(std::size_t body, std::uint64_t first, std::uint64_t last, const BodyMotion& before,
                         const BodyMotion& after) {
    const Vec3 way = after.pose.position - before.pose.position;
    const Quat turn = after.pose.rotation * glm::conjugate(before.pose.rotation);
    const Vec3 faster = after.linear_velocity - before.linear_velocity;
    const Vec3 spin = after.angular_velocity - before.angular_velocity;
    first = last - first < samples_ ? first : last + 1 - samples_;
    for (std::uint64_t sample = first; sample <= last; ++sample) {
        Entry& past = entry(body, sample);
        if (past.known && past.sample == sample) {
            past.motion.pose.position += way;
            past.motion.pose.rotation = glm::normalize(turn * past.motion.pose.rotation);
            past.motion.linear_velocity += faster;
            past.motion.angular_velocity += spin;
        }
    }
}

void StateHistory::forget(std::size_t body) {
    for (std::size_t i = 0; i < samples_; ++i) {
        entries_[body * samples_ + i].known = false;
    }
}

}  // namespace tactus
