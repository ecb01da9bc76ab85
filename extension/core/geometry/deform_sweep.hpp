// A mesh between two forms of the same triangles: every corner goes straight from where it was, at t = 0, to
// where it is, at t = 1. Boxes between two boxes hold what is between their triangles, so both trees together
// answer for every t.
//
// In the mesh's frame, in metres. Queries allocate nothing.
#pragma once

#include "core/geometry/triangle_tree.hpp"

namespace tactus {

class DeformSweep {
public:
    // `to` must be a refit of `from` (see TriangleTree::is_refit_of). Both are used as long as this is.
    DeformSweep(const TriangleTree& from, const TriangleTree& to) : from_(from), to_(to) {}

    struct Nearest {
        double distance = 0.0;  // `far` where nothing is nearer (unit: meters)
        Vec3 offset{0.0};       // from the nearest point to the one asked for (unit: meters)
        Vec3 motion{0.0};       // of the nearest point from t = 0 to 1 (unit: meters)
    };

    // The nearest triangle at t. Where `work` is used up there may be a nearer one.
    Nearest nearest(double t, const Vec3& point, double far, WorkBudget& work) const;

    // The way is free up to here: before, no triangle comes nearer than `room` to a point that is at `point`
    // at t and goes on by `motion` in the time from 0 to 1. At most 1. A lower bound: on from there.
    double free_until(double t, const Vec3& point, const Vec3& motion, double room, WorkBudget& work) const;

private:
    const TriangleTree& from_;
    const TriangleTree& to_;
};

}  // namespace tactus
