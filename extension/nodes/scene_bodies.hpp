// What a running world finds below itself: the bodies and joints of Godot's scene, given to what mirrors them
// (world/body_mirrors.hpp). Main thread only.
#pragma once

#include <godot_cpp/classes/collision_object3d.hpp>

#include <unordered_set>

#include "nodes/close_shapes.hpp"
#include "nodes/godot_body.hpp"
#include "nodes/scene_view.hpp"
#include "nodes/server_bodies.hpp"

namespace tactus {

class SceneBodies final : public SceneView {
public:
    // `in_turn`: see BodyMirrors; `engine_moves`: see MirrorContext.
    SceneBodies(const godot::Node3D& world, std::size_t max_bodies, bool in_turn, bool engine_moves,
                Complaints& complaints)
        : scene_{world, complaints, false, engine_moves},
          mirrors_(max_bodies, in_turn),
          server_bodies_(scene_, max_bodies, in_turn) {}

    void scene_changed(godot::Node& node, bool comes) override;
    SessionHandle body_of(std::uint64_t node) const override { return mirrors_.body_of(node); }
    std::uint64_t node_of(SessionHandle body) const override;
    std::size_t body_count() const override { return mirrors_.in_session(); }
    void begin_to_show() override;
    void show(const BodyState& state, std::uint64_t tick, Session& session) override {
        mirrors_.show(state, tick, session);
    }
    void release(Session& session) override;

    // Godot's own physics is about to step, maybe several times before the next synchronise(): a body that
    // has come would begin in the session with a place and a velocity that nothing there has given it.
    void hold_arrived();
    // Brings the session up to date with all that stands below the world.
    void synchronise(MirrorContext context);
    // Godot's own physics moves the bodies and is about to step; what is close to hands is found here.
    void exchange(PhysicsFrame frame);

    BodyMirrors& mirrors() { return mirrors_; }
    const BodyMirrors& mirrors() const { return mirrors_; }
    // Of its bodies and joints, and of what else stands below the world; each names its node.
    std::vector<std::string> problems() const;
    godot::CollisionObject3D* node(std::size_t index) const;  // of mirrors().bodies(); null: it is gone

private:
    void find(Session& session);
    void say_passed_over(const godot::Node& node);

    GodotScene scene_;
    BodyMirrors mirrors_;
    CloseShapes close_;
    ServerBodies server_bodies_;
    std::unordered_set<std::uint64_t> arrived_;  // rigid bodies that no mirror has yet
    std::unordered_set<std::uint64_t> held_;     // the same, held still by now
    std::vector<std::uint64_t> others_;          // nodes that have come and are none of ours
    bool is_first_look_ = true;
    bool tree_changed_ = true;
};

}  // namespace tactus
