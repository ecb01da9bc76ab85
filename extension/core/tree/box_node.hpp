// A node of the triangle tree: eight boxes tested at once. Boxes are stored in single precision, rounded
// outward, and relative to the tree's origin; queries widen their reach by `float_slack`, so that no rounding
// hides a triangle.
#pragma once

#if defined(__AVX__)
#include <immintrin.h>
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>

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

inline FloatLanes dot(const FloatPoint& a, const FloatPoint& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline FloatPoint cross(const FloatPoint& a, const FloatPoint& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline FloatPoint operator-(const FloatPoint& a, const FloatPoint& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

inline FloatLanes splat_float(float v) {
    return FloatLanes{v, v, v, v, v, v, v, v};
}

// Beyond that it is as far away as can be: its square stays a number, and so the infinite distance of unused
// slots stays one. Meshes end at 1e9 m, so no distance is overestimated.
inline FloatPoint to_float_point(const Vec3& p) {
    constexpr double far_away = 1e18;  // (unit: meters)
    const Vec3 near = glm::min(glm::max(p, Vec3(-far_away)), Vec3(far_away));
    return {splat_float(static_cast<float>(near.x)), splat_float(static_cast<float>(near.y)),
            splat_float(static_cast<float>(near.z))};
}

namespace box_detail {
inline FloatLanes least(FloatLanes a, FloatLanes b) {
    return a < b ? a : b;
}
inline FloatLanes most(FloatLanes a, FloatLanes b) {
    return a > b ? a : b;
}
// From the closest point of each box to the point.
inline FloatPoint beyond_straight(const BoxNode& node, const FloatPoint& p) {
    const auto beyond = [&](int axis, FloatLanes x) {
        return most(x - node.high[axis], least(x - node.low[axis], splat_float(0.0f)));
    };
    return {beyond(0, p.x), beyond(1, p.y), beyond(2, p.z)};
}
}  // namespace box_detail

inline FloatLanes float_sqrt(FloatLanes a) {
#if defined(__AVX__)
    return _mm256_sqrt_ps(a);
#else
    FloatLanes root;
    for (int i = 0; i < node_width; ++i) {
        root[i] = __builtin_sqrtf(a[i]);
    }
    return root;
#endif
}

// The largest float not above a number, and the smallest not below.
inline float round_down(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest > value ? std::nextafterf(nearest, -__builtin_inff()) : nearest;
}

inline float round_up(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest < value ? std::nextafterf(nearest, __builtin_inff()) : nearest;
}

using FloatMask = std::int32_t __attribute__((vector_size(32)));  // all bits of a lane set: true

// One bit a lane.
inline unsigned lane_bits(FloatMask mask) {
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

// Those with a value up to `limit`.
inline unsigned lanes_up_to(FloatLanes values, float limit) {
    return lane_bits(values <= splat_float(limit));
}

// Squared distance from the point to each box; infinite for unused slots.
inline FloatLanes squared_distance_to_boxes(const BoxNode& node, const FloatPoint& p) {
    const FloatPoint beyond = box_detail::beyond_straight(node, p);
    return dot(beyond, beyond);
}

// A sphere's way as the boxes see it: `distance` is more by what rounding may hide, `blur` is how much the
// rate at which it nears a box may err, `rounding` that of its ends (unit: meters).
struct FloatWay {
    FloatPoint start, end;  // where it is at t = 0 and at t = limit
    FloatPoint motion;      // as t grows by 1
    float distance;
    float blur;
    float limit;
    float rounding;
    float per_length;  // 1 over the length of `motion` (unit: 1/meter)
};

namespace box_detail {
// Gap between the sphere and each box, and how fast it shrinks.
struct Nearing {
    FloatLanes gap, rate;
};

inline Nearing nearing(const BoxNode& node, const FloatWay& way, const FloatPoint& center) {
    const FloatPoint beyond = beyond_straight(node, center);
    const FloatLanes distance = float_sqrt(dot(beyond, beyond));
    return {distance * splat_float(1.0f - 1e-6f) - splat_float(way.distance),
            dot(beyond, way.motion) / -distance};
}
}  // namespace box_detail

}  // namespace tactus
