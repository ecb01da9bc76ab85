#include "core/proxy/nearest_in_halfspaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

namespace tactus {

namespace {

// Two unit normals closer than this to parallel have no usable line between their planes: sin^2 of the angle.
constexpr double parallel = 1e-22;

bool violates(const HalfSpace& h, const Vec3& point, double tolerance) {
    return glm::dot(h.normal, point) < h.offset - tolerance;
}

// The half-spaces in the order in which they are taken.
struct Ordered {
    std::span<const HalfSpace> all;
    std::array<std::uint16_t, max_halfspaces> order;

    int index(int place) const { return order[static_cast<std::size_t>(place)]; }
    const HalfSpace& operator[](int place) const { return all[order[static_cast<std::size_t>(place)]]; }
    void move_to_front(int place) {
        std::rotate(order.begin(), order.begin() + place, order.begin() + place + 1);
    }
};

// Best on the border of both first and second, subject to the half-spaces before second.
NearestInHalfSpaces nearest_on_line(const Vec3& goal, const Ordered& halfspaces, int first, int second,
                                    double tolerance, WorkBudget& work) {
    const HalfSpace& p = halfspaces[first];
    const HalfSpace& q = halfspaces[second];
    const Vec3 across = glm::cross(p.normal, q.normal);
    const double squared_sine = glm::dot(across, across);
    NearestInHalfSpaces best;
    if (squared_sine < parallel) {
        // Equal planes within rounding: the farther border stands for both. Opposite ones leave nothing
        // between.
        best.feasible = glm::dot(p.normal, q.normal) > 0.0;
        best.point = goal + q.normal * (q.offset - glm::dot(q.normal, goal));
        best.active[0] = halfspaces.index(second);
        best.active_count = 1;
        return best;
    }
    // The goal's nearest point on the line. Its part across comes from the offsets alone: they are of the
    // size of the gaps, whereas the goal may be far away, and 1 / sin^2 would blow up its rounding.
    const double cosine = glm::dot(p.normal, q.normal);
    const Vec3 direction = across / std::sqrt(squared_sine);
    const Vec3 base =
        (p.normal * (p.offset - cosine * q.offset) + q.normal * (q.offset - cosine * p.offset)) /
        squared_sine;
    const Vec3 on_line = base + direction * glm::dot(direction, goal);

    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    double low_slope = 0.0;
    double high_slope = 0.0;
    int low_plane = -1;
    int high_plane = -1;
    work.spend(second * cost::half_space);
    for (int k = 0; k < second; ++k) {
        if (k == first) {
            continue;
        }
        const HalfSpace& h = halfspaces[k];
        const double slope = glm::dot(h.normal, direction);
        const double missing = h.offset - glm::dot(h.normal, on_line);
        if (std::abs(slope) * 1e11 < 1.0) {
            best.feasible = best.feasible && missing <= tolerance;
        } else if (slope > 0.0 && missing / slope > low) {
            low = missing / slope;
            low_slope = slope;
            low_plane = k;
        } else if (slope < 0.0 && missing / slope < high) {
            high = missing / slope;
            high_slope = -slope;
            high_plane = k;
        }
    }
    // A bound along the line is a distance from its plane over the slope: what counts is by how much the
    // plane that is met at a shallow angle would be missed at the other's bound, not how far apart the bounds
    // are.
    if (low > high) {
        best.feasible = best.feasible && (low - high) * std::min(low_slope, high_slope) <= tolerance;
        low = high = low_slope > high_slope ? low : high;
    }
    best.active[0] = halfspaces.index(first);
    best.active[1] = halfspaces.index(second);
    best.active_count = 2;
    double along = 0.0;
    if (low > 0.0) {
        along = low;
        best.active[best.active_count++] = halfspaces.index(low_plane);
    } else if (high < 0.0) {
        along = high;
        best.active[best.active_count++] = halfspaces.index(high_plane);
    }
    best.point = on_line + direction * along;
    return best;
}

// Best on the border of `first`, subject to the half-spaces before it.
NearestInHalfSpaces nearest_on_plane(const Vec3& goal, const Ordered& halfspaces, int first, double tolerance,
                                     WorkBudget& work) {
    const HalfSpace& p = halfspaces[first];
    NearestInHalfSpaces best;
    best.point = goal + p.normal * (p.offset - glm::dot(p.normal, goal));
    best.active[0] = halfspaces.index(first);
    best.active_count = 1;
    work.spend(first * cost::half_space);
    for (int j = 0; j < first && best.feasible; ++j) {
        if (violates(halfspaces[j], best.point, tolerance)) {
            best = nearest_on_line(goal, halfspaces, first, j, tolerance, work);
            best.feasible = best.feasible && !work.is_gone();
        }
    }
    return best;
}

// Solves point - goal = N m for the one to three active normals.
void find_multipliers(const Vec3& goal, std::span<const HalfSpace> halfspaces, NearestInHalfSpaces& best) {
    const Vec3 pull = best.point - goal;
    const auto normal = [&](int i) -> const Vec3& {
        return halfspaces[static_cast<std::size_t>(best.active[i])].normal;
    };
    if (best.active_count == 1) {
        best.multiplier[0] = glm::dot(pull, normal(0));
    } else if (best.active_count == 2) {
        const double cosine = glm::dot(normal(0), normal(1));
        const double scale = 1.0 / (1.0 - cosine * cosine);
        const double on_first = glm::dot(pull, normal(0));
        const double on_second = glm::dot(pull, normal(1));
        best.multiplier[0] = (on_first - cosine * on_second) * scale;
        best.multiplier[1] = (on_second - cosine * on_first) * scale;
    } else if (best.active_count == 3) {
        const Vec3 across = glm::cross(normal(1), normal(2));
        const double volume = glm::dot(normal(0), across);
        best.multiplier[0] = glm::dot(pull, across) / volume;
        best.multiplier[1] = glm::dot(pull, glm::cross(normal(2), normal(0))) / volume;
        best.multiplier[2] = glm::dot(pull, glm::cross(normal(0), normal(1))) / volume;
    }
    for (double& multiplier : best.multiplier) {
        multiplier = std::isfinite(multiplier) && multiplier > 0.0 ? multiplier : 0.0;
    }
}

// One alone needs no order.
NearestInHalfSpaces nearest_in_one(const Vec3& goal, const HalfSpace& h, double tolerance) {
    NearestInHalfSpaces best;
    best.point = goal;
    if (violates(h, goal, tolerance)) {
        best.multiplier[0] = h.offset - glm::dot(h.normal, goal);
        best.point = goal + h.normal * best.multiplier[0];
        best.active[0] = 0;
        best.active_count = 1;
    }
    return best;
}

}  // namespace

NearestInHalfSpaces nearest_in_halfspaces(const Vec3& goal, std::span<const HalfSpace> halfspaces,
                                          double tolerance, WorkBudget& work) {
    if (halfspaces.size() == 1) {
        work.spend(cost::half_space);
        return nearest_in_one(goal, halfspaces[0], tolerance);
    }
    NearestInHalfSpaces best;
    best.point = goal;
    const int count = static_cast<int>(std::min<std::size_t>(halfspaces.size(), max_halfspaces));
    Ordered ordered;
    ordered.all = halfspaces;
    for (int i = 0; i < count; ++i) {
        ordered.order[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(i);
    }
    work.spend(count * cost::half_space);
    for (int i = 0; i < count && best.feasible; ++i) {
        if (violates(ordered[i], best.point, tolerance)) {
            best = nearest_on_plane(goal, ordered, i, tolerance, work);
            ordered.move_to_front(i);
        }
    }
    find_multipliers(goal, halfspaces, best);
    return best;
}

}  // namespace tactus
