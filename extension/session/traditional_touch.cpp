#include "session/traditional_touch.hpp"

#include <glm/geometric.hpp>

namespace tactus {

namespace {

// A force below this is none (unit: newtons).
constexpr double no_force = 1e-9;

}  // namespace

bool TraditionalTouch::take(const ForceSample& force, SessionHandle touched) {
    Far& far = far_[force.pointer];
    if (force.newest_operator_sample < far.sample) {
        return false;
    }
    far = {force.newest_operator_sample, force.force, force.proxy, touched};
    return true;
}

bool TraditionalTouch::answers(std::size_t index, SampleSequence sample, double tick_seconds,
                               bool hears_peer) const {
    const Far& far = far_[index];
    const double silence = static_cast<double>(sample - far.sample) * tick_seconds;
    return far.sample != no_sample && hears_peer && silence <= longest_silence;
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

}  // namespace tactus
