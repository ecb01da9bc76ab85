// One sphere cast of Jolt against a mesh, behind plain functions: so that a second Jolt, built otherwise, can
// be loaded beside the one that is linked.
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {

struct TactusJoltCast {
    // Coordinates x, y, z of each corner and three corners a triangle; null where Jolt refuses the mesh.
    void* (*make)(const float* coordinates, std::size_t corners, const std::uint32_t* indices,
                  std::size_t triangles, float radius);
    void (*cast)(const void* made, const float* from, const float* motion);
    void (*drop)(void* made);
};

__attribute__((visibility("default"))) const TactusJoltCast* tactus_jolt_cast();

}  // extern "C"
