// What the owner of a session asks of its devices, proxies and tools.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <utility>

#include "physics/limits.hpp"
#include "session/request_checks.hpp"
#include "session/session_impl.hpp"

namespace tactus {

namespace {

// Forces no longer than `strongest` (unit: newtons), at places within a meter that ascend.
bool is_line(const FieldLine& line, double strongest) {
    if (line.count == 0) {
        return line.direction == Vec3(0.0);
    }
    const bool fits = line.count >= 2 && line.count <= FieldLine::most && line.near >= 0.0 &&
                      line.near <= 1.0 && std::abs(glm::length(line.direction) - 1.0) < 1e-6;
    for (int i = 0; fits && i < line.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const bool ascends = k == 0 || line.at[k] > line.at[k - 1];
        if (!ascends || !(std::abs(line.at[k]) <= 1.0) || !(glm::length(line.force[k]) <= strongest)) {
            return false;
        }
    }
    return fits;
}

}  // namespace

AddResult Session::add_device(Device& device, const Workspace& workspace) {
    if (std::string error = check_workspace(workspace); !error.empty()) {
        return {no_handle, std::move(error)};
    }
    const SessionHandle handle = impl_->take_from(impl_->devices);
    if (handle == no_handle) {
        return {no_handle, "a world takes at most " + std::to_string(max_devices) + " devices: remove one"};
    }
    impl_->note(call::AddDevice{handle, workspace});
    impl_->send(command::AddDevice{handle, &device, workspace});
    return {handle, {}};
}

void Session::set_workspace(SessionHandle device, const Workspace& workspace) {
    if (impl_->devices.in_use(device) && check_workspace(workspace).empty()) {
        impl_->send(command::SetWorkspace{device, workspace});
    }
}

void Session::remove_device(SessionHandle device) {
    if (impl_->devices.let_go(device)) {
        impl_->send(command::RemoveDevice{device});
    }
}

AddResult Session::add_proxy(const ProxyDescription& description) {
    if (std::string error = check_proxy(description); !error.empty()) {
        return {no_handle, std::move(error)};
    }
    const SessionHandle handle = impl_->take_from(impl_->proxies);
    if (handle == no_handle) {
        return {no_handle, "a world takes at most " + std::to_string(max_proxies) + " proxies: remove one"};
    }
    const auto make = [&] {
        return std::make_unique<Proxy>(impl_->settings.max_parts, description.settings);
    };
    impl_->note(call::AddProxy{handle, description});
    impl_->keep_ways(description.aids);
    impl_->send(command::AddProxy{handle, make(), impl_->has_twin ? make() : nullptr, description});
    return {handle, {}};
}

void Session::set_proxy(SessionHandle proxy, const ProxyDescription& description) {
    if (impl_->proxies.in_use(proxy) && check_proxy(description).empty()) {
        impl_->keep_ways(description.aids);
        impl_->send(command::SetProxy{proxy, description});
    }
}

void Session::set_hand_field(SessionHandle hand, const FieldMoment& moment) {
    constexpr double strongest = 1e6;  // (unit: newtons)
    constexpr double steepest = 1e12;  // (units: newtons per meter, newton seconds per meter)
    const auto is_within = [](const Vec3& v, double most) { return glm::length(v) <= most; };
    const auto is_slope = [&](const Mat3& slope) {
        return is_within(slope[0], steepest) && is_within(slope[1], steepest) &&
               is_within(slope[2], steepest);
    };
    if (impl_->is_hand(hand) && limits::is_place(moment.place) &&
        is_within(moment.velocity, limits::fastest) && is_within(moment.force, strongest) &&
        is_slope(moment.by_place) && is_slope(moment.by_velocity) && is_line(moment.line, strongest)) {
        impl_->send(command::SetField{hand, moment});
    }
}

void Session::set_guide_frames(SessionHandle hand, const GuideFrames& frames) {
    if (impl_->is_hand(hand) && std::ranges::all_of(frames, limits::is_pose)) {
        impl_->send(command::SetGuideFrames{hand, frames});
    }
}

void Session::remove_proxy(SessionHandle proxy) {
    if (impl_->proxies.let_go(proxy)) {
        impl_->send(command::RemoveProxy{proxy});
    }
}

AddResult Session::add_tool(std::shared_ptr<const ToolShape> shape, const ToolUse& use) {
    if (shape == nullptr) {
        return {no_handle, "the tool has no shape: give it a closed mesh"};
    }
    if (std::string error = check_tool(use); !error.empty()) {
        return {no_handle, std::move(error)};
    }
    const SessionHandle handle = impl_->take_from(impl_->tools);
    if (handle == no_handle) {
        return {no_handle, "a world takes at most " + std::to_string(max_tools) + " tools: remove one"};
    }
    impl_->note(call::AddTool{handle, shape, use});
    impl_->keep_ways(use.aids);
    const auto make = [&] {
        auto slot = std::make_unique<ToolSlot>(shape, impl_->settings.max_parts, use);
        for (SessionHandle other = 0; other < max_tools; ++other) {
            if (other != handle && impl_->tools.in_use(other)) {
                slot->pairs[other] = ToolPair::make(impl_->tool_shapes[other], shape);
                if (slot->pairs[other] && !slot->group) {
                    slot->group = std::make_unique<ToolGroup>();
                }
            }
        }
        return slot;
    };
    command::AddTool add{handle, make(), impl_->has_twin ? make() : nullptr};
    if (impl_->hears_tools) {
        add.tool->heard = std::make_unique<JitterBuffer<OperatorSample>>();
    }
    impl_->send(std::move(add));
    impl_->tool_shapes[handle] = std::move(shape);
    return {handle, {}};
}

void Session::set_tool(SessionHandle tool, const ToolUse& use) {
    if (impl_->tools.in_use(tool) && check_tool(use).empty()) {
        impl_->keep_ways(use.aids);
        impl_->send(command::SetTool{tool, use});
    }
}

void Session::remove_tool(SessionHandle tool) {
    if (impl_->tools.let_go(tool)) {
        impl_->tool_shapes[tool].reset();
        impl_->send(command::RemoveTool{tool});
    }
}

}  // namespace tactus
