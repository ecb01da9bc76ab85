// A force that only its values tell of, as one moment of a field (core/haptics/hand_field.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "core/haptics/hand_field.hpp"

namespace tactus {

// Which way to look: along that in which the force leaps, where it does on the line of `before`; else along
// the displacement since then. A force that has a potential leaps along the normal of where it leaps.
inline Vec3 field_direction(const Vec3& place, const FieldMoment& before) {
    constexpr double steep = 500.0;                    // (unit: newtons per meter)
    constexpr double shortest = 1e-5, smallest = 0.1;  // (units: meters, newtons)
    const FieldLine& line = before.line;
    double steepest = steep;
    Vec3 direction(0.0);
    for (int i = 1; i < line.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Vec3 leap = line.force[k] - line.force[k - 1];
        const double slope = glm::length(leap) / (line.at[k] - line.at[k - 1]);
        if (slope > steepest && glm::length(leap) > smallest) {
            steepest = slope;
            direction = glm::normalize(leap);
        }
    }
    if (direction != Vec3(0.0)) {
        return direction;
    }
    const Vec3 way = place - before.place;
    if (glm::length(way) > shortest) {
        return glm::normalize(way);
    }
    return line.count > 0 ? line.direction : Vec3(1.0, 0.0, 0.0);
}

// Answers at places along that line: nearly evenly where the hand may get until the next time, a few beyond,
// and the others where most of the force's work is uncertain, which is its change times the distance.
template <class Ask>
std::optional<FieldLine> measured_line(const HandMotion& hand, const FieldMoment& before, const Vec3& here,
                                       const Ask& ask) {
    constexpr double least_near = 3e-3, ways = 1.5;  // (unit of the first: meters)
    constexpr int evenly = 8;                        // on each side, about
    constexpr double unevenly = 1.2;                 // a texture is not met in step with its period
    constexpr double farther[] = {3e-3, 8e-3, FieldLine::beyond};
    constexpr double noticed = 1.0;  // (unit: newtons)
    FieldLine line;
    line.direction = field_direction(hand.position, before);
    line.near = least_near + ways * std::min(glm::distance(hand.position, before.place), FieldLine::beyond);
    bool answers = true;
    const auto look = [&](double at) {
        HandMotion aside = hand;
        aside.position += at * line.direction;
        std::optional<Vec3> force = here;
        if (at != 0.0) {
            force = answers ? ask(aside) : std::nullopt;
            answers = force.has_value();
        }
        line.add(at, force.value_or(Vec3(0.0)));
    };
    for (int i = -evenly; i <= evenly; ++i) {
        look(std::copysign(line.near * std::pow(std::abs(i) / double{evenly}, unevenly), i));
    }
    for (const double more : farther) {
        look(-line.near - more);
        look(line.near + more);
    }
    while (line.count < FieldLine::most) {
        double widest = -1.0, middle = 0.0;
        for (std::size_t i = 1; i < static_cast<std::size_t>(line.count); ++i) {
            const double off = std::max({0.0, line.at[i - 1], -line.at[i]});
            const double wide = (line.at[i] - line.at[i - 1]) * line.near / (line.near + off);
            const double work = (glm::distance(line.force[i], line.force[i - 1]) + noticed) * wide;
            if (work > widest) {
                widest = work;
                middle = 0.5 * (line.at[i] + line.at[i - 1]);
            }
        }
        look(middle);
    }
    return answers ? std::optional(line) : std::nullopt;
}

// F is what is answered where the hand is; A and B are differences to places and velocities a little beside
// it:
//
//     A_i = (F(x + h e_i, v) - F(x, v)) / h,    B_i = (F(x, v + k e_i) - F(x, v)) / k.
//
// std::optional<Vec3> ask(const HandMotion& hand) is asked `answers_of_a_field` times; at the first that has
// no answer, nor has this one. `before`: what this gave the last time, or one that is only at that place.
inline constexpr int answers_of_a_field = 6 + FieldLine::most;

template <class Ask>
std::optional<FieldMoment> measured_field(const HandMotion& hand, const FieldMoment& before, const Ask& ask) {
    // Little for a hand, and much for what a script rounds (units: meters, meters per second).
    constexpr double h = 1e-3, k = 1e-2;
    FieldMoment moment;
    moment.place = hand.position;
    moment.velocity = hand.velocity;
    const std::optional<Vec3> here = ask(hand);
    if (!here) {
        return std::nullopt;
    }
    moment.force = *here;
    for (int axis = 0; axis < 3; ++axis) {
        HandMotion aside = hand, faster = hand;
        aside.position[axis] += h;
        faster.velocity[axis] += k;
        const std::optional<Vec3> there = ask(aside);
        const std::optional<Vec3> then = there ? ask(faster) : std::nullopt;
        if (!then) {
            return std::nullopt;
        }
        moment.by_place[axis] = (*there - moment.force) / h;
        moment.by_velocity[axis] = (*then - moment.force) / k;
    }
    const std::optional<FieldLine> line = measured_line(hand, before, moment.force, ask);
    if (!line) {
        return std::nullopt;
    }
    moment.line = *line;
    return moment;
}

}  // namespace tactus
