// Outside the loop: a force counts for as long as the loop that wrote it, the driver that sends it and the
// device that answers go on. The driver checks this in each exchange, so that a stall of any of them
// releases the hand.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/math/types.hpp"

namespace tactus {

struct ForceCommand {
    Vec3 force{0.0};             // (unit: newtons)
    Vec3 torque{0.0};            // (unit: newton meters)
    Nanoseconds written_at = 0;  // on the steady clock; 0: never
    Nanoseconds read_at = 0;     // when the reading that it answers was taken, on the same clock
    Nanoseconds looked_at = 0;   // when the loop took that reading, on the same clock
};

// The hand is free so long after the last sign of life of the loop or of the driver.
constexpr Nanoseconds free_within = 2'000'000;

// How the loop that writes forces is ticked.
struct LoopPace {
    Nanoseconds period = 1'000'000;  // of a tick, > 0
    bool is_real_time = true;        // by a thread of its own; false: at once, whenever its owner likes
};

// Spans after which a force ends. What is left of free_within is the watchdog's grace and the time that the
// way to the device takes.
struct ForceLife {
    Nanoseconds written = 0;  // from a force's writing to the last exchange that still sends it
    Nanoseconds sent = 0;     // from one exchange of the driver to the next
    Nanoseconds heard = 0;    // from one reading of the device to the next
    Nanoseconds grace = 0;    // from the end of a force until the watchdog takes it from the driver
};

// A device that answers more seldom gives no force: what it says is too old to push a hand by.
constexpr Nanoseconds longest_exchange = 2'500'000;

constexpr Nanoseconds shortest_life = 1'500'000;
constexpr Nanoseconds longest_life = 1'850'000;

// A loop that ticks more slowly cannot be told from one that has stopped before the hand has to be free: a
// tick may be late by a tenth of its period.
constexpr Nanoseconds slowest_tick = longest_life * 10 / 11;

// Why a device gives no force at this pace, and what to do; empty where it does.
std::string why_no_force(const LoopPace& pace);

// A tick, an exchange or a reading that is late by half of its period is still in time. `tick`: the period of
// the loop, at most slowest_tick; `exchange`: that of the device where it keeps a time of its own, else 0.
constexpr ForceLife force_life(Nanoseconds tick, Nanoseconds exchange) {
    ForceLife life;
    life.written = std::clamp(tick * 3 / 2, shortest_life, longest_life);
    life.sent = std::max(life.written, exchange * 3 / 2);
    life.heard = std::max(longest_life, exchange * 3 / 2);
    life.grace = (free_within - life.written) / 3;
    return life;
}

// Why a force has ended that the loop had asked for.
enum class ForceCut : std::uint8_t {
    loop_silent,    // the loop has not written in time
    device_silent,  // the device has sent no reading in time
    driver_stuck,   // the driver's thread has sent nothing in time: the watchdog took the force away
};
constexpr std::size_t force_cut_count = 3;

// For people, after "the force was cut: ".
const char* text_of(ForceCut cut);

}  // namespace tactus
