// A force that only its values tell of, as one moment of a field (core/haptics/hand_field.hpp).
#pragma once

#include <optional>

#include "core/haptics/hand_field.hpp"

namespace tactus {

// F is what is answered where the hand is; A and B are differences to places and velocities a little beside
// it:
//
//     A_i = (F(x + h e_i, v) - F(x, v)) / h,    B_i = (F(x, v + k e_i) - F(x, v)) / k.
//
// std::optional<Vec3> ask(const HandMotion& hand) is asked seven times; at the first that has no answer, nor
// has this one.
template <class Ask>
std::optional<FieldMoment> measured_field(const HandMotion& hand, const Ask& ask) {
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
    return moment;
}

// What several tell of the same hand adds up.
inline void add(FieldMoment& sum, const FieldMoment& one) {
    sum.place = one.place;
    sum.velocity = one.velocity;
    sum.force += one.force;
    sum.by_place += one.by_place;
    sum.by_velocity += one.by_velocity;
}

}  // namespace tactus
