// How two surfaces combine, and contacts that only one of two bodies feels (body_description.hpp has the
// rules).
#pragma once

#include "physics/collision_layers.hpp"
#include "physics/jolt.hpp"
#include "physics/limits.hpp"

#include <Jolt/Physics/Body/Body.h>
#include <Jolt/Physics/Collision/ContactListener.h>

#include <vector>

namespace tactus {

struct BodyRecord;

// Jolt keeps one number for each; a negative one stands for rough or absorbent, as inside Godot.
inline float stored_friction(const SurfaceMaterial& material) {
    const double friction = std::min(material.friction, limits::max_friction);
    return static_cast<float>(material.rough ? -friction : friction);
}
inline float stored_restitution(const SurfaceMaterial& material) {
    const double restitution = std::min(material.restitution, 1.0);
    return static_cast<float>(material.absorbent ? -restitution : restitution);
}

float combined_friction(const JPH::Body& a, const JPH::SubShapeID&, const JPH::Body& b,
                        const JPH::SubShapeID&);
float combined_restitution(const JPH::Body& a, const JPH::SubShapeID&, const JPH::Body& b,
                           const JPH::SubShapeID&);

// What a contact of one point (contact_points.hpp) is told before Jolt solves it.
//
// A body has endless mass towards those that its mask does not hold.
//
// Friction acts against the velocity of the point. Jolt finds it along two tangents, each by the mass K_i^-1
// that the bodies have there along it, and cuts the sum to mu N. A point off the center of mass has different
// masses along the two, which turns the friction of a sliding one by up to 20 degrees. So each tangent is
// given as its goal not rest but u_i (1 - K_i / max K), u being the point's velocity before the forces of the
// step: then both impulses, (u_i - goal_i) / K_i, have the ratio of u. At rest u = 0 and so is the goal.
//
// A bounce gives no energy. Restitution e reverses the speed u_n = -v of the point along the normal, and
// friction brings it to its goal g along the surface. With the mass M of the point, a matrix, the bodies have
// u . M u / 2 before, and u' . M u' / 2 with u' = g + e v n after, which may be more where M is not diagonal
// (Kane 1984). Where the point goes on sliding, the impulse is P d, d = n - mu t, and takes energy as long as
// P <= -2 d . u / (d . W d), W = M^-1. So e is no larger than that of these bounds that holds.
//
// Bodies that turn together, as a box on a turntable, go straight on within a step, and would leave their
// circles by w^2 dt r / 2 a second, r being the way from the center of mass of one to that of the other. So
// friction that holds them is given as its goal not rest but the difference of the velocities along their
// chords, w^2 dt r / 2 towards each other. When the next step begins they are off it by twice as much.
//
// What a heavy body presses through light ones takes more iterations of the solver, for all that is linked to
// them: four times the square root of the ratio of two masses.
class ContactRules final : public JPH::ContactListener {
public:
    // `records` is by the body's index.
    ContactRules(const CollisionTable& layers, const std::vector<BodyRecord*>& records)
        : layers_(layers), records_(records) {}

    // Of the next step (units: Jolt's, seconds).
    void begin_step(JPH::Vec3Arg gravity, float seconds) {
        gravity_ = gravity;
        seconds_ = seconds;
    }

    void OnContactAdded(const JPH::Body& a, const JPH::Body& b, const JPH::ContactManifold& manifold,
                        JPH::ContactSettings& contact) override {
        apply(a, b, manifold, contact);
    }
    void OnContactPersisted(const JPH::Body& a, const JPH::Body& b, const JPH::ContactManifold& manifold,
                            JPH::ContactSettings& contact) override {
        apply(a, b, manifold, contact);
    }

private:
    void apply(const JPH::Body& a, const JPH::Body& b, const JPH::ContactManifold& manifold,
               JPH::ContactSettings& contact) const;
    void push_one_sidedly(const JPH::Body& a, const JPH::Body& b, JPH::ContactSettings& contact) const;
    void take_pains(const JPH::Body& a, const JPH::Body& b) const;
    void bound_bounce(const JPH::Body& a, const JPH::Body& b, const JPH::ContactManifold& manifold,
                      JPH::ContactSettings& contact) const;
    void oppose_sliding(const JPH::Body& a, const JPH::Body& b, const JPH::ContactManifold& manifold,
                        JPH::ContactSettings& contact) const;

    const CollisionTable& layers_;
    const std::vector<BodyRecord*>& records_;
    JPH::Vec3 gravity_ = JPH::Vec3::sZero();
    float seconds_ = 0.0f;
};

}  // namespace tactus
