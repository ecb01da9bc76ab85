#include "session/traditional_touch.hpp"

#include <glm/geometric.hpp>

#include "core/safety/limited_force.hpp"

namespace tactus {

namespace {

bool still_holds(const auto& far, SampleSequence sample, bool hears_peer, SampleSequence ticks) {
    return far.sample != no_sample && hears_peer && sample - far.went_on <= ticks;
}

}  // namespace

bool TraditionalTouch::take(const ForceSample& force, SessionHandle touched, SampleSequence now) {
    Far& far = far_[force.pointer];
    if (force.newest_operator_sample < far.sample) {
        return false;
    }
    const SampleSequence went_on = force.newest_operator_sample > far.sample ? now : far.went_on;
    // Whatever it began with is taken as nothing.
    const bool first = far.sample == no_sample;
    // Of two answers to one sample the later one may come first.
    const auto more = static_cast<std::int32_t>(force.taken - far.told_taken);
    const bool is_more = !first && more > 0;
    far = {force.newest_operator_sample,
           went_on,
           force.force,
           force.proxy,
           touched,
           first || is_more ? force.taken : far.told_taken,
           far.taken + (is_more ? energy_quantum * more : 0.0)};
    return true;
}

bool TraditionalTouch::answers(std::size_t index, SampleSequence sample, bool hears_peer,
                               SampleSequence ticks) const {
    return still_holds(far_[index], sample, hears_peer, ticks);
}

void TraditionalTouch::describe(std::size_t index, SessionLoop::ProxySlot& slot, const Vec3& force) const {
    const Far& far = far_[index];
    ProxyState& state = slot.state;
    state.hand = slot.hand;
    state.position = far.sample != no_sample ? far.proxy : slot.hand;
    state.status = 0;
    state.contact_count = 0;
    const double size = glm::length(force);
    if (far.touched != no_handle && size > no_force) {
        state.status = proxy_touching;
        state.contact_count = 1;
        state.bodies[0] = far.touched;
        state.normals[0] = force / size;
        state.points[0] = state.position - slot.proxy->settings().radius * state.normals[0];
    }
}

bool TraditionalTouch::take(const WrenchSample& wrench, SessionHandle touched, SampleSequence now) {
    FarTool& far = far_tools_[wrench.pointer - first_tool];
    if (wrench.newest_operator_sample < far.sample) {
        return false;
    }
    const SampleSequence went_on = wrench.newest_operator_sample > far.sample ? now : far.went_on;
    far = {wrench.newest_operator_sample,
           went_on,
           {wrench.force, wrench.torque},
           wrench.tool,
           touched,
           wrench.fixed};
    return true;
}

bool TraditionalTouch::tool_answers(std::size_t index, SampleSequence sample, bool hears_peer,
                                    SampleSequence ticks) const {
    return still_holds(far_tools_[index], sample, hears_peer, ticks);
}

void TraditionalTouch::describe(std::size_t index, ToolSlot& slot, const Wrench& wrench,
                                bool by_force) const {
    const FarTool& far = far_tools_[index];
    ToolState& state = slot.state;
    state = {};
    state.status = slot.hand.fixed ? static_cast<std::uint32_t>(tool_turn_fixed) : 0u;
    state.hand = slot.hand.goal;
    state.pose = far.sample != no_sample ? far.tool : state.hand;
    const double size = glm::length(wrench.force);
    const bool names_body = far.touched != no_handle;  // else it may be another tool
    if (size > no_force && (by_force || names_body)) {
        state.status |= tool_touching;
    }
    if (size > no_force && names_body) {
        state.contact_count = 1;
        state.bodies[0] = far.touched;
        state.normals[0] = wrench.force / size;
        state.points[0] = state.pose.position;
    }
}

}  // namespace tactus
