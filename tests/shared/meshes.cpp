#include "shared/meshes.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "shared/random_values.hpp"

namespace tactus::shared {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

class Midpoints {
public:
    Midpoints(TriangleMesh& mesh, double radius) : mesh_(mesh), radius_(radius) {}

    std::uint32_t between(std::uint32_t a, std::uint32_t b) {
        const std::pair<std::uint32_t, std::uint32_t> key = std::minmax(a, b);
        const auto [place, added] =
            known_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
        if (added) {
            mesh_.vertices.push_back(radius_ * glm::normalize(mesh_.vertices[a] + mesh_.vertices[b]));
        }
        return place->second;
    }

private:
    TriangleMesh& mesh_;
    double radius_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known_;
};

}  // namespace

TriangleMesh icosphere(int levels, double radius) {
    const double t = (1.0 + std::sqrt(5.0)) / 2.0;
    TriangleMesh mesh;
    for (const Vec3& v :
         {Vec3(-1, t, 0), Vec3(1, t, 0), Vec3(-1, -t, 0), Vec3(1, -t, 0), Vec3(0, -1, t), Vec3(0, 1, t),
          Vec3(0, -1, -t), Vec3(0, 1, -t), Vec3(t, 0, -1), Vec3(t, 0, 1), Vec3(-t, 0, -1), Vec3(-t, 0, 1)}) {
        mesh.vertices.push_back(radius * glm::normalize(v));
    }
    mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (int level = 0; level < levels; ++level) {
        Midpoints midpoints(mesh, radius);
        std::vector<Triangle> finer;
        finer.reserve(mesh.triangles.size() * 4);
        for (const auto& [a, b, c] : mesh.triangles) {
            const std::uint32_t ab = midpoints.between(a, b);
            const std::uint32_t bc = midpoints.between(b, c);
            const std::uint32_t ca = midpoints.between(c, a);
            finer.insert(finer.end(), {Triangle{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    return mesh;
}

TriangleMesh rough_sphere(int levels, double radius, double share) {
    TriangleMesh mesh = icosphere(levels, 1.0);
    RandomValues random(7);
    const double edge = 1.1 / (1 << levels);
    for (Vec3& v : mesh.vertices) {
        v *= radius * (1.0 + share * edge * random.between(-1.0, 1.0));
    }
    return mesh;
}

TriangleMesh box(const Vec3& half) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.vertices.push_back(half * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

TriangleMesh grid_box(const Vec3& half, int cells) {
    TriangleMesh mesh;
    const int side = cells + 1;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1.0, 1.0}) {
            const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
            for (int i = 0; i < side * side; ++i) {
                Vec3 place(0.0);
                place[axis] = sign * half[axis];
                place[(axis + 1) % 3] = half[(axis + 1) % 3] * (2.0 * (i % side) / cells - 1.0);
                place[(axis + 2) % 3] = half[(axis + 2) % 3] * (2.0 * (i / side) / cells - 1.0);
                mesh.vertices.push_back(place);
            }
            for (int i = 0; i < cells * cells; ++i) {
                const auto a = first + static_cast<std::uint32_t>(i / cells * side + i % cells);
                const std::uint32_t b = a + 1, c = a + static_cast<std::uint32_t>(side), d = c + 1;
                const bool turned = sign < 0.0;
                mesh.triangles.push_back(turned ? std::array{a, c, b} : std::array{a, b, c});
                mesh.triangles.push_back(turned ? std::array{b, c, d} : std::array{b, d, c});
            }
        }
    }
    return mesh;
}

TriangleMesh terrain(int cells, double size, double height) {
    TriangleMesh mesh;
    const int side = cells + 1;
    for (int z = 0; z < side; ++z) {
        for (int x = 0; x < side; ++x) {
            const double u = static_cast<double>(x) / cells;
            const double v = static_cast<double>(z) / cells;
            const double hills =
                std::sin(9.0 * u + 1.0) * std::cos(7.0 * v) + 0.4 * std::sin(23.0 * u * v + 5.0 * v);
            const double ripples = 0.05 * std::sin(160.0 * u) * std::sin(140.0 * v + 3.0 * u);
            mesh.vertices.push_back({(u - 0.5) * size, height * (hills + ripples), (v - 0.5) * size});
        }
    }
    for (int z = 0; z < cells; ++z) {
        for (int x = 0; x < cells; ++x) {
            const auto corner = static_cast<std::uint32_t>(z * side + x);
            const auto row = static_cast<std::uint32_t>(side);
            mesh.triangles.push_back({corner, corner + row, corner + 1});
            mesh.triangles.push_back({corner + 1, corner + row, corner + row + 1});
        }
    }
    return mesh;
}

TriangleMesh groove(double angle, double length) {
    TriangleMesh mesh;
    const double lean = 0.5 * angle;
    const Vec3 left(-std::sin(lean), std::cos(lean), 0.0);
    const Vec3 right(std::sin(lean), std::cos(lean), 0.0);
    const Vec3 along(0.0, 0.0, 0.5 * length);
    mesh.vertices = {-along,
                     along,
                     length * left - along,
                     length * left + along,
                     length * right - along,
                     length * right + along};
    mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {0, 4, 1}, {1, 4, 5}};
    return mesh;
}

TriangleMesh cone(std::uint32_t sides, double height) {
    TriangleMesh mesh;
    mesh.vertices.push_back(Vec3(0.0));
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / sides;
        mesh.vertices.push_back({std::cos(angle), -height, std::sin(angle)});
        mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % sides});
    }
    return mesh;
}

