#include "world/hand_twins.hpp"

#include <utility>

namespace tactus {

namespace {

bool same(const Workspace& a, const Workspace& b) {
    return a.pose.position == b.pose.position && a.pose.rotation == b.pose.rotation && a.scale == b.scale &&
           a.force_limit == b.force_limit && a.clutch == b.clutch && a.dead_man == b.dead_man &&
           a.force_scale == b.force_scale && a.edge_speed == b.edge_speed && a.torque == b.torque &&
           a.force == b.force;
}

bool same(const ProxyDescription& a, const ProxyDescription& b) {
    return a.device == b.device && a.settings.radius == b.settings.radius &&
           a.settings.mask == b.settings.mask && a.force_law == b.force_law && a.finger == b.finger &&
           are_same_aids(a.aids, b.aids) && a.enabled == b.enabled;
}

bool same(const ToolUse& a, const ToolUse& b) {
    return a.device == b.device && a.settings.mask == b.settings.mask &&
           a.settings.stiffness == b.settings.stiffness &&
           a.settings.turning_stiffness == b.settings.turning_stiffness &&
           a.settings.layer == b.settings.layer && a.settings.static_friction == b.settings.static_friction &&
           a.settings.dynamic_friction == b.settings.dynamic_friction &&
           a.grasp.position == b.grasp.position && a.grasp.rotation == b.grasp.rotation &&
           are_same_aids(a.aids, b.aids) && a.enabled == b.enabled;
}

// Guides that go along with nodes of the scene, where all else is as it was.
void move_guides(Session& session, SessionHandle hand, const HandAids& before, const HandAids& now) {
    Session::GuideFrames frames;
    bool have_moved = false;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const Pose& was = before.guides[i].frame;
        frames[i] = now.guides[i].frame;
        have_moved = have_moved || frames[i].position != was.position || frames[i].rotation != was.rotation;
    }
    if (have_moved) {
        session.set_guide_frames(hand, frames);
    }
}

}  // namespace

std::string DeviceTwin::synchronise(Session& session, const LoopPace& pace,
                                    const std::shared_ptr<Device>& port, const Workspace& workspace,
                                    RetiredPorts& retired) {
    if (port != port_) {
        remove(session, retired);
        port_ = port;
    }
    if (port_ == nullptr) {
        return {};
    }
    if (handle_ == no_handle) {
        port_->set_pace(pace);
        AddResult added = session.add_device(*port_, workspace);
        handle_ = added.handle;
        sent_ = workspace;
        return std::move(added.error);
    }
    if (!same(workspace, std::exchange(sent_, workspace))) {
        session.set_workspace(handle_, workspace);
    }
    return {};
}

void DeviceTwin::remove(Session& session, RetiredPorts& retired) {
    if (handle_ != no_handle) {
        session.remove_device(handle_);
        handle_ = no_handle;
        retired.push_back(std::move(port_));
    }
    port_.reset();
}

std::string ProxyTwin::synchronise(Session& session, const ProxyDescription& description) {
    if (handle_ == no_handle) {
        AddResult added = session.add_proxy(description);
        handle_ = added.handle;
        sent_ = description;
        return std::move(added.error);
    }
    const ProxyDescription before = std::exchange(sent_, description);
    if (!same(description, before)) {
        session.set_proxy(handle_, description);
    } else {
        move_guides(session, handle_, before.aids, description.aids);
    }
    return {};
}

void ProxyTwin::remove(Session& session) {
    if (handle_ != no_handle) {
        session.remove_proxy(handle_);
        handle_ = no_handle;
    }
}

std::string ToolTwin::synchronise(Session& session, const std::shared_ptr<const ToolShape>& shape,
                                  const ToolUse& use) {
    if (shape != shape_) {
        remove(session);
        shape_ = shape;
    }
    if (shape_ == nullptr) {
        return {};
    }
    if (handle_ == no_handle) {
        AddResult added = session.add_tool(shape_, use);
        handle_ = added.handle;
        sent_ = use;
        return std::move(added.error);
    }
    const ToolUse before = std::exchange(sent_, use);
    if (!same(use, before)) {
        session.set_tool(handle_, use);
    } else {
        move_guides(session, hand_of_tool(handle_), before.aids, use.aids);
    }
    return {};
}

void ToolTwin::remove(Session& session) {
    if (handle_ != no_handle) {
        session.remove_tool(handle_);
        handle_ = no_handle;
    }
    shape_.reset();
}

}  // namespace tactus
