// What a tick reports instead of logging: bits, OR-ed together until somebody off the loop reads and clears
// them.
#pragma once

#include <cstdint>

namespace tactus {

using TickStatus = std::uint32_t;

// Bits 0 … 23 belong to the tick function. These are the loop's own:
inline constexpr TickStatus tick_late = 1u << 30;  // a tick ended after the next one was due
inline constexpr TickStatus tick_rebased =
    1u << 31;  // a stall was too long to catch up: `scheduled` has jumped ahead

}  // namespace tactus
