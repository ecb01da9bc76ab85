#include "shared/reference_descent.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::shared {

namespace {

using Real = long double;

// Steps begin short, where few triangles have to be looked at, and grow while the end is not in sight (in
// radii).
constexpr Real first_step = 5e-4L;
constexpr Real longest_step = 0.02L;
constexpr int max_steps = 20'000;

// Gaussian elimination with row pivoting; false where a pivot is nothing but rounding.
template <int Most>
bool solve(Real (&m)[Most][Most + 1], int size, Real* x) {
    for (int column = 0; column < size; ++column) {
        int pivot = column;
        for (int row = column + 1; row < size; ++row) {
            pivot = std::abs(m[row][column]) > std::abs(m[pivot][column]) ? row : pivot;
        }
        if (std::abs(m[pivot][column]) < 1e-13L) {
            return false;
        }
        for (int k = 0; k <= size; ++k) {
            std::swap(m[pivot][k], m[column][k]);
        }
        for (int row = column + 1; row < size; ++row) {
            const Real factor = m[row][column] / m[column][column];
            for (int k = column; k <= size; ++k) {
                m[row][k] -= factor * m[column][k];
            }
        }
    }
    for (int row = size - 1; row >= 0; --row) {
        x[row] = m[row][size];
        for (int k = row + 1; k < size; ++k) {
            x[row] -= m[row][k] * x[k];
        }
        x[row] /= m[row][row];
    }
    return true;
}

}  // namespace

ReferenceDescent::ReferenceDescent(const TriangleMesh& mesh, double radius)
    : own_(std::make_unique<const JudgeTree>(mesh)), tree_(*own_), radius_(radius) {}

ReferenceDescent::ReferenceDescent(const JudgeTree& tree, double radius) : tree_(tree), radius_(radius) {}

void ReferenceDescent::gather(const SlowVec3& center, Real reach) {
    gathered_at_ = center;
    gathered_reach_ = reach;
    near_.clear();
    tree_.within(Vec3(center), static_cast<double>((radius_ + reach) * (1.0L + 1e-12L)), near_);
}

// The contact planes of everything with a gap of at most `reach`.
void ReferenceDescent::constrain(const SlowVec3& center, Real reach) {
    if (glm::distance(center, gathered_at_) + reach > gathered_reach_) {
        gather(center, 2.0L * reach);
    }
    constraints_.clear();
    for (const std::uint32_t triangle : near_) {
        const SlowClosest closest = slow_closest(center, corners_of(tree_.mesh(), triangle));
        if (closest.distance - radius_ <= reach && closest.distance > 0.0L) {
            constraints_.push_back({(center - closest.point) / closest.distance, closest.distance - radius_,
                                    closest.edge, closest.distance, closest.supports});
        }
    }
}

// The point nearest to the pull on the borders of the chosen constraints; false where it is none of the
// minimum's candidates: a border that pulls, or a constraint of the working set that is broken.
bool ReferenceDescent::solve_subset(const SlowVec3& pull, const std::vector<int>& working, const int* chosen,
                                    int count, Step& step) const {
    Real m[3][4];
    for (int i = 0; i < count; ++i) {
        const Constraint& a = constraints_[static_cast<std::size_t>(chosen[i])];
        for (int k = 0; k < count; ++k) {
            m[i][k] = glm::dot(a.normal, constraints_[static_cast<std::size_t>(chosen[k])].normal);
        }
        m[i][count] = -a.gap - glm::dot(a.normal, pull);
    }
    Real pressure[3];
    if (!solve<3>(m, count, pressure)) {
        return false;
    }
    step = {};
    step.motion = pull;
    for (int i = 0; i < count; ++i) {
        if (pressure[i] < 0.0L) {
            return false;
        }
        step.motion += pressure[i] * constraints_[static_cast<std::size_t>(chosen[i])].normal;
        step.pressing[step.count] = chosen[i];
        step.pressure[step.count++] = pressure[i];
    }
    const Real rounding = 1e-15L * (glm::length(pull) + 1e-3L * radius_);
    return std::ranges::all_of(working, [&](int i) {
        const Constraint& c = constraints_[static_cast<std::size_t>(i)];
        return glm::dot(c.normal, step.motion) >= -c.gap - rounding;
    });
}

// Every subset of one, two and three.
ReferenceDescent::Step ReferenceDescent::enumerate(const SlowVec3& pull,
                                                   const std::vector<int>& working) const {
    Step best;
    best.motion = SlowVec3(0.0L);
    Real nearest = 1e300L;
    const auto consider = [&](std::initializer_list<int> chosen) {
        Step step;
        if (solve_subset(pull, working, chosen.begin(), static_cast<int>(chosen.size()), step)) {
            const Real distance = glm::distance(step.motion, pull);
            if (distance < nearest) {
                nearest = distance;
                best = step;
            }
        }
    };
    for (std::size_t i = 0; i < working.size(); ++i) {
        consider({working[i]});
        for (std::size_t j = i + 1; j < working.size(); ++j) {
            consider({working[i], working[j]});
            for (std::size_t k = j + 1; k < working.size(); ++k) {
                consider({working[i], working[j], working[k]});
            }
        }
    }
    return best;
}

