// How two surfaces combine, and contacts that only one of two bodies feels (body_description.hpp has the
// rules).
#pragma once

#include "physics/collision_layers.hpp"
#include "physics/jolt.hpp"
#include "physics/limits.hpp"

#include <Jolt/Physics/Body/Body.h>
#include <Jolt/Physics/Collision/ContactListener.h>

namespace tactus {

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

// Gives a body endless mass towards those that its mask does not hold. Asked for every contact in every step,
// so the world uses it only while some pair of bodies could need it.
class OneSidedContacts final : public JPH::ContactListener {
public:
    explicit OneSidedContacts(const CollisionTable& layers) : layers_(layers) {}

    void OnContactAdded(const JPH::Body& a, const JPH::Body& b, const JPH::ContactManifold&,
                        JPH::ContactSettings& contact) override {
        apply(a, b, contact);
    }
    void OnContactPersisted(const JPH::Body& a, const JPH::Body& b, const JPH::ContactManifold&,
                            JPH::ContactSettings& contact) override {
        apply(a, b, contact);
    }

private:
    void apply(const JPH::Body& a, const JPH::Body& b, JPH::ContactSettings& contact) const;

    const CollisionTable& layers_;
};

}  // namespace tactus
