#include "core/mesh/mesh_check.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// Beyond it doubles resolve less than a tenth of a micron (unit: meters).
constexpr double largest_coordinate = 1e9;
// Below it squares of areas leave the range of numbers (unit: meters).
constexpr double least_extent = 1e-9;

bool is_usable(const Vec3& v) {
    return std::abs(v.x) <= largest_coordinate && std::abs(v.y) <= largest_coordinate &&
           std::abs(v.z) <= largest_coordinate;  // false for NaN, too
}

}  // namespace

std::string check_mesh(const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) {
        return "the mesh has no triangles: give it at least one surface made of triangles";
    }
    if (mesh.triangles.size() > 0x2000'0000u || mesh.vertices.size() > 0xffff'ffffu) {
        return "the mesh has more than 536,870,912 triangles or 4,294,967,295 vertices: split it into "
               "several bodies";
    }
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        if (!is_usable(mesh.vertices[i])) {
            return "vertex " + std::to_string(i) +
                   " of the mesh is not a finite number within 1e9 m: repair it where the mesh is made, or "
                   "export it again";
        }
    }
    double largest_area = 0.0;
    Vec3 low(largest_coordinate);
    Vec3 high(-largest_coordinate);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        const std::size_t count = mesh.vertices.size();
        if (a >= count || b >= count || c >= count) {
            return "triangle " + std::to_string(i) +
                   " of the mesh names a vertex that does not exist: the mesh has " + std::to_string(count) +
                   " vertices; export it again";
        }
        const Vec3& origin = mesh.vertices[a];
        for (const std::uint32_t corner : mesh.triangles[i]) {
            low = glm::min(low, mesh.vertices[corner]);
            high = glm::max(high, mesh.vertices[corner]);
        }
        largest_area = std::max(
            largest_area, glm::length(glm::cross(mesh.vertices[b] - origin, mesh.vertices[c] - origin)));
    }
    const Vec3 size = high - low;
    if (std::max({size.x, size.y, size.z}) < least_extent) {
        return "the mesh is smaller than a millionth of a millimetre: check its unit and scale";
    }
    if (!(largest_area > 0.0)) {
        return "no triangle of the mesh has an area: check that it was not scaled to zero along an axis";
    }
    return {};
}

}  // namespace tactus
