// The x that many noisy lines a . x = b ask for, one line at a time, with how sure it is.
//
// Each line has an error of known deviation d. With the covariance P of x so far,
//
//     gain = P a / (a . P a + d^2)        x += gain (b - a . x)        P -= gain transpose(P a)
//
// and between lines P grows by what x may have wandered.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/small_matrix.hpp"

namespace tactus {

template <std::size_t n>
class RecursiveLeastSquares {
public:
    // Standard deviations of what is known before the first line.
    RecursiveLeastSquares(const SmallVector<n>& x, const SmallVector<n>& deviations) : x_(x) {
        for (std::size_t i = 0; i < n; ++i) {
            p_[i][i] = deviations[i] * deviations[i];
        }
    }

    // x may have changed by so much since: standard deviations.
    void wander(const SmallVector<n>& deviations) {
        for (std::size_t i = 0; i < n; ++i) {
            p_[i][i] += deviations[i] * deviations[i];
        }
    }

    // A line that is not finite, or of no deviation, teaches nothing.
    void learn(const SmallVector<n>& a, double b, double deviation) {
        SmallVector<n> pa{};
        double sum = deviation * deviation;
        double off = b;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) {
                pa[i] += p_[i][j] * a[j];
            }
            sum += a[i] * pa[i];
            off -= a[i] * x_[i];
        }
        if (!std::isfinite(off) || !std::isfinite(sum) || !(deviation > 0.0)) {
            return;
        }
        for (std::size_t i = 0; i < n; ++i) {
            x_[i] += pa[i] / sum * off;
            for (std::size_t j = 0; j < n; ++j) {
                p_[i][j] -= pa[i] * pa[j] / sum;
            }
        }
    }

    double value(std::size_t i) const { return x_[i]; }
    double deviation(std::size_t i) const { return std::sqrt(std::max(0.0, p_[i][i])); }

private:
    SmallVector<n> x_;
    SmallMatrix<n> p_{};
};

}  // namespace tactus
