// The triangles of a tree as a mesh whose corners are shared wherever they are at the same place.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"
#include "core/tree/triangle_tree.hpp"

namespace tactus {

// A triangle with corners of its own.
void add_loose(TriangleMesh& mesh, const TriangleCorners& corners);

// Of no length where the vector has none.
inline Vec3 unit(const Vec3& v) {
    return v / std::max(glm::length(v), 1e-300);
}

// In the tree's order, so that neighbours mostly follow each other.
struct SharedMesh {
    TriangleMesh mesh;                  // an index is that of the first vertex at its place
    std::vector<std::uint32_t> slots;   // of the tree, by triangle
    std::vector<std::uint32_t> around;  // triangles at each place, one place after the other
    std::vector<std::uint32_t> begin;   // where those of a place begin, by vertex; and the end
    double rounding = 0.0;              // of a difference of two corners (unit: meters)

    explicit SharedMesh(const TriangleTree& tree);

    const Vec3& place(std::uint32_t vertex) const { return mesh.vertices[vertex]; }
    std::span<const std::uint32_t> triangles_at(std::uint32_t vertex) const {
        return std::span(around).subspan(begin[vertex], begin[vertex + 1] - begin[vertex]);
    }
};

}  // namespace tactus
