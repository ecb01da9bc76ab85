// The small motion of a rigid tool nearest to the one that is wanted, as far as its contacts allow:
// nearest_in_halfspaces lifted to six dimensions (Ortega, Redon and Coquillart 2007, with positions in place
// of accelerations), and with friction.
//
// A motion is x = (v, L w): a way v of the tool's origin and a turn w about it, made a length by L, the root
// of the coupling's stiffness in turns over that in ways. So |x - goal|^2 is the coupling's energy, and the
// motion nearest to the goal is where contacts and coupling are in balance. A point at r from the origin
// moves by u = v + w x r, and the half-space n . u >= -gap is
//     (n, r x n / L) . x >= -gap.
//
// Friction mu makes a cone of it (Anitescu 2006, Tasora and Anitescu 2010): with u_t along the surface,
//     n . u >= -gap + mu (|u_t| - s)
// which is the half-spaces of n - mu t for all directions t along the surface. Each pushes along n - mu t,
// which is Coulomb's force. With s = 0 nothing moves if and only if some forces within their cones balance
// the pull: so whether a tool sticks does not depend on how its contacts share the load. A tool that slides
// would lift by mu |u_t|; with s = |u_t| it does not (de Saxce and Feng 1998).
#pragma once

#include <span>

#include "core/math/types.hpp"
#include "core/tool/dual_method.hpp"
#include "core/tree/work.hpp"

namespace tactus {

struct RigidMotion {
    Vec3 way{0.0};   // v (unit: meters)
    Vec3 turn{0.0};  // w (unit: radians)

    // Of a point of the tool, at `arm` from its origin (unit: meters).
    Vec3 at(const Vec3& arm) const;
};

inline RigidMotion operator*(const RigidMotion& motion, double share) {
    return {motion.way * share, motion.turn * share};
}

inline Vector6 lifted(const RigidMotion& motion, double length) {
    return {motion.way.x,           motion.way.y,           motion.way.z,
            motion.turn.x * length, motion.turn.y * length, motion.turn.z * length};
}
inline RigidMotion lowered(const Vector6& x, double length) {
    return {{x[0], x[1], x[2]}, Vec3(x[3], x[4], x[5]) / length};
}

// What of x moves the point at `arm` from the origin along `direction`.
Vector6 lifted_row(const Vec3& direction, const Vec3& arm, double length);

// What a contact allows.
struct MotionBound {
    Vec3 normal{0.0, 1.0, 0.0};  // n, unit
    Vec3 arm{0.0};               // r (unit: meters)
    double gap = 0.0;            // (unit: meters)
    double friction = 0.0;       // mu
    double slide = 0.0;          // s (unit: meters)

    // What (n - mu t) . u has to be at least (unit: meters).
    double least() const { return -gap - friction * slide; }
};

// How a bound sees a motion of its point.
struct BoundLook {
    double missing = 0.0;  // by so much it is violated (unit: meters)
    Vec3 slide{0.0};       // along the surface (unit: meters)
    double slid = 0.0;     // its length, where there is friction

    // Of the half-space that is violated most: n - mu t.
    Vec3 direction(const MotionBound& bound) const {
        return slid > 0.0 ? bound.normal - slide * (bound.friction / slid) : bound.normal;
    }
};
BoundLook look_at(const MotionBound& bound, const Vec3& way);

using NearestMotion = BoundedMotion<6>;

// By the dual method: takes in the half-space that is violated most until none is by more than `tolerance`
// (unit: meters).
NearestMotion nearest_motion(const Vector6& goal, std::span<const MotionBound> bounds, double length,
                             double tolerance, WorkBudget& work);

}  // namespace tactus
