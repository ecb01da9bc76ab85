// The bodies that a world shows: those of its scene (body_mirrors.hpp), or, at the operator of a
// teleoperation, those of the far side (model_view.hpp). Main thread only.
#pragma once

#include <cstdint>
#include <godot_cpp/classes/node.hpp>

#include "session/session.hpp"

namespace tactus {

class SceneView {
public:
    virtual ~SceneView() = default;

    // A node has come, or is about to go (`comes` is false).
    virtual void scene_changed(godot::Node& node, bool comes) = 0;
    virtual SessionHandle body_of(std::uint64_t node) const = 0;  // no_handle: the node is none of its bodies
    virtual std::uint64_t node_of(SessionHandle body) const = 0;  // that shows the body; 0: none
    virtual std::size_t body_count() const = 0;
    // The states of a snapshot are shown next.
    virtual void begin_to_show() {}
    // `tick` is the tick of the snapshot that the state is from. May call a script.
    virtual void show(const BodyState& state, std::uint64_t tick, Session& session) = 0;
    // Gives all back to Godot's own physics.
    virtual void release(Session& session) = 0;
};

}  // namespace tactus
