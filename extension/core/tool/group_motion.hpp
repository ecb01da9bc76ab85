// The small motions of several tools that touch each other, nearest to those that are wanted:
// nearest_motion.hpp with six unknowns for each.
//
// Tool i has the coupling k_i |x_i - goal_i|^2 / 2 with x_i of nearest_motion.hpp. With X_i = x_i (k_i /
// k)^(1/2), k one of them, the energy of all couplings is k |X - G|^2 / 2. Where a point of one tool touches
// the other one they have the ways u and u', and the half-space n . (u - u') >= -gap is
//     (n, r x n / L) / s . X - (n, r' x n / L') / s' . X' >= -gap,    s = (k_i / k)^(1/2).
// Its multiplier m pushes the one tool with k m n and the other with -k m n at the same point: force and
// torque of the two hands are opposite about it, whatever their stiffnesses. Friction makes the same cone of
// u - u' that walls make of u.
#pragma once

#include <array>
#include <span>

#include "core/tool/nearest_motion.hpp"

namespace tactus {

constexpr int max_group = 4;  // tools that move together

using GroupVector = SmallVector<6 * max_group>;
using GroupMotion = BoundedMotion<6 * max_group>;

// Of the tools of a group.
struct GroupSpace {
    int tools = 0;
    std::array<double, max_group> lengths{};  // L_i (unit: meters)
    std::array<double, max_group> roots{};    // (k_i / k)^(1/2)

    RigidMotion of(const GroupVector& x, int tool) const;
    void put(GroupVector& x, int tool, const RigidMotion& motion) const;
    // Of x_i (unit: meters).
    double way_of(const GroupVector& x, int tool) const;
};

struct GroupBound {
    MotionBound of;       // `arm` is of `tool`
    Vec3 other_arm{0.0};  // r' (unit: meters)
    int tool = 0;
    int other = -1;  // that is on the other side; -1: something that stands still

    // u - u'
    Vec3 way(const GroupSpace& space, const GroupVector& x) const;
    GroupVector row(const Vec3& direction, const GroupSpace& space) const;
};

// See nearest_motion(). `like`: of the same bounds with other frictions, slides or another goal; what pressed
// there is where it begins.
GroupMotion nearest_group_motion(const GroupVector& goal, std::span<const GroupBound> bounds,
                                 const GroupSpace& space, double tolerance, WorkBudget& work,
                                 const GroupMotion* like = nullptr);

}  // namespace tactus
