#include "core/geometry/smooth_normals.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <unordered_map>

namespace tactus {

namespace {

struct SamePlace {
    bool operator()(const Vec3& p, const Vec3& q) const { return p == q; }
};

struct PlaceHash {
    std::size_t operator()(const Vec3& p) const {
        std::uint64_t hash = 0x9e3779b97f4a7c15ull;
        for (int axis = 0; axis < 3; ++axis) {
            const double coordinate = p[axis] + 0.0;  // -0 and 0 are one place
            std::uint64_t bits;
            std::memcpy(&bits, &coordinate, sizeof bits);
            hash = (hash ^ bits) * 0xff51afd7ed558ccdull;
            hash ^= hash >> 32;
        }
        return hash;
    }
};

struct Corner {
    std::uint32_t triangle;
    double angle;  // of the facet at the corner (unit: radians)
};

Vec3 unit_or_zero(const Vec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : Vec3(0.0);
}

double angle_between(const Vec3& u, const Vec3& v) {
    return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

}  // namespace

std::vector<CornerNormals> smooth_normals(const TriangleMesh& mesh, double crease) {
    std::vector<Vec3> facets(mesh.triangles.size());
    std::unordered_map<Vec3, std::vector<Corner>, PlaceHash, SamePlace> corners_at;
    for (std::size_t t = 0; t < facets.size(); ++t) {
        const auto& triangle = mesh.triangles[t];
        const Vec3 p[3] = {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]],
                           mesh.vertices[triangle[2]]};
        facets[t] = unit_or_zero(glm::cross(p[1] - p[0], p[2] - p[0]));
        for (int k = 0; k < 3; ++k) {
            const double angle = angle_between(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
            corners_at[p[k]].push_back({static_cast<std::uint32_t>(t), angle});
        }
    }
    const double least_cosine = std::cos(crease);
    std::vector<CornerNormals> normals(facets.size());
    for (std::size_t t = 0; t < facets.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            Vec3 sum(0.0);
            for (const Corner& corner : corners_at[mesh.vertices[mesh.triangles[t][k]]]) {
                const bool mixes = glm::dot(facets[corner.triangle], facets[t]) >= least_cosine;
                sum += mixes ? facets[corner.triangle] * corner.angle : Vec3(0.0);
            }
            const Vec3 mean = unit_or_zero(sum);
            normals[t][k] = glm::vec3(mean == Vec3(0.0) ? facets[t] : mean);
        }
    }
    return normals;
}

Vec3 interpolated_normal(const CornerNormals& normals, const Vec3& a, const Vec3& b, const Vec3& c,
                         const Vec3& point, const Vec3& otherwise) {
    const Vec3 facet = glm::cross(b - a, c - a);
    const double at_a = glm::dot(facet, glm::cross(c - b, point - b));
    const double at_b = glm::dot(facet, glm::cross(a - c, point - c));
    const double at_c = glm::dot(facet, glm::cross(b - a, point - a));
    const Vec3 sum = at_a * Vec3(normals[0]) + at_b * Vec3(normals[1]) + at_c * Vec3(normals[2]);
    const double length = glm::length(sum);
    if (!(length > 0.0)) {
        return otherwise;
    }
    // Meshes are touched from both sides: the normal that looks to where the sphere is.
    return glm::dot(sum, otherwise) < 0.0 ? -sum / length : sum / length;
}

}  // namespace tactus
