#include "physics/sound_places.hpp"

#include <Jolt/Physics/Body/BodyInterface.h>
#include <Jolt/Physics/PhysicsSystem.h>

#include <cmath>

#include "physics/jolt_units.hpp"
#include "physics/limits.hpp"

namespace tactus {

// One comparison each, false for what is not a number.
bool SoundPlaces::is_sound(const JPH::Body& body) {
    constexpr double farthest = limits::farthest * units::jolt_per_meter;
    const JPH::RVec3 place = body.GetPosition();
    const bool has_place = std::abs(place.GetX()) <= farthest && std::abs(place.GetY()) <= farthest &&
                           std::abs(place.GetZ()) <= farthest;
    const float speed = body.GetLinearVelocity().LengthSq();
    const float spin = body.GetAngularVelocity().LengthSq();
    return has_place && std::isfinite(speed + spin) && body.GetRotation().IsNormalized();
}

void SoundPlaces::put_back(JPH::Body& body) const {
    const Place& place = places_[body.GetID().GetIndex()];
    JPH::BodyInterface& bodies = system_.GetBodyInterfaceNoLock();
    JPH::MotionProperties& motion = *body.GetMotionProperties();
    motion.SetLinearVelocity(JPH::Vec3::sZero());
    motion.SetAngularVelocity(JPH::Vec3::sZero());
    bodies.SetPositionAndRotation(body.GetID(), place.position, place.rotation,
                                  JPH::EActivation::DontActivate);
    bodies.InvalidateContactCache(body.GetID());
    bodies.DeactivateBody(body.GetID());
}

}  // namespace tactus
