// What can be felt and is no body of the scene tree: tiles of a GridMap, CSG, bones of a ragdoll, terrain,
// and what else extensions and scripts have made by the PhysicsServer3D. Only where Godot's own physics moves
// the bodies, and only close to a hand. Main thread.
//
// Such a body may be freed at any time, and its RID says nothing of that. So it is read only in exchange(),
// for shapes that the space has just found.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "nodes/close_shapes.hpp"
#include "nodes/godot_body.hpp"

namespace tactus {

// A shape of a body that is still or moved by a script, or all shapes of one that physics moves.
struct ServerPart {
    static constexpr int all_shapes = -1;

    std::uint64_t id = 0;  // among the mirrors
    std::uint64_t owner = 0;
    godot::RID body;
    int shape = all_shapes;
    bool is_there = true;

    // As of the last frame.
    SceneFrame frame;
    SceneSpeed speed;

    // As of the last reading.
    BodyMakings makings;
    BodyValues values;
    ShapeKey key;
    BodyForm form;
};

class ServerBodies {
public:
    // `scene` outlives this. `in_turn`: see BodyMirrors.
    ServerBodies(const GodotScene& scene, std::size_t max_bodies, bool in_turn)
        : scene_(scene), mirrors_(max_bodies, in_turn) {}

    // `close`: shapes about the hands that no body of the scene tree has. Those of a node that is not below
    // the world are left out.
    void exchange(std::span<const CloseShape> close, PhysicsFrame frame);
    void synchronise(const MirrorContext& context);
    void release(Session& session) { mirrors_.release(session); }

    // Id of the node that the body belongs to; 0: none, or it is none of these bodies.
    std::uint64_t owner_of(SessionHandle body) const;
    const BodyMirrors& mirrors() const { return mirrors_; }

private:
    bool is_felt(const CloseShape& shape) const;
    void find(std::span<const CloseShape> close);

    const GodotScene& scene_;
    BodyMirrors mirrors_;
    std::map<std::pair<std::uint64_t, int>, std::shared_ptr<ServerPart>> parts_;  // by body and shape
    std::vector<std::uint64_t> ids_;                                              // of all of them
    std::uint64_t last_id_ = 0;
    std::uint64_t frames_ = 0;
    bool has_changed_ = false;
};

}  // namespace tactus
