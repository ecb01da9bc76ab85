// What Jolt needs once per process.
#pragma once

#include "physics/jolt.hpp"

namespace JPH {
class BodyManager;
}

namespace tactus {

// Called before anything else of Jolt; any thread, never in the loop.
void start_jolt();

// Makes and unmakes bodies that belong to no world yet. Only its const functions are used, from any thread.
const JPH::BodyManager& body_factory();

}  // namespace tactus
