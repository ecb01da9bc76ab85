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

// A part of the step in which the body turns no further keeps the energy within 1e-5 (unit: radians).
constexpr double turn_of_a_part = 0.1;
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

Vec3 momentum_of(const JPH::MotionProperties& motion, JPH::QuatArg rotation, const Vec3& velocity) {
    const Quat axes = principal_axes(motion, rotation);
    return axes * ((glm::conjugate(axes) * velocity) / inverse_moments_of(motion));
}

Vec3 velocity_of(const JPH::MotionProperties& motion, JPH::QuatArg rotation, const Vec3& momentum) {
    const Quat axes = principal_axes(motion, rotation);
    return axes * ((glm::conjugate(axes) * momentum) * inverse_moments_of(motion));
}

// Taylor series for |x| < 0.3: the C library's functions differ in their last bits between systems.
double small_sine(double x) {
    const double y = x * x;
    return x * (1.0 - y / 6.0 * (1.0 - y / 20.0 * (1.0 - y / 42.0 * (1.0 - y / 72.0))));
}
double small_cosine(double x) {
    const double y = x * x;
    return 1.0 - y / 2.0 * (1.0 - y / 12.0 * (1.0 - y / 30.0 * (1.0 - y / 56.0)));
}
// asin(x) / x for |x| < 0.3.
double small_arc_over_sine(double x) {
    const double y = x * x;
    return 1.0 + y * (1.0 / 6.0 + y * (3.0 / 40.0 + y * (15.0 / 336.0 + y * (105.0 / 3456.0))));
}

// Of a body about its principal axes.
struct Rotor {
    Vec3 inverse_moments;
    Vec3 momentum;  // along the principal axes
    Quat turned{1.0, 0.0, 0.0, 0.0};

    // The body turns about the axis by h L_i / I_i, and so its momentum turns back in the body's frame.
    void turn(int axis, double h) {
        const double half = 0.5 * h * momentum[axis] * inverse_moments[axis];
        Quat part(small_cosine(half), 0.0, 0.0, 0.0);
        (&part.x)[axis] = small_sine(half);
        momentum = glm::conjugate(part) * momentum;
        turned = turned * part;
    }

    void advance_by_second_order(double h) {
        turn(0, 0.5 * h);
        turn(1, 0.5 * h);
        turn(2, h);
        turn(1, 0.5 * h);
        turn(0, 0.5 * h);
    }

    // 1 / (2 - 2^(1/3)) of the part forth, twice, and what that is too far back in between.
    void advance(double h) {
        constexpr double forth = 1.3512071919596578;
        advance_by_second_order(forth * h);
        advance_by_second_order((1.0 - 2.0 * forth) * h);
        advance_by_second_order(forth * h);
    }
};

// The constant velocity, in the world, that turns the body in a step as far as it turns without a torque.
Vec3 mean_velocity(const JPH::MotionProperties& motion, JPH::QuatArg rotation, const Vec3& momentum,
                   double seconds) {
    const Quat axes = principal_axes(motion, rotation);
    Rotor rotor{inverse_moments_of(motion), glm::conjugate(axes) * momentum};
    const double angle = glm::length(rotor.momentum * rotor.inverse_moments) * seconds;
    const int parts = std::clamp(static_cast<int>(std::ceil(angle / turn_of_a_part)), 1, max_parts);
    Quat whole(1.0, 0.0, 0.0, 0.0);
    Vec3 mean(0.0);
    for (int i = 0; i < parts; ++i) {
        rotor.turned = Quat(1.0, 0.0, 0.0, 0.0);
        rotor.advance(seconds / parts);
        // Rotation vector of the part: each is far below half a turn.
        const Vec3 axis(rotor.turned.x, rotor.turned.y, rotor.turned.z);
        mean += whole * (2.0 * small_arc_over_sine(glm::length(axis)) * axis);
        whole = whole * rotor.turned;
    }
    if (parts > 1) {
        // The rotation vector of the whole, with as many whole turns as the parts made.
        const Vec3 axis(whole.x, whole.y, whole.z);
        const double sine = glm::length(axis);
        if (sine > 1e-9) {
            const double turn = 2.0 * JPH::ATan2(static_cast<float>(sine), static_cast<float>(whole.w));
            const double about = glm::dot(mean, axis) / sine;
            constexpr double circle = 2.0 * std::numbers::pi;
            mean = axis * ((turn + circle * std::round((about - turn) / circle)) / sine);
        }
    }
    return axes * (mean / seconds);
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
        const Vec3 momentum =
            momentum_of(motion, body.GetRotation(), units::plain(motion.GetAngularVelocity()));
        const Vec3 mean = mean_velocity(motion, body.GetRotation(), momentum, seconds);
        if (glm::length(mean) > limits::fastest_spin)
            continue;  // Jolt would cut it off
        motion.SetAngularVelocity(units::plain(mean));
        spins_.push_back({&body, body.GetRotation(), momentum, units::plain(motion.GetAngularVelocity())});
    }
}

void FreeSpin::end_step() {
    for (const Spin& spin : spins_) {
        if (!spin.body->IsActive())
            continue;
        JPH::MotionProperties& motion = *spin.body->GetMotionProperties();
        const Vec3 added = units::plain(motion.GetAngularVelocity()) - spin.velocity;
        const Vec3 momentum = spin.momentum + momentum_of(motion, spin.rotation, added);
        // What is cut off makes it slower in all, never faster.
        motion.SetAngularVelocity(units::plain(
            shortened(velocity_of(motion, spin.body->GetRotation(), momentum), limits::fastest_spin)));
    }
}

}  // namespace tactus