// Planes join one by one, the worst broken first, until none is broken.
ReferenceDescent::Step ReferenceDescent::flat_step(const SlowVec3& pull) const {
    Step step;
    step.motion = pull;
    std::vector<int> working;
    for (std::size_t round = 0; round <= constraints_.size(); ++round) {
        int worst = -1;
        Real most = 1e-16L * (glm::length(pull) + 1e-2L * radius_);
        for (std::size_t i = 0; i < constraints_.size(); ++i) {
            const Real broken = -constraints_[i].gap - glm::dot(constraints_[i].normal, step.motion);
            if (broken > most) {
                most = broken;
                worst = static_cast<int>(i);
            }
        }
        if (worst < 0 || std::ranges::find(working, worst) != working.end()) {
            break;
        }
        working.push_back(worst);
        step = enumerate(pull, working);
    }
    return step;
}

// (1 - sum pressure * bend) motion - N pressure' = pull, N^T motion = -gap.
bool ReferenceDescent::newton_step(const SlowVec3& pull, const Step& flat, SlowVec3& motion,
                                   Real longest) const {
    Real w[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    bool bends = false;
    for (int i = 0; i < flat.count; ++i) {
        const Constraint& c = constraints_[static_cast<std::size_t>(flat.pressing[i])];
        if (c.supports == 3) {
            continue;
        }
        bends = true;
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b) {
                const Real along = c.supports == 2 ? c.edge[a] * c.edge[b] : 0.0L;
                w[a][b] -= flat.pressure[i] * ((a == b ? 1.0L : 0.0L) - c.normal[a] * c.normal[b] - along) /
                           c.distance;
            }
        }
    }
    if (!bends || flat.count == 0) {
        return false;
    }
    // A minimum only where the Lagrangian bends upwards along what the contacts leave free.
    const SlowVec3& n = constraints_[static_cast<std::size_t>(flat.pressing[0])].normal;
    SlowVec3 f1, f2;
    if (flat.count == 1) {
        f1 = glm::normalize(glm::cross(n, std::abs(n.x) < 0.6L ? SlowVec3(1, 0, 0) : SlowVec3(0, 1, 0)));
        f2 = glm::cross(n, f1);
    } else if (flat.count == 2) {
        f1 = glm::cross(n, constraints_[static_cast<std::size_t>(flat.pressing[1])].normal);
        f1 /= glm::length(f1);
        f2 = f1;
    }
    const auto form = [&](const SlowVec3& a, const SlowVec3& b) {
        Real sum = 0.0L;
        for (int i = 0; i < 3; ++i) {
            for (int k = 0; k < 3; ++k) {
                sum += a[i] * w[i][k] * b[k];
            }
        }
        return sum;
    };
    if (flat.count < 3) {
        const Real a = form(f1, f1);
        const Real b = form(f2, f2);
        const Real c = flat.count == 1 ? form(f1, f2) : 0.0L;
        if (a <= 1e-6L || b <= 1e-6L || a * b - c * c <= 1e-12L) {
            return false;
        }
    }
    Real m[6][7] = {};
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            m[i][k] = w[i][k];
        }
        m[i][3 + flat.count] = pull[i];
    }
    for (int i = 0; i < flat.count; ++i) {
        const Constraint& c = constraints_[static_cast<std::size_t>(flat.pressing[i])];
        for (int k = 0; k < 3; ++k) {
            m[k][3 + i] = -c.normal[k];
            m[3 + i][k] = c.normal[k];
        }
        m[3 + i][3 + flat.count] = -c.gap;
    }
    Real x[6];
    if (!solve<6>(m, 3 + flat.count, x)) {
        return false;
    }
    motion = {x[0], x[1], x[2]};
    if (glm::length(motion) > longest) {
        return false;
    }
    for (int i = 0; i < flat.count; ++i) {
        if (x[3 + i] < 0.0L) {
            return false;
        }
    }
    const Real rounding = 1e-17L * (glm::length(pull) + radius_);
    return std::ranges::all_of(
        constraints_, [&](const Constraint& c) { return glm::dot(c.normal, motion) >= -c.gap - rounding; });
}

ReferencePlace ReferenceDescent::settle(const Vec3& start, const Vec3& hand) {
    ReferencePlace place;
    place.position = SlowVec3(start);
    const SlowVec3 goal(hand);
    gathered_reach_ = -1.0L;
    Real longest = first_step * radius_;
    const Real enough = std::max(1e-15L * radius_, 8e-19L * glm::length(place.position));
    for (place.steps = 0; place.steps < max_steps; ++place.steps) {
        constrain(place.position, 2.0L * longest);
        const SlowVec3 pull = goal - place.position;
        const Step flat = flat_step(pull);
        place.pressing = flat.count;
        place.residual = glm::length(flat.motion);
        if (place.residual <= enough) {
            place.settled = true;
            break;
        }
        SlowVec3 motion = flat.motion;
        SlowVec3 polished;
        if (newton_step(pull, flat, polished, longest)) {
            motion = polished;
        }
        const Real length = glm::length(motion);
        if (length > longest) {
            motion *= longest / length;
            place.position += motion;
            longest = std::min(2.0L * longest, longest_step * radius_);
            continue;
        }
        place.position += motion;
    }
    return place;
}

bool ReferenceDescent::is_balanced(const Vec3& start, const Vec3& hand, const SlowVec3& end, double apart) {
    constexpr double hair = 1e-9;  // in radii
    const Vec3 away = glm::normalize(start - Vec3(end));
    const ReferencePlace other = settle(start, hand + hair * static_cast<double>(radius_) * away);
    return glm::distance(other.position, end) > apart;
}

}  // namespace tactus::shared
