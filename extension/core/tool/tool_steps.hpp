// How the steps of tools end: of one by itself (tool_proxy.cpp), and of several together (tool_group.cpp).
#pragma once

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "core/math/small_matrix.hpp"
#include "core/math/types.hpp"

namespace tactus::tool_steps {

// Of the skin.
constexpr double least_step = 0.125;  // the tool is where it should be
constexpr double touching_gap = 4.0;  // what the tool is still above does not hold it by friction
constexpr double far_enough = 64.0;   // how far ahead contacts are looked for while the hand is slow
constexpr double near_enough = 8.0;   // the same for a tool that touches
constexpr double bounds_met = 1e-3;   // by motions
constexpr double cones_met = 1e-2;    // by friction

// Of the way in the tick before: how far ahead contacts are looked for. One that touches does not get much
// farther than it did, nor than in the step before; one in the air is led by how far it sees.
constexpr double ahead_in_air = 4.0;
constexpr double ahead_of_tick = 1.3;
constexpr double ahead_of_step = 1.5;

// Of the way in this tick: what the hand goes in 20 us. Where the next step is shorter, it is left to the
// next tick, which begins with it.
constexpr double left_over = 0.02;

constexpr int max_stalls = 6;    // steps that lead nowhere
constexpr int slide_rounds = 4;  // of the pressure and the friction that goes with it

// Of a sphere's radius: what a body on its way may enter before it has to take the tool along (the next step
// lifts the tool out of less), and one that comes to be there before the tool begins anew.
constexpr double entered = 0.5;

// Of the way that the hand and what carries the tool have led it in a tick. What goes farther has slipped,
// off the edge of a body that turns away, say, and its force fades. Were it as much as a proxy's
// (max_sensitivity), such a force would change by up to 1.3 N at once.
constexpr double farthest_led = 2.0;

// Of the tool's reach: how far bodies may take it in a tick, besides the way of the fastest of them.
constexpr double farthest_ride = 0.2;
// Of that way: 50 m/s, at a thousand ticks a second (unit: meters).
constexpr double fastest_way = 0.05;

constexpr std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

inline double length_of(const Vector6& x) {
    double sum = 0.0;
    for (const double value : x) {
        sum += value * value;
    }
    return std::sqrt(sum);
}

// Share of its way that the next tick's first step tries. Where the sweeps of the first step have taken all
// of the work and it has led nowhere, the same ones would do so again: it is shorter, until one leads
// somewhere.
inline double trust_after(double trust, int steps, bool was_cut) {
    return was_cut && steps == 1 ? 0.25 * trust : 1.0;
}

// What of a way does not lift off.
inline Vec3 along_surface(const Vec3& way, const Vec3& normal) {
    return way - normal * glm::dot(normal, way);
}

}  // namespace tactus::tool_steps
