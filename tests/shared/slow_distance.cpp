#include "shared/slow_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::shared {

namespace {

void consider(const SlowVec3& point, const std::array<SlowVec3, 3>& corners,
              std::array<long double, 3> weights, SlowClosest& best) {
    long double sum = 0.0L;
    for (long double& w : weights) {
        w = std::clamp(w, 0.0L, 1.0L);
        sum += w;
    }
    // Weighted offsets instead of weighted points: nothing large cancels.
    SlowVec3 offset(0.0L);
    int supports = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        offset += (weights[i] / sum) * (point - corners[i]);
        supports += weights[i] > 0.0L;
    }
    const long double distance = glm::length(offset);
    if (distance < best.distance) {
        SlowVec3 edge(0.0L);
        if (supports == 2) {
            const std::size_t missing = weights[0] == 0.0L ? 0 : (weights[1] == 0.0L ? 1 : 2);
            edge = corners[(missing + 2) % 3] - corners[(missing + 1) % 3];
            edge /= glm::length(edge);
        }
        best = {point - offset, distance, supports, edge};
    }
}

}  // namespace

SlowClosest slow_closest(const SlowVec3& point, const Corners& triangle) {
    const std::array<SlowVec3, 3> corners{SlowVec3(triangle[0]), SlowVec3(triangle[1]),
                                          SlowVec3(triangle[2])};
    SlowClosest best;
    best.distance = std::numeric_limits<long double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        std::array<long double, 3> only{};
        only[i] = 1.0L;
        consider(point, corners, only, best);
        const std::size_t j = (i + 1) % 3;
        const SlowVec3 edge = corners[j] - corners[i];
        const long double squared = glm::dot(edge, edge);
        if (squared > 0.0L) {
            std::array<long double, 3> both{};
            both[j] = glm::dot(point - corners[i], edge) / squared;
            both[i] = 1.0L - both[j];
            consider(point, corners, both, best);
        }
    }
    // Face: coordinates along the longest edge and across it.
    std::size_t first = 0;
    for (std::size_t i = 1; i < 3; ++i) {
        if (glm::length(corners[(i + 1) % 3] - corners[i]) >
            glm::length(corners[(first + 1) % 3] - corners[first])) {
            first = i;
        }
    }
    const std::size_t second = (first + 1) % 3;
    const std::size_t third = (first + 2) % 3;
    const SlowVec3 base = corners[second] - corners[first];
    const long double base_length = glm::length(base);
    if (base_length > 0.0L) {
        const SlowVec3 along = base / base_length;
        const SlowVec3 side = corners[third] - corners[first];
        const long double side_along = glm::dot(side, along);
        SlowVec3 across = side - along * side_along;
        const long double height = glm::length(across);
        if (height > 0.0L) {
            across /= height;
            const SlowVec3 p = point - corners[first];
            std::array<long double, 3> weights{};
            weights[third] = glm::dot(p, across) / height;
            weights[second] = (glm::dot(p, along) - weights[third] * side_along) / base_length;
            weights[first] = 1.0L - weights[second] - weights[third];
            if (weights[0] > 0.0L && weights[1] > 0.0L && weights[2] > 0.0L) {
                consider(point, corners, weights, best);
            }
        }
    }
    return best;
}

long double slow_distance(const Vec3& point, const TriangleMesh& mesh) {
    long double nearest = std::numeric_limits<long double>::infinity();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Corners corners = corners_of(mesh, i);
        // No point of a triangle is farther from its first corner than the longer of the two edges there.
        const double size =
            std::max(glm::distance(corners[0], corners[1]), glm::distance(corners[0], corners[2]));
        const double at_least = glm::distance(point, corners[0]) - size;
        if (at_least <= static_cast<double>(nearest) * (1.0 + 1e-9)) {
            nearest = std::min(nearest, slow_distance(point, corners));
        }
    }
    return nearest;
}

long double slow_sweep(const Vec3& start, const Vec3& motion, long double distance, const Corners& triangle) {
    const auto gap = [&](long double t) {
        return slow_closest(SlowVec3(start) + t * SlowVec3(motion), triangle).distance - distance;
    };
    if (gap(0.0L) <= 0.0L) {
        return gap(1e-9L) < gap(0.0L) ? 0.0L : 2.0L;
    }
    long double low = 0.0L;
    long double high = 1.0L;
    for (int i = 0; i < 100; ++i) {  // a third less each time: 2e-18 of the way in the end
        const long double third = (high - low) / 3.0L;
        if (gap(low + third) < gap(high - third)) {
            high -= third;
        } else {
            low += third;
        }
    }
    const long double deepest = 0.5L * (low + high);
    long double inside = gap(1.0L) < gap(deepest) ? 1.0L : deepest;
    if (gap(inside) > 0.0L) {
        return 2.0L;
    }
    long double outside = 0.0L;
    for (int i = 0; i < 64; ++i) {
        const long double middle = 0.5L * (outside + inside);
        (gap(middle) > 0.0L ? outside : inside) = middle;
    }
    return inside;
}

long double slow_sweep(const Vec3& start, const Vec3& motion, long double distance,
                       const TriangleMesh& mesh) {
    long double first = 2.0L;
    const double squared = glm::dot(motion, motion);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Corners corners = corners_of(mesh, i);
        const double size =
            std::max(glm::distance(corners[0], corners[1]), glm::distance(corners[0], corners[2]));
        const double along =
            squared > 0.0 ? std::clamp(glm::dot(corners[0] - start, motion) / squared, 0.0, 1.0) : 0.0;
        const double at_least = glm::distance(start + along * motion, corners[0]) - size;
        if (at_least <= static_cast<double>(distance) * (1.0 + 1e-9)) {
            first = std::min(first, slow_sweep(start, motion, distance, corners));
        }
    }
    return first;
}

}  // namespace tactus::shared
