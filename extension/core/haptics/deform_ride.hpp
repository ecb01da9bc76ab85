// A mesh deforms, and takes a sphere along: a surface that runs into it pushes it ahead, one that it rests on
// carries it. However far the corners have gone, none of the triangles passes its centre.
//
// The time between the two forms is walked in steps. In each, no triangle comes nearer to the centre than
// half of what the nearest one was; then the sphere is lifted off again, each time by less than the distance
// to the nearest triangle. So no step and no lift leads the centre through a surface.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/geometry/deform_sweep.hpp"
#include "core/haptics/letting_out.hpp"

namespace tactus {

struct DeformRide {
    const DeformSweep& sweep;
    double radius;  // (unit: meters), > 0
    bool carried;   // it rests on the mesh
};

// `center` is the sphere's in the frame of the mesh (unit: meters). `advance(motion)` moves the sphere by as
// much of the motion as nothing else is in the way of, and returns that. False where the sphere is left no
// room, or the work does not suffice: it must be let out then.
template <class Advance>
bool ride(const DeformRide& given, Vec3 center, WorkBudget& work, Advance&& advance) {
    constexpr int max_steps = 256;
    constexpr int max_lifts = 12;
    const DeformSweep& sweep = given.sweep;
    const double radius = given.radius;
    const double least = (1.0 - max_overlap_share) * radius;
    double t = 0.0;
    DeformSweep::Nearest at = sweep.nearest(t, center, 1.1 * radius, work);
    for (int step = 0; t < 1.0; ++step) {
        if (at.distance < least || step == max_steps || work.is_gone()) {
            return false;
        }
        const bool rests = given.carried && at.distance < 1.1 * radius;
        const Vec3 motion = rests ? at.motion : Vec3(0.0);
        const double next = sweep.free_until(t, center, motion, 0.5 * std::min(at.distance, radius), work);
        if (rests) {
            center += advance(motion * (next - t));
        }
        t = next;
        at = sweep.nearest(t, center, 1.1 * radius, work);
        for (int lift = 0; lift < max_lifts && at.distance < (1.0 - 1e-6) * radius; ++lift) {
            const double way = std::min(radius - at.distance, 0.9 * at.distance);
            const Vec3 lifted = advance(at.offset * (way / std::max(at.distance, 1e-300)));
            center += lifted;
            at = sweep.nearest(t, center, 1.1 * radius, work);
            if (glm::length(lifted) < 0.5 * way) {
                break;  // something else is in the way
            }
        }
    }
    return at.distance >= least;
}

}  // namespace tactus
