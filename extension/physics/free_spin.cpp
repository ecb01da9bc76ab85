#include "physics/free_spin.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/shortened.hpp"
#include "physics/jolt_units.hpp"
#include "physics/limits.hpp"

namespace tactus {

namespace {

// Principal moments that differ by less are those of a ball (dimensionless).
constexpr float same_moment = 1e-5f;

// A slower spin turns its velocity by less than single precision can hold (unit: radians per second).
constexpr float slowest = 1e-4f;

// A part of the step in which the body turns no further keeps the energy within 1e-9 (unit: radians).
constexpr double turn_of_a_part = 0.03;
constexpr int max_parts = 64;

bool is_ball(JPH::Vec3Arg inverse_moments) {
    return inverse_moments.ReduceMax() - inverse_moments.ReduceMin() <=
           same_moment * inverse_moments.ReduceMax();
}

bool precesses(const JPH::Body& body) {
    if (!body.IsDynamic())
        return false;
    const JPH::MotionProperties& motion = *body.GetMotionProperties();
    constexpr auto all_rotations =
        JPH::EAllowedDOFs::RotationX | JPH::EAllowedDOFs::RotationY | JPH::EAllowedDOFs::RotationZ;
    return (motion.GetAllowedDOFs() & all_rotations) == all_rotations &&
           motion.GetAngularVelocity().LengthSq() > slowest * slowest &&
           motion.GetInverseInertiaDiagonal().ReduceMin() > 0.0f &&
           !is_ball(motion.GetInverseInertiaDiagonal());
}

// Frame of the principal axes in the world. In double precision: what a float quaternion is longer or shorter
// than 1 would add up to a percent in a minute.
Quat principal_axes(const JPH::MotionProperties& motion, JPH::QuatArg rotation) {
    return units::rotation(rotation) * units::rotation(motion.GetInertiaRotation());
}

Vec3 inverse_moments_of(const JPH::MotionProperties& motion) {
    return units::plain(motion.GetInverseInertiaDiagonal());
}

// In the frame of the principal axes, whose rotation is `axes`.
Vec3 momentum_of(const Quat& axes, const Vec3& inverse_moments, const Vec3& velocity) {
    return (glm::conjugate(axes) * velocity) / inverse_moments;
}

// Taylor series for |x| < 0.3: the C library's functions differ in their last bits between systems.
double small_sine_over(double x) {
    const double y = x * x;
    return 1.0 - y / 6.0 * (1.0 - y / 20.0 * (1.0 - y / 42.0 * (1.0 - y / 72.0)));
}
double small_cosine(double x) {
    const double y = x * x;
    return 1.0 - y / 2.0 * (1.0 - y / 12.0 * (1.0 - y / 30.0 * (1.0 - y / 56.0)));
}

Quat small_rotation(const Vec3& rotation_vector) {
    const double half = 0.5 * glm::length(rotation_vector);
    return {small_cosine(half), 0.5 * small_sine_over(half) * rotation_vector};
}

// Rotation vector by which a body turns in h without a torque, along its principal axes (see the header).
Vec3 free_rotation(const Vec3& inverse_moments, const Vec3& momentum, double h) {
    const Vec3 w0 = inverse_moments * momentum;
    const Vec3 l1 = glm::cross(momentum, w0);
    const Vec3 w1 = inverse_moments * l1;
    const Vec3 l2 = glm::cross(l1, w0) + glm::cross(momentum, w1);
    const Vec3 w2 = inverse_moments * l2;
    const Vec3 w3 =
        inverse_moments * (glm::cross(l2, w0) + 2.0 * glm::cross(l1, w1) + glm::cross(momentum, w2));
    const Vec3 third = 2.0 * w2 + glm::cross(w0, w1);
    const Vec3 fourth = w3 + glm::cross(w0, w2);
    return h * (w0 + h * (w1 / 2.0 + h * (third / 12.0 + h * fourth / 24.0)));
}

// The constant velocity that turns the body in a step as far as it turns without a torque, both along the
// principal axes.
Vec3 mean_velocity(const Vec3& inverse_moments, Vec3 momentum, double seconds) {
    const double angle = glm::length(momentum * inverse_moments) * seconds;
    const int parts = std::clamp(static_cast<int>(std::ceil(angle / turn_of_a_part)), 1, max_parts);
    if (parts == 1)
        return free_rotation(inverse_moments, momentum, seconds) / seconds;
    Quat whole(1.0, 0.0, 0.0, 0.0);
    Vec3 mean(0.0);
    for (int i = 0; i < parts; ++i) {
        const Vec3 way = free_rotation(inverse_moments, momentum, seconds / parts);
        const Quat part = small_rotation(way);
        mean += whole * way;
        momentum = glm::conjugate(part) * momentum;
        whole = whole * part;
    }
    // The rotation vector of the whole, with as many whole turns as the parts made.
    const Vec3 axis(whole.x, whole.y, whole.z);
    const double sine = glm::length(axis);
    if (sine > 1e-9) {
        const double turn = 2.0 * JPH::ATan2(static_cast<float>(sine), static_cast<float>(whole.w));
        const double about = glm::dot(mean, axis) / sine;
        constexpr double circle = 2.0 * std::numbers::pi;
        mean = axis * ((turn + circle * std::round((about - turn) / circle)) / sine);
    }
    return mean / seconds;
}

}  // namespace

void FreeSpin::begin_step(std::span<const JPH::BodyID> active, std::span<BodyRecord* const> records,
                          float seconds) {
    spins_.clear();
    for (const JPH::BodyID id : active) {
        JPH::Body& body = *records[id.GetIndex()]->in_world;
        if (!precesses(body))
            continue;
        JPH::MotionProperties& motion = *body.GetMotionProperties();
        const Quat axes = principal_axes(motion, body.GetRotation());
        const Vec3 inverse_moments = inverse_moments_of(motion);
        const Vec3 momentum = momentum_of(axes, inverse_moments, units::plain(motion.GetAngularVelocity()));
        const Vec3 mean = axes * mean_velocity(inverse_moments, momentum, seconds);
        if (glm::length(mean) > limits::fastest_spin)
            continue;  // Jolt would cut it off
        motion.SetAngularVelocity(units::plain(mean));
        spins_.push_back({&body, axes, momentum, units::plain(motion.GetAngularVelocity())});
    }
}

void FreeSpin::end_step() {
    for (const Spin& spin : spins_) {
        if (!spin.body->IsActive())
            continue;
        JPH::MotionProperties& motion = *spin.body->GetMotionProperties();
        const Vec3 inverse_moments = inverse_moments_of(motion);
        const Vec3 added = units::plain(motion.GetAngularVelocity()) - spin.velocity;
        const Vec3 momentum = spin.axes * (spin.momentum + momentum_of(spin.axes, inverse_moments, added));
        const Quat axes = principal_axes(motion, spin.body->GetRotation());
        const Vec3 velocity = axes * (inverse_moments * (glm::conjugate(axes) * momentum));
        // What is cut off makes it slower in all, never faster.
        motion.SetAngularVelocity(units::plain(shortened(velocity, limits::fastest_spin)));
    }
}

}  // namespace tactus
