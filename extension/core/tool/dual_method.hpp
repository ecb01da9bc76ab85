// Goldfarb and Idnani's dual method (1983) for the point nearest to a goal within half-spaces: begins at the
// goal and takes in one half-space after the other, each with a multiplier that pushes and never pulls.
// Shared by the motion of one tool (nearest_motion.hpp) and of several (group_motion.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "core/math/small_matrix.hpp"
#include "core/math/types.hpp"

namespace tactus {

struct MotionPush {
    int bound = -1;
    Vec3 direction{0.0};  // n - mu t
    double size = 0.0;    // (unit: meters)
};

// Of n unknowns.
template <std::size_t n>
struct BoundedMotion {
    SmallVector<n> x{};                // goal + sum of size * row
    std::array<MotionPush, n> pushes;  // what holds it back
    int push_count = 0;
    bool possible = true;  // false: the bounds leave nothing
    double missing = 0.0;  // the largest violation that the work has left over (unit: meters)
};

template <std::size_t n>
struct MotionHalfSpace {
    SmallVector<n> row{};  // allowed where row . x >= offset
    double offset = 0.0;   // (unit: meters)
    Vec3 direction{0.0};
    int bound = -1;
};

template <std::size_t n>
class ActiveSet {
public:
    // Unknowns from `size` on are zero in every row.
    explicit ActiveSet(BoundedMotion<n>& best, std::size_t size = n) : best_(best), size_(size) {}

    // The new half-space presses until its border is reached; what would have to pull then is let go. False
    // where those that are left do not allow it.
    bool take_in(const MotionHalfSpace<n>& taken) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        double given = 0.0;
        for (std::size_t turn = 0; turn <= size(); ++turn) {
            const SmallVector<n> share = shares_of(taken.row);
            const SmallVector<n> free = beside_active(taken.row, share);
            const double left = dot(free, free);
            const bool is_free = count() < size() && left > dependent * dot(taken.row, taken.row);
            const double whole = is_free ? (taken.offset - dot(taken.row, best_.x)) / left : infinity;
            std::size_t first = 0;
            double until = infinity;
            for (std::size_t j = 0; j < count(); ++j) {
                const double pressed = best_.pushes[j].size;
                if (share[j] > 1e-12 && pressed / share[j] < until) {
                    until = pressed / share[j];
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
            for (std::size_t j = 0; j < count(); ++j) {
                best_.pushes[j].size -= step * share[j];
            }
            given += step;
            if (whole <= until) {
                rows_[count()] = taken.row;
                best_.pushes[count()] = {taken.bound, taken.direction, given};
                ++best_.push_count;
                return true;
            }
            let_go(first);
        }
        return false;
    }

    // Begins with half-spaces that have pressed in a problem much like this one: with those of them that
    // press here as well. Only before the first is taken in.
    void begin_with(std::span<const MotionHalfSpace<n>> spaces) {
        const SmallVector<n> goal = best_.x;
        SmallVector<n> missing{};
        for (const MotionHalfSpace<n>& space : spaces) {
            if (count() < size() && is_independent(space.row)) {
                missing[count()] = space.offset - dot(space.row, goal);
                rows_[count()] = space.row;
                best_.pushes[count()] = {space.bound, space.direction, 0.0};
                ++best_.push_count;
            }
        }
        while (count() > 0) {
            const SmallVector<n> sizes = solved(missing);
            const auto last = sizes.begin() + static_cast<std::ptrdiff_t>(count());
            const auto least = std::min_element(sizes.begin(), last);
            if (*least > 0.0) {
                for (std::size_t j = 0; j < count(); ++j) {
                    best_.pushes[j].size = sizes[j];
                    add(best_.x, rows_[j], sizes[j]);
                }
                return;
            }
            const auto place = static_cast<std::size_t>(least - sizes.begin());
            let_go(place);
            std::copy(missing.begin() + after(place), missing.end(), missing.begin() + after(place) - 1);
        }
    }

    // How many systems were solved since it was asked last.
    int take_solves() { return std::exchange(solves_, 0); }

private:
    // Of a row's squared length: less of it beside those of the active ones is rounding.
    static constexpr double dependent = 1e-10;

    std::size_t size() const { return n == 6 ? n : size_; }
    std::size_t count() const { return static_cast<std::size_t>(best_.push_count); }

    double dot(const SmallVector<n>& a, const SmallVector<n>& b) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < size(); ++i) {
            sum += a[i] * b[i];
        }
        return sum;
    }
    void add(SmallVector<n>& to, const SmallVector<n>& row, double share) const {
        for (std::size_t i = 0; i < size(); ++i) {
            to[i] += row[i] * share;
        }
    }

    static std::ptrdiff_t after(std::size_t place) { return static_cast<std::ptrdiff_t>(place) + 1; }

    // What of a row the shares of the active ones leave.
    SmallVector<n> beside_active(SmallVector<n> row, const SmallVector<n>& share) const {
        for (std::size_t j = 0; j < count(); ++j) {
            add(row, rows_[j], -share[j]);
        }
        return row;
    }

    bool is_independent(const SmallVector<n>& row) {
        const SmallVector<n> free = beside_active(row, shares_of(row));
        return dot(free, free) > 1e3 * dependent * dot(row, row);
    }

    // Of the active rows in `wanted`: (N^T N) share = N^T wanted. The active rows are independent.
    SmallVector<n> shares_of(const SmallVector<n>& wanted) {
        SmallVector<n> right{};
        for (std::size_t i = 0; i < count(); ++i) {
            right[i] = dot(rows_[i], wanted);
        }
        return solved(right);
    }

    // Of N^T N x = right; nothing where that cannot be told. Only of rows that are new since the last one,
    // N^T N and its factor are computed.
    SmallVector<n> solved(const SmallVector<n>& right) {
        ++solves_;
        for (; factored_ < count(); ++factored_) {
            for (std::size_t j = 0; j <= factored_; ++j) {
                gram_[factored_][j] = dot(rows_[factored_], rows_[j]);
            }
            if (!cholesky_row(gram_, lower_, factored_, 1e-12)) {
                return {};
            }
        }
        return solve_cholesky(lower_, right, count());
    }

    void let_go(std::size_t place) {
        --best_.push_count;
        factored_ = std::min(factored_, place);
        for (std::size_t j = place; j < count(); ++j) {
            best_.pushes[j] = best_.pushes[j + 1];
            rows_[j] = rows_[j + 1];
        }
    }

    BoundedMotion<n>& best_;
    std::size_t size_;
    std::array<SmallVector<n>, n> rows_;
    SmallMatrix<n> gram_;
    SmallMatrix<n> lower_;
    std::size_t factored_ = 0;  // rows of lower_
    int solves_ = 0;
};

}  // namespace tactus
