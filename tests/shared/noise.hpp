// Smooth noise over space, the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/math/types.hpp"

namespace tactus::shared {

// At a corner of the grid, in [-1, 1].
inline double grid_noise(std::int64_t x, std::int64_t y, std::int64_t z) {
    auto bits = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u;
    bits = (bits ^ (bits >> 32) ^ static_cast<std::uint64_t>(y)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 29) ^ static_cast<std::uint64_t>(z)) * 0x94d049bb133111ebu;
    bits ^= bits >> 31;
    return static_cast<double>(bits >> 11) * 0x1p-52 - 1.0;
}

// Between the corners of a grid of edge 1, in [-1, 1].
inline double smooth_noise(const Vec3& p) {
    const Vec3 cell(std::floor(p.x), std::floor(p.y), std::floor(p.z));
    const Vec3 t = p - cell;
    const Vec3 s = t * t * (Vec3(3.0) - 2.0 * t);
    const auto x = static_cast<std::int64_t>(cell.x);
    const auto y = static_cast<std::int64_t>(cell.y);
    const auto z = static_cast<std::int64_t>(cell.z);
    double sum = 0.0;
    for (int i = 0; i < 8; ++i) {
        const double weight =
            (i & 1 ? s.x : 1.0 - s.x) * (i & 2 ? s.y : 1.0 - s.y) * (i & 4 ? s.z : 1.0 - s.z);
        sum += weight * grid_noise(x + (i & 1), y + ((i >> 1) & 1), z + (i >> 2));
    }
    return sum;
}

// Octaves of it, each twice as fine and half as high, in [-2, 2].
inline double fractal_noise(const Vec3& p, int octaves) {
    double sum = 0.0;
    double scale = 1.0;
    for (int i = 0; i < octaves; ++i, scale *= 2.0) {
        sum += smooth_noise(scale * p) / scale;
    }
    return sum;
}

}  // namespace tactus::shared
