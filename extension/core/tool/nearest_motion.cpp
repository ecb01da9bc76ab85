#include "core/tool/nearest_motion.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tactus {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int max_rounds = 64;
constexpr std::int64_t round_cost = 40;  // of one half-space taken in (see WorkBudget)

// Of a row's squared length: less of it beside those of the active ones is rounding.
constexpr double dependent = 1e-10;

constexpr std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

double dot(const Vector6& a, const Vector6& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 6; ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

void add(Vector6& to, const Vector6& row, double share) {
    for (std::size_t i = 0; i < 6; ++i) {
        to[i] += row[i] * share;
    }
}

struct HalfSpace {
    Vector6 row{};        // allowed where row . x >= offset
    double offset = 0.0;  // (unit: meters)
    Vec3 direction{0.0};
    int bound = -1;
};

class ActiveSet {
public:
    explicit ActiveSet(NearestMotion& best) : best_(best) {}

    // The new half-space presses until its border is reached; what would have to pull then is let go. False
    // where those that are left do not allow it.
    bool take_in(const HalfSpace& taken) {
        double given = 0.0;
        for (int turn = 0; turn <= 6; ++turn) {
            const Vector6 share = shares_of(taken.row);
            Vector6 free = taken.row;
            for (int j = 0; j < best_.push_count; ++j) {
                add(free, rows_[at(j)], -share[at(j)]);
            }
            const double left = dot(free, free);
            const bool is_free = best_.push_count < 6 && left > dependent * dot(taken.row, taken.row);
            const double whole = is_free ? (taken.offset - dot(taken.row, best_.x)) / left : infinity;
            int first = -1;
            double until = infinity;
            for (int j = 0; j < best_.push_count; ++j) {
                const double size = best_.pushes[at(j)].size;
                if (share[at(j)] > 1e-12 && size / share[at(j)] < until) {
                    until = size / share[at(j)];
                    first = j;
                }
            }
            const double step = std::fmin(whole, until);
            if (step == infinity) {
                return false;
            }
            if (is_free) {
                add(best_.x, free, step);
            }
            for (int j = 0; j < best_.push_count; ++j) {
                best_.pushes[at(j)].size -= step * share[at(j)];
            }
            given += step;
            if (whole <= until) {
                rows_[at(best_.push_count)] = taken.row;
                best_.pushes[at(best_.push_count++)] = {taken.bound, taken.direction, given};
                return true;
            }
            let_go(first);
        }
        return false;
    }

private:
    // Of the active rows in `wanted`: (N^T N) share = N^T wanted. The active rows are independent.
    Vector6 shares_of(const Vector6& wanted) const {
        Matrix6 gram{};
        Vector6 right{};
        for (int i = 0; i < 6; ++i) {
            gram[at(i)][at(i)] = 1.0;
            if (i < best_.push_count) {
                right[at(i)] = dot(rows_[at(i)], wanted);
                for (int j = 0; j <= i; ++j) {
                    gram[at(i)][at(j)] = dot(rows_[at(i)], rows_[at(j)]);
                }
            }
        }
        Matrix6 lower{};
        return cholesky(gram, lower) ? solve_cholesky(lower, right) : Vector6{};
    }

    void let_go(int place) {
        --best_.push_count;
        for (int j = place; j < best_.push_count; ++j) {
            best_.pushes[at(j)] = best_.pushes[at(j + 1)];
            rows_[at(j)] = rows_[at(j + 1)];
        }
    }

    NearestMotion& best_;
    std::array<Vector6, 6> rows_;
};

// The half-space that is violated most.
HalfSpace worst_of(std::span<const MotionBound> bounds, const Vector6& x, double length, double& most) {
    const RigidMotion motion = lowered(x, length);
    HalfSpace worst;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        const MotionBound& bound = bounds[i];
        const Vec3 way = motion.at(bound.arm);
        const double up = glm::dot(bound.normal, way);
        double missing = -bound.gap - up;
        Vec3 slide(0.0);
        double slid = 0.0;
        if (bound.friction > 0.0) {
            slide = way - bound.normal * up;
            slid = glm::length(slide);
            missing += bound.friction * (slid - bound.slide);
        }
        if (missing > most) {
            most = missing;
            worst.bound = static_cast<int>(i);
            worst.direction = slid > 0.0 ? bound.normal - slide * (bound.friction / slid) : bound.normal;
        }
    }
    if (worst.bound >= 0) {
        const MotionBound& bound = bounds[at(worst.bound)];
        worst.offset = -bound.gap - bound.friction * bound.slide;
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

NearestMotion nearest_motion(const Vector6& goal, std::span<const MotionBound> bounds, double length,
                             double tolerance, WorkBudget& work) {
    NearestMotion best;
    best.x = goal;
    ActiveSet active(best);
    for (int round = 0; best.possible; ++round) {
        double most = tolerance;
        const HalfSpace worst = worst_of(bounds, best.x, length, most);
        work.spend(static_cast<std::int64_t>(bounds.size()) * cost::half_space + round_cost);
        best.missing = worst.bound < 0 ? 0.0 : most;
        if (worst.bound < 0 || round == max_rounds || work.is_gone()) {
            break;
        }
        best.possible = active.take_in(worst);
    }
    return best;
}

}  // namespace tactus
