#include "core/tool/nearest_motion.hpp"

#include <glm/geometric.hpp>

namespace tactus {

namespace {

constexpr int max_rounds = 64;
// See WorkBudget: of a look for the next half-space, and of a system.
constexpr std::int64_t round_cost = 4;
constexpr std::int64_t solve_cost = 6;
constexpr std::int64_t bounds_at_a_time = 3;  // looks at bounds, for a unit

// The half-space that is violated most.
MotionHalfSpace<6> worst_of(std::span<const MotionBound> bounds, const Vector6& x, double length,
                            double& most) {
    const RigidMotion motion = lowered(x, length);
    MotionHalfSpace<6> worst;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        const BoundLook look = look_at(bounds[i], motion.at(bounds[i].arm));
        if (look.missing > most) {
            most = look.missing;
            worst.bound = static_cast<int>(i);
            worst.direction = look.direction(bounds[i]);
        }
    }
    if (worst.bound >= 0) {
        const MotionBound& bound = bounds[static_cast<std::size_t>(worst.bound)];
        worst.offset = bound.least();
        worst.row = lifted_row(worst.direction, bound.arm, length);
    }
    return worst;
}

}  // namespace

Vec3 RigidMotion::at(const Vec3& arm) const {
    return way + glm::cross(turn, arm);
}

Vector6 lifted_row(const Vec3& direction, const Vec3& arm, double length) {
    const Vec3 lever = glm::cross(arm, direction) / length;
    return {direction.x, direction.y, direction.z, lever.x, lever.y, lever.z};
}

BoundLook look_at(const MotionBound& bound, const Vec3& way) {
    BoundLook look;
    const double up = glm::dot(bound.normal, way);
    look.missing = -bound.gap - up;
    if (bound.friction > 0.0) {
        look.slide = way - bound.normal * up;
        look.slid = glm::length(look.slide);
        look.missing += bound.friction * (look.slid - bound.slide);
    }
    return look;
}

NearestMotion nearest_motion(const Vector6& goal, std::span<const MotionBound> bounds, double length,
                             double tolerance, WorkBudget& work) {
    NearestMotion best;
    best.x = goal;
    ActiveSet<6> active(best);
    for (int round = 0; best.possible; ++round) {
        double most = tolerance;
        const MotionHalfSpace<6> worst = worst_of(bounds, best.x, length, most);
        work.spend(static_cast<std::int64_t>(bounds.size()) / bounds_at_a_time + round_cost +
                   active.take_solves() * solve_cost);
        best.missing = worst.bound < 0 ? 0.0 : most;
        if (worst.bound < 0 || round == max_rounds || work.is_gone()) {
            break;
        }
        best.possible = active.take_in(worst);
    }
    return best;
}

}  // namespace tactus
