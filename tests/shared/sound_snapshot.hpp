// Whether everything that a session shows is a number and a place.
#pragma once

#include <cmath>
#include <string>

#include "session/session_types.hpp"

namespace tactus::shared {

inline bool is_sound(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Empty, or whose state is none.
inline std::string unsound_in(const SessionSnapshot& snapshot) {
    const auto is_turn = [](const Quat& q) { return std::abs(glm::length(q) - 1.0) < 1e-6; };
    for (std::size_t i = 0; i < snapshot.body_count; ++i) {
        const BodyState& body = snapshot.bodies[i];
        if (!is_sound(body.pose.position) || !is_sound(body.linear_velocity) ||
            !is_sound(body.angular_velocity) || !is_turn(body.pose.rotation)) {
            return "body " + std::to_string(body.handle);
        }
    }
    for (std::size_t i = 0; i < snapshot.proxy_count; ++i) {
        const ProxyState& proxy = snapshot.proxies[i];
        if (!is_sound(proxy.position) || !is_sound(proxy.hand) || !is_sound(proxy.force)) {
            return "pointer " + std::to_string(proxy.handle);
        }
    }
    for (std::size_t i = 0; i < snapshot.tool_count; ++i) {
        const ToolState& tool = snapshot.tools[i];
        if (!is_sound(tool.pose.position) || !is_sound(tool.force) || !is_sound(tool.torque) ||
            !is_turn(tool.pose.rotation)) {
            return "tool " + std::to_string(tool.handle);
        }
    }
    for (std::size_t i = 0; i < snapshot.device_count; ++i) {
        const DeviceState& device = snapshot.devices[i];
        if (!is_sound(device.position) || !is_sound(device.velocity) || !is_sound(device.force) ||
            !is_sound(device.torque)) {
            return "device " + std::to_string(device.handle);
        }
    }
    return {};
}

}  // namespace tactus::shared
