// Where each body was before the step, for the case that a step takes it out of the range of numbers: private
// to physics/.
//
// Limits (limits.hpp) keep single values in range; a joint that is torn kilometres apart, or a mass that a
// lever makes small enough, can still overflow single precision inside a step. What is not a number then
// would reach everything that touches it. So a body that a step has lost, or carried beyond the last place,
// goes back to where it was, at rest and asleep.
#pragma once

#include <vector>

#include "physics/jolt.hpp"

#include <Jolt/Physics/Body/Body.h>

namespace JPH {
class PhysicsSystem;
}

namespace tactus {

class SoundPlaces {
public:
    SoundPlaces(JPH::PhysicsSystem& system, std::size_t max_bodies) : system_(system), places_(max_bodies) {}

    // The body is about to be moved.
    void keep(const JPH::Body& body) {
        places_[body.GetID().GetIndex()] = {body.GetPosition(), body.GetRotation()};
    }

    static bool is_sound(const JPH::Body& body);
    void put_back(JPH::Body& body) const;

private:
    struct Place {
        JPH::RVec3 position = JPH::RVec3::sZero();
        JPH::Quat rotation = JPH::Quat::sIdentity();
    };

    JPH::PhysicsSystem& system_;
    std::vector<Place> places_;  // by the body's index
};

}  // namespace tactus
