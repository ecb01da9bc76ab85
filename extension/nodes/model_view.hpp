// Where the operator is: the bodies of the far side, shown. A body of this scene that has the same path below
// its HapticWorld shows its far twin; where there is none, a picture is made. Main thread only.
#pragma once

#include <godot_cpp/classes/collision_object3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "nodes/scene_view.hpp"
#include "world/model_roll.hpp"

namespace tactus {

class HapticWorld;

class ModelView final : public SceneView {
public:
    // The rigid bodies of this scene stay where they are until the far side says where they should be.
    explicit ModelView(HapticWorld& world);

    void scene_changed(godot::Node& node, bool comes) override;
    SessionHandle body_of(std::uint64_t node) const override { return roll_.body_of(node); }
    std::uint64_t node_of(SessionHandle body) const override { return roll_.node_of(body); }
    std::size_t body_count() const override { return roll_.size(); }
    void show(const BodyState& state, std::uint64_t tick, Session& session) override;
    // Takes the pictures away, too.
    void release(Session& session) override;

    // Described just now, before it is built.
    void note(const ObjectDescription& description) { roll_.note(description); }

    // True once after bodies of this scene have come or gone: update() may show something else then.
    bool takes_scene_change() { return std::exchange(shows_other_scene_, false); }
    // The bodies of this scene that the far side has not described: hands pass through them.
    std::vector<const godot::Node*> bodies_only_here() const;

    // Brings nodes and bodies together; says what has become of which.
    std::vector<ModelNews> update(const std::vector<ModelObject>& objects);

private:
    void hold_still(const godot::RigidBody3D& body, bool held);
    ModelRoll::Shown show(const std::string& name, const ModelRoll::Form& form) const;
    bool is_shown(const std::string& name, const ModelRoll::Shown& shown) const;
    godot::CollisionObject3D* scene_body(const std::string& name) const;
    godot::Node3D* make_picture(const std::string& name, const ModelRoll::Form& form) const;

    HapticWorld& world_;
    bool shows_other_scene_ = false;
    std::unordered_set<std::uint64_t> held_;  // rigid bodies of the scene
    ModelRoll roll_;
};

}  // namespace tactus
