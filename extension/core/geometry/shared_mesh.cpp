#include "core/geometry/shared_mesh.hpp"

#include "core/mesh/same_places.hpp"

namespace tactus {

void add_loose(TriangleMesh& mesh, const TriangleCorners& corners) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {corners.a, corners.b, corners.c});
    mesh.triangles.push_back({first, first + 1, first + 2});
}

SharedMesh::SharedMesh(const TriangleTree& tree) : rounding(0x1p-50 * tree.magnitude()) {
    for (std::uint32_t pack = 0; pack < tree.pack_count(); ++pack) {
        const PackIds& ids = tree.triangle_ids(pack);
        for (std::uint32_t lane = 0; lane < lane_count; ++lane) {
            if (lane == 0 || ids[lane] != ids[lane - 1]) {
                const std::uint32_t slot = pack * lane_count + lane;
                add_loose(mesh, tree.corners(slot));
                slots.push_back(slot);
            }
        }
    }
    const std::vector<std::uint32_t> places = same_places(mesh.vertices);
    begin.assign(mesh.vertices.size() + 1, 0);
    for (auto& triangle : mesh.triangles) {
        for (std::uint32_t& corner : triangle) {
            corner = places[corner];
            ++begin[corner + 1];
        }
    }
    for (std::size_t v = 1; v < begin.size(); ++v) {
        begin[v] += begin[v - 1];
    }
    around.resize(begin.back());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const std::uint32_t corner : mesh.triangles[t]) {
            around[next[corner]++] = t;
        }
    }
}

}  // namespace tactus
