// A mesh that may be seen, made ready to be recognised.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sensing/discovery/mesh_field.hpp"

namespace tactus {

// As a library of meshes holds it.
struct LibraryMesh {
    std::string name;
    TriangleMesh mesh;
    double mass = 0.0;  // (unit: kilograms); 0: not known
};

// How the mesh may be turned, and what is then seen of it along -z: the look frame.
struct MeshAspect {
    Quat rotation{1.0, 0.0, 0.0, 0.0};  // mesh's frame to look frame
    Vec3 seen{0.0};  // mean of the visible surface, in the look frame, off the mesh's origin
};

struct LearntMesh {
    std::string name;
    TriangleMesh mesh;
    std::vector<Vec3> normals;  // by triangle, unit or zero; whichever way round
    double mass = 0.0;
    Vec3 center{0.0};     // of its bounding box, in its own frame
    double radius = 0.0;  // of the ball around that (unit: meters)
    MeshField field;
    std::vector<MeshAspect> aspects;
};

struct LearningSettings {
    double cell = 0.003;   // of the field (unit: meters), > 0
    double margin = 0.03;  // of the field around the mesh (unit: meters), > 0
    int rotations = 600;   // evenly spread over all, > 0
    double alike = 0.004;  // of two views whose surfaces differ by less, one is left out (unit: meters)
};

// Rotations that are evenly spread over all there are: a super-Fibonacci spiral (Alexa 2022).
std::vector<Quat> even_rotations(int count);

LearntMesh learn_mesh(const LibraryMesh& mesh, const LearningSettings& settings,
                      const ParallelRunner& run = run_serially);

// Empty where a mesh can be recognised; else what is wrong with it and what to do: see check_mesh, and what
// is smaller than a camera can tell, or larger than fits into a field.
std::string check_library_mesh(const LibraryMesh& mesh, const LearningSettings& settings);

}  // namespace tactus
