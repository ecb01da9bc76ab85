// Where the operator is: the bodies of the far side, shown. A body of this scene that has the same path below
// its HapticWorld shows its far twin; where there is none, a picture is made. Main thread only.
#pragma once

#include <godot_cpp/classes/collision_object3d.hpp>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/geometry/shape.hpp"
#include "network/messages.hpp"
#include "nodes/scene_view.hpp"
#include "session/model_builder.hpp"

namespace tactus {

class HapticWorld;

// What has happened to an object of the far side.
struct ModelNews {
    enum class Kind { discovered, removed, refused } kind = Kind::discovered;
    godot::String name;
    std::uint64_t node = 0;  // that shows it
    godot::String why;       // it was refused
};

class ModelView final : public SceneView {
public:
    explicit ModelView(HapticWorld& world) : world_(world) {}

    // The bodies of this scene. They stay where they are until the far side says where they should be.
    void hold_still();
    void scene_changed(const godot::Node& node) override;
    SessionHandle body_of(std::uint64_t node) const override;
    std::uint64_t node_of(SessionHandle body) const override;
    std::size_t body_count() const override { return shown_.size(); }
    void show(const BodyState& state, std::uint64_t tick) override;
    // Takes the pictures away, too.
    void release(Session& session) override;

    // Described just now, before it is built.
    void note(const ObjectDescription& description);

    // Brings nodes and bodies together; says what has become of which.
    std::vector<ModelNews> update(const std::vector<ModelObject>& objects);

private:
    struct Description {
        Pose pose;
        std::vector<PlacedShape> touched;
    };
    struct Shown {
        std::string name;
        SessionHandle body = no_handle;
        std::uint64_t node = 0;
        bool is_picture = false;       // made here
        godot::Basis scaling;          // of a node of the scene
        std::uint64_t changed_at = 0;  // BodyState::changed_at that is shown
        std::string problem;
    };

    void hold_still(const godot::Node& node);
    void show(Shown& shown, const ModelObject& object);
    void hide(const Shown& shown);
    godot::CollisionObject3D* scene_body(const std::string& name) const;
    godot::Node3D* make_picture(const std::string& name, const Description& description) const;
    static void place(const Shown& shown, const Pose& pose);

    HapticWorld& world_;
    bool is_scene_new_ = true;
    std::unordered_set<std::uint64_t> held_;  // rigid bodies of the scene
    std::unordered_map<ObjectId, Description> described_;
    std::unordered_map<ObjectId, Shown> shown_;
    std::unordered_map<SessionHandle, ObjectId> object_of_body_;
};

}  // namespace tactus
