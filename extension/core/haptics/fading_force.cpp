#include "core/haptics/fading_force.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "core/safety/limited_force.hpp"

namespace tactus {

namespace {

// A torque is as large as the device allows, which its safety sees to.
constexpr double no_limit = std::numeric_limits<double>::infinity();

Vec3 shortened_by(const Vec3& v, double length) {
    const double before = glm::length(v);
    return before > length ? v * ((before - length) / before) : Vec3(0.0);
}

// What hides a force is no longer than that: where the hand leaves while it fades, it is not drawn back.
// Along the force, what is felt does not go below nothing, or farther below than it was.
Vec3 drawing_back(const Vec3& force, const Vec3& offset, const Vec3& felt_before) {
    const double length = glm::length(force);
    if (length == 0.0) {
        return Vec3(0.0);
    }
    const Vec3 along = force / length;
    const double least = std::min(0.0, glm::dot(felt_before, along));
    return along * std::max(0.0, least - glm::dot(force + offset, along));
}

// What a spring that goes along with the hand would lose by its way from one place to the other.
double released(const Vec3& offset, double spring, const Vec3& way) {
    const double length = glm::length(offset);
    return length > 0.0 ? spring * std::max(0.0, glm::dot(way, offset) / length) : 0.0;
}

double change_by_hand(const FadingForce::Step& from, const FadingForce::Step& to) {
    const Vec3 moved = to.hand - from.hand;
    const Vec3 stretched = moved - (to.proxy - from.proxy);
    return std::max(from.stiffness, to.stiffness) * std::min(glm::length(moved), glm::length(stretched)) +
           std::max(from.damping, to.damping) * glm::distance(from.velocity, to.velocity);
}

}  // namespace

Vec3 FadingForce::felt(const Vec3& force, double limit, bool jumped, const Step& step) {
    const Vec3 given = limited_force(force, limit);
    const double allowed = std::max(step.fade, change_by_hand(step_, step));
    const double stiffest = std::max(step_.stiffness, step.stiffness);
    offset_ = shortened_by(offset_, std::max(step.fade, released(offset_, spring_, step.hand - step_.hand)));
    step_ = step;
    if (jumped) {
        // What it jumps by beyond that joins what is still fading.
        spring_ = offset_ == Vec3(0.0) ? stiffest : std::max(spring_, stiffest);
        offset_ -= shortened_by(given + offset_ - felt_, allowed);
    }
    offset_ += drawing_back(given, offset_, felt_);
    return goes_on_with(force, limit);
}

Vec3 FadingForce::goes_on_with(const Vec3& force, double limit) {
    felt_ = limited_force(limited_force(force, limit) + offset_, limit);
    return offset_ == Vec3(0.0) ? force : felt_;
}

Wrench FadingWrench::felt(const Wrench& wrench, double force_limit, bool jumped,
                          const FadingForce::Step& step, const FadingForce::Step& turn) {
    return {force_.felt(wrench.force, force_limit, jumped, step),
            torque_.felt(wrench.torque, no_limit, jumped, turn)};
}

Wrench FadingWrench::goes_on_with(const Wrench& wrench, double force_limit) {
    return {force_.goes_on_with(wrench.force, force_limit), torque_.goes_on_with(wrench.torque, no_limit)};
}

}  // namespace tactus
