// Four doubles at once. Kernels over several triangles are written with these, and read like their scalar
// formulas.
#pragma once

#if defined(__AVX__)
#include <immintrin.h>
#endif

#include <bit>
#include <cmath>
#include <cstdint>

#include "core/math/types.hpp"

namespace tactus {

constexpr int lane_count = 4;

using Lanes = double __attribute__((vector_size(32)));
// All bits of a lane set: true. Compilers differ in the integer that they make of it.
using LaneMask = decltype(Lanes{} == Lanes{});

inline Lanes splat(double value) {
    return Lanes{value, value, value, value};
}

#if defined(__AVX__)
inline Lanes lanes_min(Lanes a, Lanes b) {
    return _mm256_min_pd(a, b);
}
inline Lanes lanes_max(Lanes a, Lanes b) {
    return _mm256_max_pd(a, b);
}
inline Lanes lanes_sqrt(Lanes a) {
    return _mm256_sqrt_pd(a);
}
inline Lanes select(LaneMask mask, Lanes yes, Lanes no) {
    return _mm256_blendv_pd(no, yes, reinterpret_cast<__m256d>(mask));
}
// One bit a lane.
inline unsigned lane_bits(LaneMask mask) {
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
}
#else
inline Lanes lanes_min(Lanes a, Lanes b) {
    return a < b ? a : b;
}
inline Lanes lanes_max(Lanes a, Lanes b) {
    return a > b ? a : b;
}
inline Lanes lanes_sqrt(Lanes a) {
    return Lanes{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}
inline Lanes select(LaneMask mask, Lanes yes, Lanes no) {
    return mask ? yes : no;
}
inline unsigned lane_bits(LaneMask mask) {
    return static_cast<unsigned>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
}
#endif

inline bool any(LaneMask mask) {
    return lane_bits(mask) != 0;
}

// a * b + c and a * b - c, rounded once. This is the one place where products are fused with sums, and it is
// so on every processor: elsewhere the compiler may not (-ffp-contract=off), so that x86-64 and ARM give the
// same bits. Where no instruction does it, std::fma does, slowly.
#if defined(__FMA__)
inline Lanes multiply_add(Lanes a, Lanes b, Lanes c) {
    return _mm256_fmadd_pd(a, b, c);
}
inline Lanes multiply_subtract(Lanes a, Lanes b, Lanes c) {
    return _mm256_fmsub_pd(a, b, c);
}
#else
inline Lanes multiply_add(Lanes a, Lanes b, Lanes c) {
    return Lanes{std::fma(a[0], b[0], c[0]), std::fma(a[1], b[1], c[1]), std::fma(a[2], b[2], c[2]),
                 std::fma(a[3], b[3], c[3])};
}
inline Lanes multiply_subtract(Lanes a, Lanes b, Lanes c) {
    return multiply_add(a, b, -c);
}
#endif

inline double smallest(Lanes a) {
    const double low = a[0] < a[1] ? a[0] : a[1];
    const double high = a[2] < a[3] ? a[2] : a[3];
    return low < high ? low : high;
}

// The first that is so; none may be NaN.
inline int lane_of_smallest(Lanes a) {
    return std::countr_zero(lane_bits(a == splat(smallest(a))));
}

struct LanesVec3 {
    Lanes x, y, z;
};

inline LanesVec3 splat(const Vec3& v) {
    return {splat(v.x), splat(v.y), splat(v.z)};
}
inline LanesVec3 operator+(const LanesVec3& a, const LanesVec3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline LanesVec3 operator-(const LanesVec3& a, const LanesVec3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline LanesVec3 operator*(const LanesVec3& a, Lanes s) {
    return {a.x * s, a.y * s, a.z * s};
}
inline Lanes dot(const LanesVec3& a, const LanesVec3& b) {
    return multiply_add(a.x, b.x, multiply_add(a.y, b.y, a.z * b.z));
}
inline LanesVec3 cross(const LanesVec3& a, const LanesVec3& b) {
    return {multiply_subtract(a.y, b.z, a.z * b.y), multiply_subtract(a.z, b.x, a.x * b.z),
            multiply_subtract(a.x, b.y, a.y * b.x)};
}
// p + v t
inline LanesVec3 along(const LanesVec3& p, const LanesVec3& v, Lanes t) {
    return {multiply_add(v.x, t, p.x), multiply_add(v.y, t, p.y), multiply_add(v.z, t, p.z)};
}
inline LanesVec3 select(LaneMask mask, const LanesVec3& yes, const LanesVec3& no) {
    return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}
inline Vec3 lane(const LanesVec3& v, int i) {
    return {v.x[i], v.y[i], v.z[i]};
}

}  // namespace tactus
