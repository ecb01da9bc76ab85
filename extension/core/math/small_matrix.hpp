// Symmetric systems of a few unknowns, as least squares make them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace tactus {

template <std::size_t n>
using SmallVector = std::array<double, n>;
template <std::size_t n>
using SmallMatrix = std::array<SmallVector<n>, n>;

using Vector6 = SmallVector<6>;
using Matrix6 = SmallMatrix<6>;

// Row i of cholesky(), with the rows above it done.
template <std::size_t n>
bool cholesky_row(const SmallMatrix<n>& a, SmallMatrix<n>& l, std::size_t i, double least) {
    for (std::size_t j = 0; j <= i; ++j) {
        double sum = a[i][j];
        for (std::size_t k = 0; k < j; ++k) {
            sum -= l[i][k] * l[j][k];
        }
        if (i != j) {
            l[i][j] = sum / l[j][j];
        } else if (sum > least * a[i][i] && sum > 0.0) {
            l[i][i] = std::sqrt(sum);
        } else {
            return false;
        }
    }
    return true;
}

// The lower triangle L of A = L transposed(L); false where A is not positive definite. Only A's lower
// triangle is read. `least`: share of a diagonal element that must be left when what the elements before it
// explain is gone.
template <std::size_t n>
bool cholesky(const SmallMatrix<n>& a, SmallMatrix<n>& l, double least = 1e-12) {
    for (std::size_t i = 0; i < n; ++i) {
        if (!cholesky_row(a, l, i, least)) {
            return false;
        }
    }
    return true;
}

// x of L transposed(L) x = b.
template <std::size_t n>
SmallVector<n> solve_cholesky(const SmallMatrix<n>& l, SmallVector<n> b, std::size_t size = n) {
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            b[i] -= l[i][k] * b[k];
        }
        b[i] /= l[i][i];
    }
    for (std::size_t i = size; i-- > 0;) {
        for (std::size_t k = i + 1; k < size; ++k) {
            b[i] -= l[k][i] * b[k];
        }
        b[i] /= l[i][i];
    }
    return b;
}

template <std::size_t n>
SmallMatrix<n> inverse_of_cholesky(const SmallMatrix<n>& l) {
    SmallMatrix<n> inverse{};
    for (std::size_t j = 0; j < n; ++j) {
        SmallVector<n> unit{};
        unit[j] = 1.0;
        const SmallVector<n> column = solve_cholesky(l, unit);
        for (std::size_t i = 0; i < n; ++i) {
            inverse[i][j] = column[i];
        }
    }
    return inverse;
}

}  // namespace tactus
