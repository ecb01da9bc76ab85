#include "physics/contact_rules.hpp"

#include <algorithm>
#include <cmath>

#include "physics/body_record.hpp"

namespace tactus {

namespace {

// The world that holds a body has its record in the body's user data.
float learnt_friction(const JPH::Body& body) {
    return static_cast<float>(reinterpret_cast<const BodyRecord*>(body.GetUserData())->factors.friction);
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

void OneSidedContacts::apply(const JPH::Body& a, const JPH::Body& b, JPH::ContactSettings& contact) const {
    if (!layers_.notices(a.GetObjectLayer(), b.GetObjectLayer())) {
        contact.mInvMassScale1 = 0.0f;
        contact.mInvInertiaScale1 = 0.0f;
    }
    if (!layers_.notices(b.GetObjectLayer(), a.GetObjectLayer())) {
        contact.mInvMassScale2 = 0.0f;
        contact.mInvInertiaScale2 = 0.0f;
    }
}

}  // namespace tactus
