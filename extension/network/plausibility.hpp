// What an honest side stays within: the one place that says so. A packet with anything beyond is refused
// whole and counted (Refusal::out_of_range), and a writer keeps to the same.
//
// The bounds keep arithmetic exact and a hand unharmed; what is felt is limited again where force leaves.
#pragma once

#include <cstdint>

#include "core/math/types.hpp"

namespace tactus::plausible {

// Of a hand or a body, from the world's origin, each component (unit: meters).
inline constexpr double max_position = 1e5;
// (unit: meters per second)
inline constexpr double max_speed = 1e3;
// (unit: radians per second)
inline constexpr double max_angular_speed = 1e4;
// On a hand, each component (unit: newtons).
inline constexpr double max_force = 1e3;
// Likewise (unit: newton meters).
inline constexpr double max_torque = 1e3;
// Each component (unit: meters per second squared).
inline constexpr double max_gravity = 100.0;

// Of a sender's clock, either sign: no sum of four overflows; 36 years (unit: nanoseconds).
inline constexpr Nanoseconds max_time = Nanoseconds{1} << 60;
// Of what a packet tells, from the time it is sent at, either way (unit: nanoseconds).
inline constexpr Nanoseconds max_age = 60 * nanoseconds_per_second;
// Of a tick (unit: nanoseconds).
inline constexpr Nanoseconds max_period = nanoseconds_per_second;

// Of packets and of operator samples: a thousand a second for nine thousand years.
inline constexpr std::uint64_t max_sequence = std::uint64_t{1} << 48;
// Packets that a sender gets ahead at once, less than a SequenceWindow holds so that one false packet keeps
// no true one out, and in each second on top.
inline constexpr std::uint64_t max_sequence_jump = 512;
inline constexpr std::uint64_t max_packets_per_second = 20'000;

}  // namespace tactus::plausible
