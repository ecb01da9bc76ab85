#include "physics/contact_rules.hpp"

#include <algorithm>
#include <cmath>

#include "physics/body_record.hpp"
#include "physics/jolt_units.hpp"

namespace tactus {

namespace {

// The world that holds a body has its record in the body's user data.
float learnt_friction(const JPH::Body& body) {
    return static_cast<float>(reinterpret_cast<const BodyRecord*>(body.GetUserData())->factors.friction);
}

// A point that moves slower does not slide: friction stops it in the step.
constexpr float slowest_sliding = units::length(5e-4);  // (unit: Jolt's length per second)

// One body at a contact point.
struct Side {
    const JPH::MotionProperties* motion = nullptr;  // null: it stands still
    JPH::Vec3 arm = JPH::Vec3::sZero();             // from the center of mass to the point
    JPH::Vec3 velocity = JPH::Vec3::sZero();        // of its material there
    float inverse_mass = 0.0f;
    JPH::Mat44 inverse_inertia = JPH::Mat44::sZero();

    // Velocity of the point for a unit impulse along a unit vector.
    JPH::Vec3 moved_by(JPH::Vec3Arg along) const {
        return inverse_mass * along + inverse_inertia.Multiply3x3(arm.Cross(along)).Cross(arm);
    }
    // Velocity along a unit vector for a unit impulse along it.
    float mobility(JPH::Vec3Arg along) const {
        const JPH::Vec3 lever = arm.Cross(along);
        return inverse_mass + lever.Dot(inverse_inertia.Multiply3x3(lever));
    }
};

Side side_of(const JPH::Body& body, JPH::RVec3Arg point) {
    Side side;
    if (!body.IsStatic()) {
        side.motion = body.GetMotionProperties();
        side.arm = JPH::Vec3(point - body.GetCenterOfMassPosition());
        side.velocity = side.motion->GetPointVelocityCOM(side.arm);
    }
    return side;
}

// Its mass, and its velocity without what the forces of the step have given it.
void weigh(Side& side, const JPH::Body& body, float mass_scale, float inertia_scale, JPH::Vec3Arg gravity,
           float seconds) {
    if (!body.IsDynamic())
        return;
    const JPH::Mat44 inverse_inertia = body.GetInverseInertia();
    const float inverse_mass = side.motion->GetInverseMass();
    side.inverse_mass = mass_scale * inverse_mass;
    side.inverse_inertia = inertia_scale * inverse_inertia;
    if (body.IsActive())
        side.velocity -=
            seconds *
            (side.motion->GetGravityFactor() * gravity + inverse_mass * side.motion->GetAccumulatedForce() +
             inverse_inertia.Multiply3x3(side.motion->GetAccumulatedTorque()).Cross(side.arm));
}

JPH::Vec3 sliding_of(const Side& a, const Side& b, JPH::Vec3Arg normal) {
    const JPH::Vec3 relative = a.velocity - b.velocity;
    return relative - relative.Dot(normal) * normal;
}

// Of the first against the second, where they turn together: what takes both along the chords of their
// circles. Zero where they do not.
JPH::Vec3 velocity_on_chords(const JPH::Body& a, const JPH::Body& b, JPH::Vec3Arg normal, float seconds) {
    constexpr float slowest = 0.01f;  // (unit: radians per second)
    constexpr float alike = 0.1f;     // as a share of the rate
    if (a.IsStatic() || b.IsStatic())
        return JPH::Vec3::sZero();
    const float rate = a.GetAngularVelocity().Dot(normal);
    const float other_rate = b.GetAngularVelocity().Dot(normal);
    if (std::abs(rate) < slowest || std::abs(other_rate - rate) > alike * std::abs(rate))
        return JPH::Vec3::sZero();
    const JPH::Vec3 way(b.GetCenterOfMassPosition() - a.GetCenterOfMassPosition());
    return 0.5f * rate * rate * seconds * (way - way.Dot(normal) * normal);
}

}  // namespace

// A rough body's coefficient is stored negative: the smaller number is then the rough one's.
float combined_friction(const JPH::Body& a, const JPH::SubShapeID&, const JPH::Body& b,
                        const JPH::SubShapeID&) {
    return std::abs(std::min(a.GetFriction(), b.GetFriction())) * learnt_friction(a) * learnt_friction(b);
}

// An absorbent body's is stored negative: it subtracts.
float combined_restitution(const JPH::Body& a, const JPH::SubShapeID&, const JPH::Body& b,
                           const JPH::SubShapeID&) {
    return std::clamp(a.GetRestitution() + b.GetRestitution(), 0.0f, 1.0f);
}

void ContactRules::apply(const JPH::Body& a, const JPH::Body& b, const JPH::ContactManifold& manifold,
                         JPH::ContactSettings& contact) const {
    if (layers_.any_one_sided())
        push_one_sidedly(a, b, contact);
    if (a.IsDynamic() && b.IsDynamic())
        take_pains(a, b);
    if (contact.mCombinedFriction > 0.0f) {
        oppose_sliding(a, b, manifold, contact);
        if (contact.mCombinedRestitution > 0.0f)
            bound_bounce(a, b, manifold, contact);
    }
}

void ContactRules::push_one_sidedly(const JPH::Body& a, const JPH::Body& b,
                                    JPH::ContactSettings& contact) const {
    if (!layers_.notices(a.GetObjectLayer(), b.GetObjectLayer())) {
        contact.mInvMassScale1 = 0.0f;
        contact.mInvInertiaScale1 = 0.0f;
    }
    if (!layers_.notices(b.GetObjectLayer(), a.GetObjectLayer())) {
        contact.mInvMassScale2 = 0.0f;
        contact.mInvInertiaScale2 = 0.0f;
    }
}

void ContactRules::take_pains(const JPH::Body& a, const JPH::Body& b) const {
    constexpr float same_mass = 4.0f;  // ratio that the ordinary number of iterations is enough for
    constexpr float most = 64.0f;
    const float inverse1 = a.GetMotionProperties()->GetInverseMass();
    const float inverse2 = b.GetMotionProperties()->GetInverseMass();
    const float ratio = std::max(inverse1, inverse2) / std::min(inverse1, inverse2);
    if (!(ratio > same_mass))
        return;
    JPH::MotionProperties& motion = *records_[a.GetID().GetIndex()]->in_world->GetMotionProperties();
    const auto wanted = static_cast<JPH::uint>(std::min(4.0f * std::sqrt(ratio), most));
    motion.SetNumVelocityStepsOverride(std::max(motion.GetNumVelocityStepsOverride(), wanted));
}

void ContactRules::bound_bounce(const JPH::Body& a, const JPH::Body& b, const JPH::ContactManifold& manifold,
                                JPH::ContactSettings& contact) const {
    const JPH::Vec3 normal = manifold.mWorldSpaceNormal;
    const JPH::RVec3 point = manifold.mBaseOffset + 0.5f * (manifold.mRelativeContactPointsOn1[0] +
                                                            manifold.mRelativeContactPointsOn2[0]);
    Side on_a = side_of(a, point);
    Side on_b = side_of(b, point);
    weigh(on_a, a, contact.mInvMassScale1, contact.mInvInertiaScale1, gravity_, seconds_);
    weigh(on_b, b, contact.mInvMassScale2, contact.mInvInertiaScale2, gravity_, seconds_);
    const JPH::Vec3 velocity = on_b.velocity - on_a.velocity;
    const float approach = -velocity.Dot(normal);
    if (approach <= 0.0f)
        return;
    JPH::Mat44 mobility = JPH::Mat44::sIdentity();  // W
    for (const JPH::uint axis : {0u, 1u, 2u}) {
        JPH::Vec3 along = JPH::Vec3::sZero();
        along.SetComponent(axis, 1.0f);
        mobility.SetColumn3(axis, on_a.moved_by(along) + on_b.moved_by(along));
    }
    const JPH::Mat44 mass = mobility.Inversed3x3();  // M
    const auto bounded = [&](float most) {
        contact.mCombinedRestitution = std::min(contact.mCombinedRestitution, std::max(0.0f, most));
    };
    const JPH::Vec3 along = -contact.mRelativeLinearSurfaceVelocity;  // g
    const JPH::Vec3 sticking =
        mass.Multiply3x3(along + contact.mCombinedRestitution * approach * normal - velocity);
    const float pressing = sticking.Dot(normal);
    const JPH::Vec3 holding = sticking - pressing * normal;
    const float held = holding.Length();
    if (held <= contact.mCombinedFriction * pressing) {
        const JPH::Vec3 of_normal = mass.Multiply3x3(normal);
        const float linear = of_normal.Dot(along), square = of_normal.Dot(normal);
        const float left = velocity.Dot(mass.Multiply3x3(velocity)) - along.Dot(mass.Multiply3x3(along));
        bounded((std::sqrt(std::max(0.0f, linear * linear + square * left)) - linear) / (square * approach));
        return;
    }
    const JPH::Vec3 direction = normal + contact.mCombinedFriction / held * holding;
    const JPH::Vec3 moved = mobility.Multiply3x3(direction);
    bounded(-2.0f * direction.Dot(velocity) * normal.Dot(moved) / (approach * direction.Dot(moved)) - 1.0f);
}

void ContactRules::oppose_sliding(const JPH::Body& a, const JPH::Body& b,
                                  const JPH::ContactManifold& manifold, JPH::ContactSettings& contact) const {
    const JPH::Vec3 normal = manifold.mWorldSpaceNormal;
    const JPH::RVec3 point = manifold.mBaseOffset + 0.5f * (manifold.mRelativeContactPointsOn1[0] +
                                                            manifold.mRelativeContactPointsOn2[0]);
    Side on_a = side_of(a, point);
    Side on_b = side_of(b, point);
    const JPH::Vec3 on_chords = velocity_on_chords(a, b, normal, seconds_);
    const float slowest = slowest_sliding + 2.0f * on_chords.Length();
    const auto slides = [slowest](JPH::Vec3Arg sliding) { return sliding.LengthSq() >= slowest * slowest; };
    contact.mRelativeLinearSurfaceVelocity = on_chords;
    if (!slides(sliding_of(on_a, on_b, normal)))
        return;
    weigh(on_a, a, contact.mInvMassScale1, contact.mInvInertiaScale1, gravity_, seconds_);
    weigh(on_b, b, contact.mInvMassScale2, contact.mInvInertiaScale2, gravity_, seconds_);
    const JPH::Vec3 sliding = sliding_of(on_a, on_b, normal);
    if (!slides(sliding))
        return;
    // Jolt's own tangents.
    const JPH::Vec3 tangent1 = normal.GetNormalizedPerpendicular();
    const JPH::Vec3 tangent2 = normal.Cross(tangent1);
    const float mobility1 = on_a.mobility(tangent1) + on_b.mobility(tangent1);
    const float mobility2 = on_a.mobility(tangent2) + on_b.mobility(tangent2);
    const float most = std::max(mobility1, mobility2);
    if (most > 0.0f)
        contact.mRelativeLinearSurfaceVelocity =
            sliding.Dot(tangent1) * (1.0f - mobility1 / most) * tangent1 +
            sliding.Dot(tangent2) * (1.0f - mobility2 / most) * tangent2;
}

}  // namespace tactus
