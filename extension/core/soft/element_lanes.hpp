// Four elements of a soft body at once: what its nodes do, seen by the elements, and what the elements push
// back. Private to core/soft.
#pragma once

#include <array>
#include <vector>

#include "core/soft/cell_bending.hpp"
#include "core/soft/rotation_lanes.hpp"

namespace tactus {

// Of the rotations, in each step: they go on from where they were.
constexpr int turns_a_step = 2;

inline Lanes row_of(const Vec3& v) {
    return Lanes{v.x, v.y, v.z, 0.0};
}
inline Vec3 vector_of(const Lanes& row) {
    return {row[0], row[1], row[2]};
}

// Four rows of x, y, z as four lanes of each.
inline LanesVec3 gathered(const std::vector<Lanes>& rows, const std::array<std::uint32_t, 4>& node) {
    const Lanes a = rows[node[0]], b = rows[node[1]], c = rows[node[2]], d = rows[node[3]];
    const Lanes ab_low = __builtin_shufflevector(a, b, 0, 4, 2, 6);   // x x z z
    const Lanes ab_high = __builtin_shufflevector(a, b, 1, 5, 3, 7);  // y y . .
    const Lanes cd_low = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const Lanes cd_high = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    return {__builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5),
            __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5),
            __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7)};
}

// And back, added to the rows one after the other: two lanes may belong to one node.
inline void scatter(std::vector<Lanes>& rows, const std::array<std::uint32_t, 4>& node, const LanesVec3& v) {
    const Lanes none = splat(0.0);
    const Lanes xy_low = __builtin_shufflevector(v.x, v.y, 0, 4, 2, 6);   // x0 y0 x2 y2
    const Lanes xy_high = __builtin_shufflevector(v.x, v.y, 1, 5, 3, 7);  // x1 y1 x3 y3
    const Lanes z_low = __builtin_shufflevector(v.z, none, 0, 4, 2, 6);   // z0 0 z2 0
    const Lanes z_high = __builtin_shufflevector(v.z, none, 1, 5, 3, 7);
    rows[node[0]] += __builtin_shufflevector(xy_low, z_low, 0, 1, 4, 5);
    rows[node[1]] += __builtin_shufflevector(xy_high, z_high, 0, 1, 4, 5);
    rows[node[2]] += __builtin_shufflevector(xy_low, z_low, 2, 3, 6, 7);
    rows[node[3]] += __builtin_shufflevector(xy_high, z_high, 2, 3, 6, 7);
}

inline LanesVec3 scaled_sum(const LanesVec3& a, Lanes p, const LanesVec3& b, Lanes q) {
    return {multiply_add(a.x, p, b.x * q), multiply_add(a.y, p, b.y * q), multiply_add(a.z, p, b.z * q)};
}

inline LanesMat3 deformation_of(const std::vector<Lanes>& places, const TetGroup& group) {
    const LanesVec3 origin = gathered(places, group.node[0]);
    const LanesVec3 first = gathered(places, group.node[1]) - origin;
    const LanesVec3 second = gathered(places, group.node[2]) - origin;
    const LanesVec3 third = gathered(places, group.node[3]) - origin;
    const auto column = [&](Lanes a, Lanes b, Lanes c) {
        return along(along(first * a, second, b), third, c);
    };
    return {column(group.gradient[0].x, group.gradient[1].x, group.gradient[2].x),
            column(group.gradient[0].y, group.gradient[1].y, group.gradient[2].y),
            column(group.gradient[0].z, group.gradient[1].z, group.gradient[2].z)};
}

inline LanesVec3 image_of(const LanesMat3& m, const LanesVec3& v) {
    return along(along(m.x * v.x, m.y, v.y), m.z, v.z);
}

// Of a cell: what its corners do, by shape (see cell_bending.hpp).
inline std::array<LanesVec3, 8> transform_of(const std::vector<Lanes>& places, const CellGroup& group) {
    std::array<LanesVec3, 8> t;
    for (std::size_t i = 0; i < 8; ++i) {
        t[i] = gathered(places, group.node[i]);
    }
    transform_corners(t);
    return t;
}

inline LanesMat3 deformation_of(const std::array<LanesVec3, 8>& t, const Vec3& rate) {
    return {t[1] * splat(-rate.x / 8.0), t[2] * splat(-rate.y / 8.0), t[4] * splat(-rate.z / 8.0)};
}

inline CellBending bending_of(const std::array<LanesVec3, 8>& t, const LanesMat3& turn) {
    const auto shape = [&turn](const LanesVec3& v, double share) {
        return LanesVec3{dot(turn.x, v), dot(turn.y, v), dot(turn.z, v)} * splat(share);
    };
    return {shape(t[6], 1.0 / 8.0), shape(t[5], 1.0 / 8.0), shape(t[3], 1.0 / 8.0), shape(t[7], -1.0 / 8.0)};
}

}  // namespace tactus
