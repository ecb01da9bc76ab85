// What can be felt and is no body of the scene tree: tiles of a GridMap, CSG, bones of a ragdoll, terrain,
// soft bodies, and what else extensions and scripts have made by the PhysicsServer3D. Only where Godot's own
// physics moves the bodies, and only close to a hand. Main thread.
//
// Such a body may be freed at any time, and its RID says nothing of that. So it is read only in exchange(),
// for shapes that the space has just found.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "nodes/close_shapes.hpp"
#include "nodes/godot_body.hpp"
#include "nodes/soft_surface.hpp"

namespace tactus {

// A shape of a body that is still or moved by a script, or all shapes of one that physics moves, or the
// surface of a soft body.
struct ServerPart {
    static constexpr int all_shapes = -1;

    std::uint64_t id = 0;  // among the mirrors
    std::uint64_t owner = 0;
    godot::RID body;
    int shape = all_shapes;
    std::shared_ptr<SoftSurface> soft;  // null: it is none
    bool is_there = true;

    // As of the last frame.
    SceneFrame frame;
    SceneSpeed speed;

    // As of the last reading.
    BodyMakings makings;
    BodyValues values;
    ShapeKey key;
    BodyForm form;
    double frame_seconds = 0.0;
};

class ServerBodies {
public:
    // `scene` outlives this. `in_turn`: see BodyMirrors.
    ServerBodies(const GodotScene& scene, std::size_t max_bodies, bool in_turn)
        : scene_(scene), mirrors_(max_bodies, in_turn) {}

    // Ids of all SoftBody3D nodes below the world.
    void set_soft_bodies(std::vector<std::uint64_t> ids) { soft_bodies_ = std::move(ids); }
    // `close`: shapes about the hands that no body of the scene tree has. Those of a node that is not below
    // the world are left out. Soft bodies are felt within `radius` of a hand (unit: meters).
    void exchange(std::span<const CloseShape> close, double radius, PhysicsFrame frame);
    void synchronise(const MirrorContext& context);
    void release(Session& session) { mirrors_.release(session); }

    // Id of the node that the body belongs to; 0: none, or it is none of these bodies.
    std::uint64_t owner_of(SessionHandle body) const;
    const BodyMirrors& mirrors() const { return mirrors_; }

private:
    // The soft body that a hand touched last, and where.
    struct Pressing {
        std::weak_ptr<SoftSurface> surface;
        Vec3 point{0.0};
    };

    bool is_felt(const CloseShape& shape) const;
    void find(std::span<const CloseShape> close, double radius, const PhysicsFrame& frame);
    void find_soft(double radius, const PhysicsFrame& frame);
    void find_soft(std::uint64_t owner, const std::shared_ptr<SoftSurface>& surface,
                   const PhysicsFrame& frame);
    bool read_again(ServerPart& part) const;
    const ServerPart* part_of(SessionHandle body) const;  // null: it is none of these
    void push_soft(const PhysicsFrame& frame);
    void push_soft(const ProxyState& hand, const Vec3& impulse);

    const GodotScene& scene_;
    BodyMirrors mirrors_;
    std::map<std::pair<std::uint64_t, int>, std::shared_ptr<ServerPart>> parts_;  // by body and shape
    std::vector<std::uint64_t> ids_;                                              // of all of them
    std::vector<std::uint64_t> soft_bodies_;
    std::map<std::uint64_t, std::shared_ptr<SoftSurface>> surfaces_;  // of these, in the tree
    std::array<Pressing, max_proxies> pressing_;                      // by hand
    std::array<Vec3, max_proxies> received_{};  // SessionSnapshot's, of the frame before
    std::uint64_t last_id_ = 0;
    std::uint64_t frames_ = 0;
    bool has_changed_ = false;
};

}  // namespace tactus
