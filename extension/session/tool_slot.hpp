// A tool in the loop: what the hand holds it by, and what comes of it in a tick. Private to session/.
#pragma once

#include <memory>
#include <utility>

#include "core/haptics/fading_force.hpp"
#include "core/tool/tool_proxy.hpp"
#include "session/session_types.hpp"

namespace tactus {

struct ToolSlot {
    ToolSlot(std::shared_ptr<const ToolShape> shape, std::size_t max_parts, const ToolUse& first_use)
        : proxy(std::move(shape), max_parts, first_use.settings), use(first_use) {}

    ToolProxy proxy;
    ToolUse use;
    Pose hand;                // in the world
    Vec3 hand_velocity{0.0};  // (unit: meters per second)
    Vec3 hand_spin{0.0};      // (unit: radians per second)
    double share = 1.0;       // of the coupling: what of it the device can render safely
    Vec3 force{0.0};          // of the scene as it is; what the hand is given is state.force (unit: newtons)
    double source = 0.0;      // energy that bodies on their way give the hand in this tick (unit: joules)
    FadingForce fading;       // from `force` to state.force
    bool jumped = false;      // see ProxyTick
    bool rested = false;      // since the last tick
    ToolState state;
};

}  // namespace tactus
