#include "world/problem_of_place.hpp"

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// A frame scaled more than this is a mistake: single precision has seven digits for all of it.
constexpr double min_scale = 1e-6;
constexpr double max_scale = 1e6;

// As the physics has it (unit: meters).
constexpr double max_distance = 1e7;

}  // namespace

std::string problem_of_place(const Mat3& axes, const Vec3& origin) {
    const auto is_finite = [](const Vec3& v) { return std::isfinite(v.x + v.y + v.z); };
    if (!is_finite(axes[0]) || !is_finite(axes[1]) || !is_finite(axes[2]) || !is_finite(origin)) {
        return "its transform is not made of finite numbers: reset it in the inspector";
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double factor = glm::length(axes[axis]);
        if (!(factor >= min_scale && factor <= max_scale)) {
            char text[32];
            std::snprintf(text, sizeof(text), "%.4g", factor);
            return std::string("it is scaled by ") + text +
                   " along an axis, and that cannot be touched: scale it by something between 1e-6 and 1e6";
        }
    }
    const Vec3 far = glm::abs(origin);
    return std::fmax(far.x, std::fmax(far.y, far.z)) > max_distance
               ? "it stands farther from the origin than 10,000 km: move it nearer"
               : std::string();
}

}  // namespace tactus
