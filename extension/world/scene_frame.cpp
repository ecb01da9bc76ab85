#include "world/scene_frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace tactus {

namespace {

// A frame scaled more than this is a mistake: single precision has seven digits for all of it.
constexpr double min_scale = 1e-6;
constexpr double max_scale = 1e6;

// As the physics has it (unit: meters).
constexpr double max_distance = 1e7;

// Of a unit cube that is scaled so: single precision cannot tell it from zero.
constexpr double no_volume = 1e-36;

// Of an entry of a scaling, relative where it is large: many times what single precision rounds.
constexpr double rounding = 1e-5;

// Relative, of what a body was made with. A hundred thousand small rotations come to about so much; of a body
// of a meter it is a millimeter.
constexpr double most_drift = 1e-3;

constexpr const char* not_finite = "its transform is not made of finite numbers: reset it in the inspector";

bool is_finite(const SceneFrame& frame) {
    const auto finite = [](const Vec3& v) { return std::isfinite(v.x + v.y + v.z); };
    return finite(frame.axes[0]) && finite(frame.axes[1]) && finite(frame.axes[2]) && finite(frame.origin);
}

bool is_within(double share, const Mat3& a, const Mat3& b) {
    for (int column = 0; column < 3; ++column) {
        const double size = std::max(1.0, glm::length(a[column]));
        if (!(glm::distance(a[column], b[column]) <= share * size)) {
            return false;
        }
    }
    return true;
}

Vec3 unit(const Vec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : v;
}

// Gram and Schmidt, the x axis first; a left-handed frame is mirrored at its origin.
Mat3 rotation_of(const Mat3& axes) {
    const Vec3 x = unit(axes[0]);
    const Vec3 y = unit(axes[1] - glm::dot(axes[1], x) * x);
    const Vec3 z = unit(axes[2] - glm::dot(axes[2], x) * x - glm::dot(axes[2], y) * y);
    const Mat3 turned(x, y, z);
    return glm::determinant(turned) < 0.0 ? -turned : turned;
}

}  // namespace

Pose pose_of(const SceneFrame& frame) {
    return {frame.origin, glm::normalize(glm::quat_cast(rotation_of(frame.axes)))};
}

Mat3 scaling_of(const SceneFrame& frame) {
    const Mat3 scaling = glm::transpose(rotation_of(frame.axes)) * frame.axes;
    return same_scaling(scaling, Mat3(1.0)) ? Mat3(1.0) : scaling;
}

bool same_scaling(const Mat3& a, const Mat3& b) {
    return is_within(rounding, a, b);
}

bool has_only_drifted(const Mat3& made, const Mat3& before, const Mat3& now) {
    return is_within(rounding, before, now) && is_within(most_drift, made, now);
}

double mean_scale(const SceneFrame& frame) {
    return std::cbrt(std::abs(glm::determinant(frame.axes)));
}

bool is_even(const SceneFrame& frame) {
    constexpr double differ = 1e-3;
    const double x = glm::length(frame.axes[0]);
    return std::abs(glm::length(frame.axes[1]) - x) <= differ * x &&
           std::abs(glm::length(frame.axes[2]) - x) <= differ * x;
}

std::string problem_of_place(const SceneFrame& frame) {
    if (!is_finite(frame)) {
        return not_finite;
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double factor = glm::length(frame.axes[axis]);
        if (!(factor >= min_scale && factor <= max_scale)) {
            char text[32];
            std::snprintf(text, sizeof(text), "%.4g", factor);
            return std::string("it is scaled by ") + text +
                   " along an axis, and that cannot be touched: scale it by something between 1e-6 and 1e6";
        }
    }
    const Vec3 far = glm::abs(frame.origin);
    return std::max({far.x, far.y, far.z}) > max_distance
               ? "it stands farther from the origin than 10,000 km: move it nearer"
               : std::string();
}

std::string problem_of_shape_frame(const SceneFrame& frame) {
    if (!is_finite(frame)) {
        return not_finite;
    }
    return std::abs(glm::determinant(frame.axes)) < no_volume
               ? "it is scaled to zero along an axis: give it a scale that is not zero"
               : std::string();
}

}  // namespace tactus
