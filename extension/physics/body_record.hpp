// What a body is besides Jolt's own body: private to physics/.
#pragma once

#include "physics/body_description.hpp"
#include "physics/jolt.hpp"

#include <Jolt/Physics/Body/Body.h>
#include <Jolt/Physics/Body/MassProperties.h>

namespace tactus {

struct BodyRecord {
    BodyRecord() = default;
    ~BodyRecord();
    BodyRecord(const BodyRecord&) = delete;
    BodyRecord& operator=(const BodyRecord&) = delete;

    JPH::Body* body = nullptr;            // ours to free; null while a world owns it
    JPH::Body* in_world = nullptr;        // the world's; null while in none
    bool may_be_dynamic = false;          // its shape and mass are those of a body that forces can move
    JPH::MassProperties mass_properties;  // in Jolt's units
    double mass = 0.0;                    // (unit: kilograms); 0 for what cannot move
    double linear_damping = 0.0;          // (unit: 1/seconds)
    double angular_damping = 0.0;         // (unit: 1/seconds)
    BodyFactors factors;
    bool can_sleep = true;  // while it is dynamic
    CollisionLayers collision;
    std::size_t layer_pair = 0;    // index in the world's CollisionTable
    bool tree_may_differ = false;  // waits in the world's TreeKeeper
};

}  // namespace tactus
