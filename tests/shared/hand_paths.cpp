#include "shared/hand_paths.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tactus::shared {

namespace {

constexpr double turn = 2.0 * std::numbers::pi;

// On a circle that lies askew to the axes, so that no symmetry of the mesh helps or hurts.
Vec3 around(double seconds) {
    static const Vec3 first = glm::normalize(Vec3(0.62, 0.31, 0.72));
    static const Vec3 second = glm::normalize(glm::cross(first, Vec3(0.23, 0.95, -0.11)));
    const double angle = turn * seconds / 10.0;
    return std::cos(angle) * first + std::sin(angle) * second;
}

double in_and_out(double seconds) {
    return 0.1 * std::sin(turn * 0.7 * seconds);
}

}  // namespace

std::vector<Vec3> around_sphere(double radius, int ticks) {
    std::vector<Vec3> way;
    for (int i = 0; i < ticks; ++i) {
        const double t = 1e-3 * i;
        way.push_back(around(t) * (1.0 + radius - in_and_out(t)));
    }
    return way;
}

std::vector<Vec3> around_box(const Vec3& half_extents, double radius, int ticks) {
    std::vector<Vec3> way;
    for (int i = 0; i < ticks; ++i) {
        const double t = 1e-3 * i;
        const Vec3 direction = around(t);
        const Vec3 share = glm::abs(direction) / half_extents;
        const double surface = 1.0 / std::max({share.x, share.y, share.z});
        way.push_back(direction * (surface + radius - in_and_out(t)));
    }
    return way;
}

std::vector<Vec3> over_terrain(const TriangleMesh& terrain, int cells, double size, double radius,
                               int ticks) {
    const auto height = [&](double x, double z) {
        const double u = std::clamp((x / size + 0.5) * cells, 0.0, cells - 1e-9);
        const double v = std::clamp((z / size + 0.5) * cells, 0.0, cells - 1e-9);
        const auto column = static_cast<std::size_t>(u);
        const auto row = static_cast<std::size_t>(v);
        const double s = u - static_cast<double>(column);
        const double t = v - static_cast<double>(row);
        const std::size_t side = static_cast<std::size_t>(cells) + 1;
        const auto at = [&](std::size_t c, std::size_t r) { return terrain.vertices[r * side + c].y; };
        return (1.0 - t) * ((1.0 - s) * at(column, row) + s * at(column + 1, row)) +
               t * ((1.0 - s) * at(column, row + 1) + s * at(column + 1, row + 1));
    };
    std::vector<Vec3> way;
    for (int i = 0; i < ticks; ++i) {
        const double t = 1e-3 * i;
        const double x = 0.41 * size * std::sin(turn * t / 17.0);
        const double z = 0.41 * size * std::cos(turn * t / 13.0);
        const double depth = 0.04 - 0.06 * std::sin(turn * 0.7 * t);
        way.push_back({x, height(x, z) + radius - depth, z});
    }
    return way;
}

}  // namespace tactus::shared
