// How much a closed mesh holds: what makes one from something else is held against that.
#pragma once

#include <glm/geometric.hpp>

#include "core/mesh/triangle_mesh.hpp"

namespace tactus::shared {

// What a closed mesh holds, positive where all its triangles run counter-clockwise seen from outside (unit:
// cubic meters).
inline double volume(const TriangleMesh& mesh) {
    double six = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        six += glm::dot(mesh.vertices[a], glm::cross(mesh.vertices[b], mesh.vertices[c]));
    }
    return six / 6.0;
}

}  // namespace tactus::shared
