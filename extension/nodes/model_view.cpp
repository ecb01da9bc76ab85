#include "nodes/model_view.hpp"

#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/core/object.hpp>

#include "nodes/body_reading.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/mesh_drawing.hpp"

namespace tactus {

using namespace godot;

namespace {

const Color picture_color(0.55F, 0.62F, 0.7F);

}  // namespace

void ModelView::scene_changed(const Node& node) {
    is_scene_new_ |= is_solid_body(&node);
}

void ModelView::hold_still() {
    if (std::exchange(is_scene_new_, false)) {
        hold_still(world_);
    }
}

void ModelView::hold_still(const Node& node) {
    for (int i = 0; i < node.get_child_count(); ++i) {
        if (const auto* body = Object::cast_to<RigidBody3D>(node.get_child(i))) {
            PhysicsServer3D::get_singleton()->body_set_mode(body->get_rid(),
                                                            PhysicsServer3D::BODY_MODE_STATIC);
            held_.insert(body->get_instance_id());
        }
        hold_still(*node.get_child(i));
    }
}

void ModelView::note(const ObjectDescription& description) {
    described_[description.object] = {description.body.pose, description.touch_shapes.empty()
                                                                 ? description.body.shapes
                                                                 : description.touch_shapes};
}

// A name that leads out of the world names nothing.
CollisionObject3D* ModelView::scene_body(const std::string& name) const {
    const String path = to_godot(name);
    if (path.is_empty() || path.begins_with("/")) {
        return nullptr;
    }
    Node* found = world_.get_node_or_null(NodePath(path));
    return found != nullptr && world_.is_ancestor_of(found) && is_solid_body(found)
               ? Object::cast_to<CollisionObject3D>(found)
               : nullptr;
}

Node3D* ModelView::make_picture(const std::string& name, const Description& description) const {
    auto* picture = memnew(Node3D);
    picture->set_name(to_godot(name).get_file().validate_node_name());
    for (const PlacedShape& placed : description.touched) {
        auto* part = memnew(MeshInstance3D);
        part->set_mesh(drawn_mesh(drawn_shape(placed.shape)));
        part->set_material_override(lit_material(picture_color));
        part->set_transform(to_godot(placed.pose));
        picture->add_child(part);
    }
    world_.add_child(picture, true);
    return picture;
}

void ModelView::place(const Shown& shown, const Pose& pose) {
    if (auto* node = Object::cast_to<Node3D>(ObjectDB::get_instance(shown.node))) {
        const Transform3D to = to_godot(pose);
        node->set_global_transform(Transform3D(to.basis * shown.scaling, to.origin));
    }
}

void ModelView::show(Shown& shown, const ModelObject& object) {
    const Description& description = described_[object.object];
    if (CollisionObject3D* body = scene_body(object.name)) {
        shown.node = body->get_instance_id();
        shown.scaling = without_rounding(scaling_of(body->get_global_transform().basis));
    } else {
        shown.node = make_picture(object.name, description)->get_instance_id();
        shown.is_picture = true;
    }
    place(shown, description.pose);
}

void ModelView::hide(const Shown& shown) {
    if (shown.body != no_handle) {
        object_of_body_.erase(shown.body);
    }
    if (auto* picture =
            shown.is_picture ? Object::cast_to<Node>(ObjectDB::get_instance(shown.node)) : nullptr) {
        picture->queue_free();
    }
}

std::vector<ModelNews> ModelView::update(const std::vector<ModelObject>& objects) {
    std::vector<ModelNews> news;
    std::unordered_map<ObjectId, Shown> before = std::move(shown_);
    shown_.clear();
    for (const ModelObject& object : objects) {
        const auto was = before.find(object.object);
        const bool same = was != before.end() && was->second.name == object.name &&
                          was->second.body == object.body && was->second.problem == object.problem;
        Shown shown;
        if (same) {
            shown = was->second;
            before.erase(was);
        } else {
            if (was != before.end()) {
                hide(was->second);
                before.erase(was);
            }
            shown.name = object.name;
            shown.body = object.body;
            shown.problem = object.problem;
            const bool refused = object.body == no_handle;
            if (!refused) {
                show(shown, object);
            }
            news.push_back({refused ? ModelNews::Kind::refused : ModelNews::Kind::discovered,
                            to_godot(object.name), shown.node, to_godot(object.problem)});
        }
        if (shown.body != no_handle) {
            object_of_body_[shown.body] = object.object;
        }
        shown_[object.object] = shown;
    }
    for (const auto& [id, gone] : before) {
        hide(gone);
        described_.erase(id);
        news.push_back({ModelNews::Kind::removed, to_godot(gone.name), 0, String()});
    }
    return news;
}

void ModelView::show(const BodyState& state, std::uint64_t) {
    const auto object = object_of_body_.find(state.handle);
    if (object == object_of_body_.end()) {
        return;
    }
    Shown& shown = shown_[object->second];
    if (shown.changed_at == state.changed_at) {
        return;
    }
    shown.changed_at = state.changed_at;
    place(shown, state.pose);
    if (auto* rigid = Object::cast_to<RigidBody3D>(ObjectDB::get_instance(shown.node))) {
        rigid->set_linear_velocity(to_godot(state.linear_velocity));
        rigid->set_angular_velocity(to_godot(state.angular_velocity));
    }
}

std::uint64_t ModelView::node_of(SessionHandle body) const {
    const auto object = object_of_body_.find(body);
    return object != object_of_body_.end() ? shown_.at(object->second).node : 0;
}

SessionHandle ModelView::body_of(std::uint64_t node) const {
    for (const auto& [id, shown] : shown_) {
        if (shown.node == node) {
            return shown.body;
        }
    }
    return no_handle;
}

void ModelView::release(Session&) {
    for (const auto& [id, shown] : shown_) {
        hide(shown);
    }
    shown_.clear();
    for (const std::uint64_t id : held_) {
        if (const auto* body = Object::cast_to<RigidBody3D>(ObjectDB::get_instance(id))) {
            PhysicsServer3D::get_singleton()->body_set_mode(body->get_rid(), own_mode(*body));
        }
    }
    held_.clear();
}

}  // namespace tactus