TriangleMesh bore(int count, double radius, double half_length) {
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        for (const double y : {-half_length, half_length}) {
            mesh.vertices.push_back({radius * std::cos(angle), y, radius * std::sin(angle)});
        }
    }
    const auto corners = static_cast<std::uint32_t>(2 * count);
    for (std::uint32_t i = 0; i < corners; i += 2) {
        const std::uint32_t next = (i + 2) % corners;
        mesh.triangles.push_back({i, i + 1, next});
        mesh.triangles.push_back({next, i + 1, next + 1});
    }
    return mesh;
}

TriangleMesh funnel(int count, double unevenness) {
    std::mt19937 random(static_cast<unsigned>(count));
    std::uniform_real_distribution<double> spread(-0.5, 0.5);
    std::vector<double> angles;
    for (int i = 0; i < count; ++i) {
        angles.push_back(2.0 * std::numbers::pi * (i + unevenness * spread(random)) / count);
    }
    TriangleMesh mesh;
    for (const auto& [radius, height] : {std::pair(0.5, 0.5), {0.05, -0.1}, {0.0499, -0.5}}) {
        for (const double angle : angles) {
            mesh.vertices.push_back({radius * std::cos(angle), height + 1e-3 * unevenness * spread(random),
                                     radius * std::sin(angle)});
        }
    }
    const auto side = static_cast<std::uint32_t>(count);
    for (std::uint32_t ring = 0; ring < 2 * side; ring += side) {
        for (std::uint32_t i = 0; i < side; ++i) {
            const std::uint32_t a = ring + i;
            const std::uint32_t b = ring + (i + 1) % side;
            mesh.triangles.push_back({a, b, a + side});
            mesh.triangles.push_back({b, b + side, a + side});
        }
    }
    return mesh;
}

TriangleMesh soup(int count, double radius, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> spread(-1.0, 1.0);
    const auto in_ball = [&] {
        Vec3 p;
        do {
            p = {spread(random), spread(random), spread(random)};
        } while (glm::length(p) > 1.0);
        return radius * p;
    };
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        const Vec3 center = in_ball();
        for (int k = 0; k < 3; ++k) {
            mesh.vertices.push_back(center + 0.4 * in_ball());
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

// In a way that no compiler takes for nothing.
TriangleMesh in_single_precision(TriangleMesh mesh) {
    for (Vec3& vertex : mesh.vertices) {
        for (int axis = 0; axis < 3; ++axis) {
            const volatile auto rounded = static_cast<float>(vertex[axis]);
            vertex[axis] = rounded;
        }
    }
    return mesh;
}

}  // namespace tactus::shared
