// Outside the loop: a force counts for as long as the loop goes on. Whoever talks to a device asks this
// before each exchange, so that a loop that stalls, for whatever reason, lets the hand go.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

struct ForceCommand {
    Vec3 force{0.0};             // (unit: newtons)
    Vec3 torque{0.0};            // (unit: newton meters)
    Nanoseconds written_at = 0;  // on the steady clock; 0: never
};

// From a force's writing to the last exchange that still sends it. With the way to the device, which takes
// the rest, the hand is free 2 ms after the last sign of life; a tick that is late by half a period is still
// in time.
constexpr Nanoseconds force_lifetime = 1'500'000;

inline bool is_alive(const ForceCommand& command, Nanoseconds now) {
    return command.written_at != 0 && now - command.written_at <= force_lifetime;
}

}  // namespace tactus
