// One of Godot's bodies as what mirrors it sees it (world/scene_body.hpp). Main thread only.
#pragma once

#include <godot_cpp/classes/rigid_body3d.hpp>
#include <memory>

#include "nodes/body_reading.hpp"
#include "nodes/body_watch.hpp"
#include "nodes/messages.hpp"
#include "world/body_mirrors.hpp"

namespace tactus {

class HapticMesh;

// What the bodies of a world share.
struct GodotScene {
    const godot::Node3D& world;  // that they stand below
    Complaints& complaints;
    bool is_at_origin = false;  // the world, as of this frame: a place in it is a place below it
    bool engine_moves = false;  // Godot's own physics moves its bodies
};

class GodotBody final : public SceneBody, private BodyWatch::Listener {
public:
    // The scene is there until let_go().
    GodotBody(godot::CollisionObject3D& node, const GodotScene& scene, std::shared_ptr<BodyNews> news);

    std::uint64_t id() const override { return id_; }
    bool is_there() const override;
    bool is_in_scene() const override;

    std::string name() const override { return from_godot(name_of(node_)); }
    std::string path() const override;
    bool can_be_thrown() const override { return rigid_ != nullptr; }
    std::uint64_t carrier() const override;
    SceneFrame frame() const override { return frame_of(node_.get_global_transform()); }
    SceneSpeed speed() const override;
    BodyMakings makings(const Mat3& scaling) const override;
    ShapeKey shape_key() const override;
    BodyForm form(const Mat3& scaling) const override {
        return read_form(node_, scaling, scene_.engine_moves);
    }
    BodyValues values(const BodyDefaults& defaults) override;

    BodyMotion true_motion() const override;
    void push(const Vec3& impulse, const Vec3& turn) override;
    void hold_still(bool held) override;
    void listen() override;
    void tell_of_moves(bool tell) override;
    void let_go() override;

    SceneSpeed set_speed(const SceneSpeed& speed) override;
    SceneFrame stand_at(const Pose& pose, const Mat3& scaling) override;
    SceneFrame put_back(const SceneFrame& frame) override { return put(to_godot(frame)); }

    void say(const std::string& problem) const override { scene_.complaints.say(node_, problem); }

private:
    SceneFrame put(const godot::Transform3D& place);
    void has_moved() override { news_->moved.push_back(id_); }
    void has_changed() override { news_->changed.push_back(id_); }
    void is_in_tree(bool now) override;
    std::vector<godot::Ref<godot::Resource>> material_resources(const HapticMesh* mesh) const;
    void watch_has_gone() override { watch_ = nullptr; }

    std::uint64_t id_;
    godot::CollisionObject3D& node_;        // while it is there
    godot::RigidBody3D* rigid_;             // the same; null where it is none
    BodyWatch* watch_ = nullptr;            // null: Godot takes none at the moment, or it has gone
    bool is_in_tree_ = false;               // while there is a watch; likewise the next one
    bool is_below_world_ = false;           // directly
    std::vector<std::uint64_t> materials_;  // ids of those that it listens to; the watch holds them
    const GodotScene& scene_;
    std::shared_ptr<BodyNews> news_;
};

}  // namespace tactus
