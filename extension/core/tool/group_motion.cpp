#include "core/tool/group_motion.hpp"

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "core/tool/tool_steps.hpp"

namespace tactus {

using tool_steps::at;

namespace {

constexpr int max_group_rounds = 128;
// See WorkBudget: of a look for the next half-space, and of a system, besides what grows with its size.
constexpr std::int64_t group_round_cost = 4;
constexpr std::int64_t group_solve_cost = 6;
constexpr std::int64_t terms_at_a_time = 6;
constexpr std::int64_t group_bounds_at_a_time = 2;  // looks at bounds, for a unit

constexpr std::size_t first_of(int tool) {
    return 6 * at(tool);
}

// Bounds that were violated most before: few of them, and most rounds find the next one among them.
class Pressing {
public:
    std::span<const int> all() const { return {items_.data(), count_}; }
    void add(int bound) {
        if (count_ < items_.size()) {
            items_[count_++] = bound;
        }
    }

private:
    std::array<int, 64> items_;
    std::size_t count_ = 0;
};

// The half-space that is violated most.
class Violations {
public:
    Violations(std::span<const GroupBound> bounds, const GroupSpace& space, const GroupVector& x)
        : bounds_(bounds), space_(space) {
        for (int i = 0; i < space.tools; ++i) {
            motions_[at(i)] = space.of(x, i);
        }
    }
    void look(int index) {
        const GroupBound& bound = bounds_[at(index)];
        Vec3 way = motions_[at(bound.tool)].at(bound.of.arm);
        if (bound.other >= 0) {
            way -= motions_[at(bound.other)].at(bound.other_arm);
        }
        const BoundLook look = look_at(bound.of, way);
        if (look.missing > most) {
            most = look.missing;
            worst_.bound = index;
            worst_.direction = look.direction(bound.of);
        }
    }
    MotionHalfSpace<6 * max_group> worst() {
        if (worst_.bound >= 0) {
            const GroupBound& bound = bounds_[at(worst_.bound)];
            worst_.offset = bound.of.least();
            worst_.row = bound.row(worst_.direction, space_);
        }
        return worst_;
    }
    bool found() const { return worst_.bound >= 0; }

    double most = 0.0;  // (unit: meters)

private:
    std::span<const GroupBound> bounds_;
    const GroupSpace& space_;
    std::array<RigidMotion, max_group> motions_;
    MotionHalfSpace<6 * max_group> worst_;
};

// As the bound is now: along n - mu t with the t that it had; without one, the mean of all, n.
MotionHalfSpace<6 * max_group> half_space(const MotionPush& push, const GroupBound& bound,
                                          const GroupSpace& space) {
    const Vec3 aside = bound.of.normal - push.direction;
    const double length = glm::length(aside);
    MotionHalfSpace<6 * max_group> made;
    made.bound = push.bound;
    made.direction =
        length > 1e-12 ? bound.of.normal - aside * (bound.of.friction / length) : bound.of.normal;
    made.offset = bound.of.least();
    made.row = bound.row(made.direction, space);
    return made;
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
                                 const GroupSpace& space, double tolerance, WorkBudget& work,
                                 const GroupMotion* like) {
    GroupMotion best;
    best.x = goal;
    ActiveSet<6 * max_group> active(best, first_of(space.tools));
    Pressing pressing;
    if (like) {
        std::array<MotionHalfSpace<6 * max_group>, 6 * max_group> spaces;
        for (int i = 0; i < like->push_count; ++i) {
            spaces[at(i)] = half_space(like->pushes[at(i)], bounds[at(like->pushes[at(i)].bound)], space);
            pressing.add(spaces[at(i)].bound);
        }
        active.begin_with(std::span(spaces).first(at(like->push_count)));
    }
    for (int round = 0; best.possible; ++round) {
        Violations violations(bounds, space, best.x);
        violations.most = tolerance;
        for (const int bound : pressing.all()) {
            violations.look(bound);
        }
        std::size_t looked = pressing.all().size();
        if (!violations.found()) {
            for (std::size_t i = 0; i < bounds.size(); ++i) {
                violations.look(static_cast<int>(i));
            }
            looked += bounds.size();
            if (violations.found()) {
                pressing.add(violations.worst().bound);
            }
        }
        const std::int64_t terms = std::int64_t{best.push_count} * best.push_count;
        work.spend(static_cast<std::int64_t>(looked) / group_bounds_at_a_time + group_round_cost +
                   active.take_solves() * (group_solve_cost + terms / terms_at_a_time));
        best.missing = violations.found() ? violations.most : 0.0;
        if (!violations.found() || round == max_group_rounds || work.is_gone()) {
            break;
        }
        best.possible = active.take_in(violations.worst());
    }
    return best;
}

}  // namespace tactus
