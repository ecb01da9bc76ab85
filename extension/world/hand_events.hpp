// What somebody who listens to a hand is told, from one state of its device to the next.
#pragma once

#include <vector>

#include "session/session_types.hpp"

namespace tactus {

struct HandEvent {
    // "connected", "disconnected", "force_limited" (it begins; nothing is told while that goes on),
    // "button_pressed", "button_released".
    const char* name = "";
    int button = -1;  // of the last two
};

// In this order; buttons by their numbers.
std::vector<HandEvent> hand_events(const DeviceState& before, const DeviceState& now);

}  // namespace tactus
