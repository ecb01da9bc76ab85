// Whether a sphere could have gone from one place to another at all: a search over a lattice of places, for
// those who judge the proxy.
//
// Every way along which the centre keeps the distance `radius` passes, at each of its points, within half a
// cell's diagonal of a place of the lattice, and from one such place to a neighbouring one. So where there is
// a way, there is one over places that keep `radius` less half a diagonal, and what is not found there is
// nowhere. The cell is a quarter of the radius: the search forgives gaps that are 0.22 of the radius too
// narrow, but no surface, however thin.
#pragma once

#include "shared/judge_tree.hpp"

namespace tactus::shared {

enum class FreeWay { found, none, unknown };

// Only places within `reach` of `around` count: a proxy never goes away from the hand. Unknown where the
// search would take too long.
FreeWay find_free_way(const JudgeTree& mesh, const Vec3& from, const Vec3& to, double radius,
                      const Vec3& around, double reach);

// Whether the straight way from one place to the other keeps 0.78 of the radius, which needs no search.
bool is_straight_way_free(const JudgeTree& mesh, const Vec3& from, const Vec3& to, double radius);

}  // namespace tactus::shared
