// Meshes of all kinds for tests of the triangle tree.
#pragma once

#include <algorithm>
#include <vector>

#include "core/tree/triangle_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"

namespace tactus::shared {

struct TreeSample {
    const char* name;
    TriangleMesh mesh;
};

inline TriangleMesh put_off(TriangleMesh mesh, const Vec3& by) {
    for (Vec3& v : mesh.vertices) {
        v += by;
    }
    return mesh;
}

inline TriangleMesh slivers(int count, unsigned seed) {
    RandomValues random(seed);
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        const Vec3 a = random.in_ball(1.0);
        const Vec3 b = random.in_ball(1.0);
        mesh.vertices.insert(
            mesh.vertices.end(),
            {a, b, a + (b - a) * random.unit() + random.in_ball(random.magnitude(1e-17, 1e-2))});
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

inline std::vector<TreeSample> tree_samples() {
    return {{"one triangle", {{Vec3(0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0)}, {{0, 1, 2}}}},
            {"box", box(Vec3(0.5, 1.0, 0.2))},
            {"sphere", icosphere(3, 1.0)},
            {"soup", soup(700, 1.0, 5)},
            {"slivers", slivers(500, 6)},
            {"same triangle 100 times",
             [] {
                 TriangleMesh mesh{{Vec3(0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0)}, {}};
                 mesh.triangles.assign(100, {0, 1, 2});
                 return mesh;
             }()},
            {"far from origin", put_off(icosphere(3, 1.0), Vec3(1e4, -2e4, 3e4))}};
}

struct Extent {
    Vec3 center;
    double radius;
};

inline Extent extent_of(const TriangleMesh& mesh) {
    Vec3 low(1e300);
    Vec3 high(-1e300);
    for (const Vec3& v : mesh.vertices) {
        low = glm::min(low, v);
        high = glm::max(high, v);
    }
    return {0.5 * (low + high), 0.5 * glm::length(high - low)};
}

// Of the distance to a triangle (unit: meters).
inline double rounding(const TriangleTree& tree) {
    return 1e-14 * std::max(1.0, tree.magnitude());
}

}  // namespace tactus::shared
