// What Jolt is told about the scale of things, in metres, and why.
#pragma once

#include "physics/jolt.hpp"
#include "physics/physics_world.hpp"

#include <Jolt/Physics/PhysicsSettings.h>

namespace tactus {

JPH::PhysicsSettings jolt_settings(const PhysicsSettings& settings);

}  // namespace tactus
