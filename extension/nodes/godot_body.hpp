// One of Godot's bodies as what mirrors it sees it (world/scene_body.hpp). Main thread only.
#pragma once

#include <godot_cpp/classes/rigid_body3d.hpp>
#include <memory>

#include "nodes/body_reading.hpp"
#include "nodes/body_watch.hpp"
#include "nodes/messages.hpp"
#include "world/body_mirrors.hpp"

namespace tactus {

class GodotBody final : public SceneBody, private BodyWatch::Listener {
public:
    // `world` is the node that it stands below; both it and `complaints` are there until let_go().
    GodotBody(godot::CollisionObject3D& node, const godot::Node& world, std::shared_ptr<BodyNews> news,
              Complaints& complaints);

    std::uint64_t id() const override { return id_; }
    bool is_there() const override;
    bool is_in_scene() const override;

    std::string name() const override { return from_godot(name_of(node_)); }
    std::string path() const override;
    bool can_be_thrown() const override { return rigid_ != nullptr; }
    SceneFrame frame() const override { return frame_of(node_.get_global_transform()); }
    SceneSpeed speed() const override;
    BodyMakings makings() const override;
    ShapeKey shape_key() const override;
    BodyForm form() const override { return read_form(node_); }
    BodyValues values(const BodyDefaults& defaults) override;

    void hold_still() override;
    void listen() override;
    void tell_of_moves(bool tell) override;
    void let_go() override;

    SceneSpeed set_speed(const SceneSpeed& speed) override;
    SceneFrame stand_at(const Pose& pose, const Mat3& scaling) override;

    void say(const std::string& problem) const override { complaints_.say(node_, problem); }

private:
    void has_moved() override { news_->moved.push_back(id_); }
    void has_changed() override { news_->changed.push_back(id_); }
    void is_in_tree(bool now) override { is_in_tree_ = now; }
    void watch_has_gone() override { watch_ = nullptr; }

    std::uint64_t id_;
    godot::CollisionObject3D& node_;  // while it is there
    godot::RigidBody3D* rigid_;       // the same; null where it is none
    BodyWatch* watch_ = nullptr;      // null: Godot takes none at the moment, or it has gone
    bool is_in_tree_ = false;         // while there is a watch
    std::uint64_t material_ = 0;      // id of the PhysicsMaterial that it listens to; 0: none
    const godot::Node& world_;
    std::shared_ptr<BodyNews> news_;
    Complaints& complaints_;
};

}  // namespace tactus
