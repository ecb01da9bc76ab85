// The point of an intersection of half-spaces nearest to a goal: where the contact planes let the proxy go.
#pragma once

#include <cstddef>
#include <span>

#include "core/math/types.hpp"
#include "core/tree/work.hpp"

namespace tactus {

struct HalfSpace {
    Vec3 normal;    // unit; allowed where normal . x >= offset
    double offset;  // (unit: meters)
};

struct NearestInHalfSpaces {
    Vec3 point{0.0};
    int active[3] = {-1, -1, -1};  // the half-spaces whose border the point lies on and that hold it back
    int active_count = 0;
    // point - goal = sum of multiplier[i] * normal of active[i], each >= 0 (unit: meters)
    double multiplier[3] = {0.0, 0.0, 0.0};
    bool feasible = true;  // false: the half-spaces have no common point, or the budget was gone before one
                           // was found; `point` is then meaningless
};

constexpr std::size_t max_halfspaces = 128;  // those beyond are left out

// Takes the half-spaces one by one (Seidel's incremental method for three dimensions): while the best point
// so far satisfies the next one nothing changes; otherwise the new best lies on its border, a problem of one
// dimension less. One that mattered is taken earlier from then on (Welzl's move to front), which keeps the
// time close to linear in their number. Exact up to rounding, no iteration that could cycle. Violations up to
// `tolerance` are none.
NearestInHalfSpaces nearest_in_halfspaces(const Vec3& goal, std::span<const HalfSpace> halfspaces,
                                          double tolerance, WorkBudget& work);

}  // namespace tactus
