// A node of the triangle tree: eight boxes tested at once. Boxes are stored in single precision, rounded
// outward, and relative to the tree's origin; queries widen their reach by `float_slack`, so that no rounding
// hides a triangle.
#pragma once

#if defined(__AVX__)
#include <immintrin.h>
#endif

#include <cstddef>
#include <cstdint>

#include "core/math/types.hpp"

namespace tactus {

constexpr int node_width = 8;

using FloatLanes = float __attribute__((vector_size(32)));

struct alignas(32) BoxNode {
    static constexpr std::uint32_t leaf_bit = 0x8000'0000u;
    static constexpr std::uint32_t unused = 0xffff'ffffu;

    FloatLanes low[3];                // x, y, z of the lower corners (unit: meters); +infinity where unused
    FloatLanes high[3];               // of the upper corners; -infinity where unused
    std::uint32_t child[node_width];  // a node, or a triangle pack where leaf_bit is set, or unused
};

// A large tree does not fit into any cache: what will be looked at soon is asked for early.
inline void fetch_early(const void* object, std::size_t bytes) {
    constexpr std::size_t line = 64;
    for (std::size_t offset = 0; offset < bytes; offset += line) {
        __builtin_prefetch(static_cast<const char*>(object) + offset);
    }
}

// A point in the tree's frame as the boxes see it.
struct FloatPoint {
    FloatLanes x, y, z;
};

inline FloatLanes splat_float(float v) {
    return FloatLanes{v, v, v, v, v, v, v, v};
}

inline FloatPoint to_float_point(const Vec3& p) {
    return {splat_float(static_cast<float>(p.x)), splat_float(static_cast<float>(p.y)),
            splat_float(static_cast<float>(p.z))};
}

namespace box_detail {
inline FloatLanes least(FloatLanes a, FloatLanes b) {
    return a < b ? a : b;
}
inline FloatLanes most(FloatLanes a, FloatLanes b) {
    return a > b ? a : b;
}
inline FloatLanes outside(FloatLanes low, FloatLanes high, FloatLanes p) {
    return most(most(low - p, p - high), splat_float(0.0f));
}
}  // namespace box_detail

// One bit a lane: those with a value up to `limit`.
inline unsigned lanes_up_to(FloatLanes values, float limit) {
    const auto mask = values <= splat_float(limit);
#if defined(__AVX__)
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#else
    unsigned bits = 0;
    for (int i = 0; i < node_width; ++i) {
        bits |= mask[i] ? 1u << i : 0u;
    }
    return bits;
#endif
}

// Squared distance from the point to each box; infinite for unused slots.
inline FloatLanes squared_distance_to_boxes(const BoxNode& node, const FloatPoint& p) {
    const FloatLanes dx = box_detail::outside(node.low[0], node.high[0], p.x);
    const FloatLanes dy = box_detail::outside(node.low[1], node.high[1], p.y);
    const FloatLanes dz = box_detail::outside(node.low[2], node.high[2], p.z);
    return dx * dx + dy * dy + dz * dz;
}

// Where a moving point enters each box grown by `margin` on all sides: t in [0, 1] of its segment, or
// infinity. A motion of zero along an axis is handled by an inverse of huge size instead of infinity (0 * inf
// is NaN).
struct FloatRay {
    FloatPoint origin;
    FloatPoint inverse_motion;
};

inline FloatLanes entry_into_boxes(const BoxNode& node, const FloatRay& ray, float margin, float limit) {
    using namespace box_detail;
    const FloatLanes grow = splat_float(margin);
    const FloatLanes ax = (node.low[0] - grow - ray.origin.x) * ray.inverse_motion.x;
    const FloatLanes bx = (node.high[0] + grow - ray.origin.x) * ray.inverse_motion.x;
    const FloatLanes ay = (node.low[1] - grow - ray.origin.y) * ray.inverse_motion.y;
    const FloatLanes by = (node.high[1] + grow - ray.origin.y) * ray.inverse_motion.y;
    const FloatLanes az = (node.low[2] - grow - ray.origin.z) * ray.inverse_motion.z;
    const FloatLanes bz = (node.high[2] + grow - ray.origin.z) * ray.inverse_motion.z;
    const FloatLanes enter = most(most(least(ax, bx), least(ay, by)), most(least(az, bz), splat_float(0.0f)));
    const FloatLanes leave =
        least(least(most(ax, bx), most(ay, by)), least(most(az, bz), splat_float(limit)));
    // Unused slots have low = +inf, high = -inf: swap-proof only through this explicit test.
    const auto used = node.low[0] <= node.high[0];
    return ((enter <= leave * splat_float(1.0f + 4e-6f)) & used) ? enter : splat_float(__builtin_inff());
}

}  // namespace tactus
