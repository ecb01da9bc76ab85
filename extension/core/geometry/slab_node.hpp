// Beside each node of the triangle tree: for every child, two parallel planes that have all its triangles
// between them. The box around a piece of surface that stands askew to the axes is about half as thick as the
// piece is wide; the slab along the surface's own normal is only as thick as the surface is rough and round.
//
// A slab says less than nothing to the sides: it is used together with the box.
#pragma once

#include "core/geometry/box_node.hpp"

namespace tactus {

struct alignas(32) SlabNode {
    FloatLanes normal[3];  // x, y, z; of length 1 at most, 0 where a child has no slab
    FloatLanes low, high;  // normal . x of its triangles, relative to the tree's origin (unit: meters)
};

// Lower bounds of the distances from the point to what is between each child's planes, off by rounding of
// float products: the caller takes that off.
inline FloatLanes distance_to_slabs(const SlabNode& slabs, const FloatPoint& p) {
    const FloatLanes at = slabs.normal[0] * p.x + slabs.normal[1] * p.y + slabs.normal[2] * p.z;
    return box_detail::most(at - slabs.high, slabs.low - at);
}

// As squared_distance_to_boxes; `rounding` is what float products may hide (unit: meters).
inline FloatLanes squared_distance(const BoxNode& boxes, const SlabNode& slabs, const FloatPoint& p,
                                   float rounding) {
    const FloatLanes between =
        box_detail::most(distance_to_slabs(slabs, p) - splat_float(rounding), splat_float(0.0f));
    return box_detail::most(squared_distance_to_boxes(boxes, p), between * between);
}

// As earliest_meeting. The distance from a slab changes evenly along the way, as long as the way does not go
// through it: where it does, it has met it before.
inline FloatLanes earliest_meeting(const BoxNode& boxes, const SlabNode& slabs, const FloatWay& way,
                                   float rounding) {
    using namespace box_detail;
    const FloatLanes zero = splat_float(0.0f);
    const FloatLanes never = splat_float(__builtin_inff());
    const FloatLanes at =
        slabs.normal[0] * way.start.x + slabs.normal[1] * way.start.y + slabs.normal[2] * way.start.z;
    const FloatLanes rise =
        slabs.normal[0] * way.motion.x + slabs.normal[1] * way.motion.y + slabs.normal[2] * way.motion.z;
    const FloatLanes above = at - slabs.high;
    const FloatLanes below = slabs.low - at;
    const FloatLanes gap = most(above, below) - splat_float(way.distance + rounding);
    const FloatLanes nearing = ((above > below) ? -rise : rise) + splat_float(way.blur);
    const FloatLanes later = (nearing > zero) ? gap / nearing : never;
    const FloatLanes key = most(earliest_meeting(boxes, way), (gap > zero) ? later : zero);
    return (key <= splat_float(way.limit * (1.0f + 4e-6f))) ? key : never;
}

}  // namespace tactus
