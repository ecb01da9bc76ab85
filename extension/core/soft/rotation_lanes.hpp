// The rotation nearest to a matrix, for four matrices at once.
//
// Of all rotations R, the polar one makes |F - R| least, that is tr(R^T F) largest. Turning R by a small w
// changes the trace by a . w, a = sum of r_i x f_i over the columns. Where F = R S, the turn that is missing
// is (tr(S) 1 - S)^-1 a, or a / (2/3 tr(S)) where the stretches are alike: so R turns about a by the angle
// atan2(|a|, 2/3 tr(R^T F)). From anywhere the trace rises, also for matrices that mirror; near the end the
// error shrinks by the share that the stretches differ by (after Mueller, Bender, Chentanez and Macklin,
// "A robust method to extract the rotational part of deformations", 2016, whose turn takes all of the trace).
#pragma once

#include "core/math/lanes.hpp"

namespace tactus {

struct LanesMat3 {
    LanesVec3 x, y, z;  // columns
};

struct LanesQuat {
    Lanes w, x, y, z;  // unit
};

inline LanesQuat no_turn_lanes() {
    return {splat(1.0), splat(0.0), splat(0.0), splat(0.0)};
}

inline LanesMat3 matrix_of(const LanesQuat& q) {
    const Lanes one = splat(1.0), two = splat(2.0);
    const Lanes xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
    const Lanes xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
    const Lanes wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
    return {{one - two * (yy + zz), two * (xy + wz), two * (xz - wy)},
            {two * (xy - wz), one - two * (xx + zz), two * (yz + wx)},
            {two * (xz + wy), two * (yz - wx), one - two * (xx + yy)}};
}

// tr(R^T F)
inline Lanes common_trace(const LanesMat3& r, const LanesMat3& f) {
    return dot(r.x, f.x) + dot(r.y, f.y) + dot(r.z, f.z);
}

// The next rotation, nearer to F.
inline LanesQuat turned_towards(const LanesQuat& q, const LanesMat3& f) {
    const LanesMat3 r = matrix_of(q);
    const LanesVec3 a = cross(r.x, f.x) + cross(r.y, f.y) + cross(r.z, f.z);
    const Lanes c = splat(2.0 / 3.0) * common_trace(r, f);
    // Half of the angle: tan = |a| / (c + sqrt(c^2 + a^2)). What has no size at all does not turn.
    const Lanes size = lanes_sqrt(multiply_add(c, c, dot(a, a)));
    const Lanes w = lanes_max(c + size, splat(1e-12) * size + splat(1e-150));
    LanesQuat turned{multiply_subtract(w, q.w, multiply_add(a.x, q.x, multiply_add(a.y, q.y, a.z * q.z))),
                     multiply_add(w, q.x, a.x * q.w) + multiply_subtract(a.y, q.z, a.z * q.y),
                     multiply_add(w, q.y, a.y * q.w) + multiply_subtract(a.z, q.x, a.x * q.z),
                     multiply_add(w, q.z, a.z * q.w) + multiply_subtract(a.x, q.y, a.y * q.x)};
    const Lanes scale =
        splat(1.0) /
        lanes_sqrt(multiply_add(
            turned.w, turned.w,
            multiply_add(turned.x, turned.x, multiply_add(turned.y, turned.y, turned.z * turned.z))));
    return {turned.w * scale, turned.x * scale, turned.y * scale, turned.z * scale};
}

}  // namespace tactus
