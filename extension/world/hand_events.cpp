#include "world/hand_events.hpp"

namespace tactus {

std::vector<HandEvent> hand_events(const DeviceState& before, const DeviceState& now) {
    std::vector<HandEvent> events;
    if (before.connected != now.connected) {
        events.push_back({now.connected ? "connected" : "disconnected"});
    }
    if (before.limited == 0 && now.limited != 0) {
        events.push_back({"force_limited"});
    }
    const std::uint32_t changed = before.buttons ^ now.buttons;
    for (int button = 0; button < 32; ++button) {
        if ((changed >> button & 1u) != 0) {
            events.push_back(
                {(now.buttons >> button & 1u) != 0 ? "button_pressed" : "button_released", button});
        }
    }
    return events;
}

}  // namespace tactus
