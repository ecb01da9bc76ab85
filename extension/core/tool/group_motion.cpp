#include "core/tool/group_motion.hpp"

#include <cmath>
#include <cstdint>

namespace tactus {

namespace {

constexpr int max_rounds = 128;
constexpr std::int64_t round_cost = 60;  // of one half-space taken in (see WorkBudget)
constexpr std::int64_t bound_cost = 2;   // both sides of a half-space

constexpr std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

constexpr std::size_t first_of(int tool) {
    return 6 * at(tool);
}

MotionHalfSpace<6 * max_group> worst_of(std::span<const GroupBound> bounds, const GroupVector& x,
                                        const GroupSpace& space, double& most) {
    std::array<RigidMotion, max_group> motions;
    for (int i = 0; i < space.tools; ++i) {
        motions[at(i)] = space.of(x, i);
    }
    MotionHalfSpace<6 * max_group> worst;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        const GroupBound& bound = bounds[i];
        Vec3 way = motions[at(bound.tool)].at(bound.of.arm);
        if (bound.other >= 0) {
            way -= motions[at(bound.other)].at(bound.other_arm);
        }
        const BoundLook look = look_at(bound.of, way);
        if (look.missing > most) {
            most = look.missing;
            worst.bound = static_cast<int>(i);
            worst.direction = look.direction(bound.of);
        }
    }
    if (worst.bound >= 0) {
        const GroupBound& bound = bounds[at(worst.bound)];
        worst.offset = -bound.of.gap - bound.of.friction * bound.of.slide;
        worst.row = bound.row(worst.direction, space);
    }
    return worst;
}

void put_row(GroupVector& row, int tool, const Vector6& part, double share) {
    for (std::size_t i = 0; i < 6; ++i) {
        row[first_of(tool) + i] = part[i] * share;
    }
}

}  // namespace

RigidMotion GroupSpace::of(const GroupVector& x, int tool) const {
    Vector6 part;
    for (std::size_t i = 0; i < 6; ++i) {
        part[i] = x[first_of(tool) + i] / roots[at(tool)];
    }
    return lowered(part, lengths[at(tool)]);
}

void GroupSpace::put(GroupVector& x, int tool, const RigidMotion& motion) const {
    put_row(x, tool, lifted(motion, lengths[at(tool)]), roots[at(tool)]);
}

double GroupSpace::way_of(const GroupVector& x, int tool) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < 6; ++i) {
        sum += x[first_of(tool) + i] * x[first_of(tool) + i];
    }
    return std::sqrt(sum) / roots[at(tool)];
}

Vec3 GroupBound::way(const GroupSpace& space, const GroupVector& x) const {
    const Vec3 own = space.of(x, tool).at(of.arm);
    return other >= 0 ? own - space.of(x, other).at(other_arm) : own;
}

GroupVector GroupBound::row(const Vec3& direction, const GroupSpace& space) const {
    GroupVector row{};
    put_row(row, tool, lifted_row(direction, of.arm, space.lengths[at(tool)]), 1.0 / space.roots[at(tool)]);
    if (other >= 0) {
        put_row(row, other, lifted_row(direction, other_arm, space.lengths[at(other)]),
                -1.0 / space.roots[at(other)]);
    }
    return row;
}

GroupMotion nearest_group_motion(const GroupVector& goal, std::span<const GroupBound> bounds,
                                 const GroupSpace& space, double tolerance, WorkBudget& work) {
    GroupMotion best;
    best.x = goal;
    ActiveSet<6 * max_group> active(best, first_of(space.tools));
    for (int round = 0; best.possible; ++round) {
        double most = tolerance;
        const MotionHalfSpace<6 * max_group> worst = worst_of(bounds, best.x, space, most);
        work.spend(static_cast<std::int64_t>(bounds.size()) * bound_cost + round_cost +
                   std::int64_t{best.push_count} * best.push_count);
        best.missing = worst.bound < 0 ? 0.0 : most;
        if (worst.bound < 0 || round == max_rounds || work.is_gone()) {
            break;
        }
        best.possible = active.take_in(worst);
    }
    return best;
}

}  // namespace tactus
