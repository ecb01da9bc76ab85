#include "credibility/box_on_corners.hpp"

#include <algorithm>

namespace tactus::bench {

namespace {

constexpr double gravity = 9.81;
constexpr double stiffness = 1e5;       // of a corner and of the sphere (unit: N/m)
constexpr double slowest_slide = 1e-4;  // friction is full well above it (unit: meters per second)

}  // namespace

BoxOnCorners::BoxOnCorners(const Vec3& size, double mass, double friction)
    : place(0.0, 0.5 * size.y - 0.25 * mass * gravity / stiffness, 0.0),
      half_(0.5 * size),
      mass_(mass),
      moments_(mass / 12.0 *
               Vec3(size.y * size.y + size.z * size.z, size.x * size.x + size.z * size.z,
                    size.x * size.x + size.y * size.y)),
      friction_(friction) {}

void BoxOnCorners::add(const Vec3& force, const Vec3& arm) {
    force_ += force;
    torque_ += glm::cross(arm, force);
}

Vec3 BoxOnCorners::push(const Vec3& center, double radius, const Vec3& of_sphere) {
    const Vec3 local = glm::conjugate(rotation) * (center - place);
    const Vec3 nearest = glm::clamp(local, -half_, half_);
    const double distance = glm::distance(local, nearest);
    if (distance == 0.0 || distance >= radius)
        return Vec3(0.0);
    const Vec3 normal = rotation * ((nearest - local) / distance);
    const Vec3 arm = rotation * nearest;
    const double approach = glm::dot(of_sphere - velocity - glm::cross(spin, arm), normal);
    const double damping = std::sqrt(stiffness * mass_);
    const Vec3 force = std::max(0.0, stiffness * (radius - distance) + damping * approach) * normal;
    add(force, arm);
    return force;
}

void BoxOnCorners::stand_on_floor() {
    const double damping = std::sqrt(stiffness * mass_);  // critical for four corners
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner((i & 1) != 0 ? half_.x : -half_.x, (i & 2) != 0 ? half_.y : -half_.y,
                          (i & 4) != 0 ? half_.z : -half_.z);
        const Vec3 arm = rotation * corner;
        const double depth = -(place.y + arm.y);
        if (depth <= 0.0)
            continue;
        const Vec3 u = velocity + glm::cross(spin, arm);
        const double load = std::max(0.0, stiffness * depth - damping * u.y);
        const double speed = std::sqrt(u.x * u.x + u.z * u.z + slowest_slide * slowest_slide);
        add({-friction_ * load * u.x / speed, load, -friction_ * load * u.z / speed}, arm);
    }
}

void BoxOnCorners::advance() {
    stand_on_floor();
    velocity += step * (force_ / mass_ - Vec3(0.0, gravity, 0.0));
    const Quat to_own = glm::conjugate(rotation);
    const Vec3 own = to_own * spin;
    spin += step * (rotation * ((to_own * torque_ - glm::cross(own, moments_ * own)) / moments_));
    place += step * velocity;
    rotation = glm::normalize(rotation + 0.5 * step * (Quat(0.0, spin.x, spin.y, spin.z) * rotation));
    force_ = torque_ = Vec3(0.0);
}

}  // namespace tactus::bench
