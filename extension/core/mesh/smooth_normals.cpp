#include "core/mesh/smooth_normals.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <span>

#include "core/mesh/same_places.hpp"

namespace tactus {

namespace {

Vec3 unit_or_zero(const Vec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : Vec3(0.0);
}

double angle_between(const Vec3& u, const Vec3& v) {
    return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

// The triangles' corners by place: those at vertex v are corner[first[v]] … corner[first[v + 1] - 1].
struct CornersByPlace {
    struct Corner {
        std::uint32_t triangle, k;
    };
    std::vector<std::uint32_t> place;  // by vertex: the one that stands for all at its place
    std::vector<std::uint32_t> first;
    std::vector<Corner> corner;

    explicit CornersByPlace(const TriangleMesh& mesh)
        : place(same_places(mesh.vertices)),
          first(mesh.vertices.size() + 1),
          corner(3 * mesh.triangles.size()) {
        const auto visit = [&](auto&& visitor) {
            for (auto t = static_cast<std::uint32_t>(mesh.triangles.size()); t-- > 0;) {
                for (std::uint32_t k = 0; k < 3; ++k) {
                    visitor(place[mesh.triangles[t][k]], Corner{t, k});
                }
            }
        };
        visit([&](std::uint32_t v, Corner) { ++first[v]; });
        std::partial_sum(first.begin(), first.end(), first.begin());
        visit([&](std::uint32_t v, Corner one) { corner[--first[v]] = one; });  // each list from its end
    }
    std::span<const Corner> at(std::uint32_t vertex) const {
        const std::uint32_t v = place[vertex];
        return std::span(corner).subspan(first[v], first[v + 1] - first[v]);
    }
};

}  // namespace

std::vector<CornerNormals> smooth_normals(const TriangleMesh& mesh, double crease) {
    const CornersByPlace corners(mesh);
    std::vector<Vec3> facets(mesh.triangles.size());
    std::vector<std::array<double, 3>> angles(facets.size());  // of the facet at its corners (unit: radians)
    for (std::size_t t = 0; t < facets.size(); ++t) {
        const auto& triangle = mesh.triangles[t];
        const Vec3 p[3] = {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]],
                           mesh.vertices[triangle[2]]};
        facets[t] = unit_or_zero(glm::cross(p[1] - p[0], p[2] - p[0]));
        for (std::size_t k = 0; k < 3; ++k) {
            angles[t][k] = angle_between(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
        }
    }
    const double least_cosine = std::cos(crease);
    std::vector<CornerNormals> normals(facets.size());
    for (std::size_t t = 0; t < facets.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            Vec3 sum(0.0);
            for (const auto& [other, corner] : corners.at(mesh.triangles[t][k])) {
                const bool mixes = glm::dot(facets[other], facets[t]) >= least_cosine;
                sum += mixes ? facets[other] * angles[other][corner] : Vec3(0.0);
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
