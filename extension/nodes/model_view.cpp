#include "nodes/model_view.hpp"

#include <godot_cpp/classes/mesh_instance3d.hpp>

#include "nodes/body_reading.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/mesh_drawing.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

const Color picture_color(0.28F, 0.32F, 0.38F);

// Rigid bodies below it stay where they are. May call a script, which may free any of them.
void place(const ModelRoll::Shown& shown, const Pose& pose) {
    auto* node = node_of_id<Node3D>(shown.node);
    if (node == nullptr) {
        return;
    }
    std::vector<std::pair<std::uint64_t, Transform3D>> below;
    for (const std::uint64_t id : shown.carried) {
        if (const auto* carried = node_of_id<Node3D>(id); carried != nullptr && carried->is_inside_tree()) {
            below.emplace_back(id, carried->get_global_transform());
        }
    }
    node->set_global_transform(to_godot(pose, shown.scaling));
    for (const auto& [id, at] : below) {
        if (auto* carried = node_of_id<Node3D>(id); carried != nullptr && carried->is_inside_tree()) {
            carried->set_global_transform(at);
        }
    }
}

void hide(const ModelRoll::Shown& shown) {
    if (shown.is_picture) {
        free_later(shown.node);
    }
}

}  // namespace

ModelView::ModelView(HapticWorld& world) : world_(world) {
    for_each_below(world_, [this](const Node& node) {
        if (const auto* body = Object::cast_to<RigidBody3D>(&node)) {
            hold_still(*body, true);
        }
    });
}

void ModelView::scene_changed(Node& node, bool comes) {
    const std::uint64_t id = node.get_instance_id();
    shows_other_scene_ |= is_solid_body(&node) || roll_.body_of(id) != no_handle;
    auto* body = Object::cast_to<RigidBody3D>(&node);
    if (body != nullptr && (comes ? world_.is_ancestor_of(body) : held_.contains(id))) {
        hold_still(*body, comes);
    }
}

void ModelView::hold_still(const RigidBody3D& body, bool held) {
    tactus::hold_still(body, held);
    if (held) {
        held_.insert(body.get_instance_id());
    } else {
        held_.erase(body.get_instance_id());
    }
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

Node3D* ModelView::make_picture(const std::string& name, const ModelRoll::Form& form) const {
    auto* picture = memnew(Node3D);
    picture->set_name(to_godot(name).get_file().validate_node_name());
    for (const PlacedShape& placed : form.touched) {
        auto* part = memnew(MeshInstance3D);
        part->set_mesh(drawn_mesh(drawn_shape(placed.shape)));
        part->set_material_override(lit_material(picture_color));
        part->set_transform(to_godot(placed.pose));
        picture->add_child(part);
    }
    world_.add_child(picture, true);
    return picture;
}

ModelRoll::Shown ModelView::show(const std::string& name, const ModelRoll::Form& form) const {
    ModelRoll::Shown shown;
    if (const CollisionObject3D* body = scene_body(name)) {
        shown.node = body->get_instance_id();
        shown.scaling = scaling_of(frame_of(body->get_global_transform()));
        for_each_below(*body, [&shown](const Node& node) {
            if (Object::cast_to<RigidBody3D>(&node) != nullptr) {
                shown.carried.push_back(node.get_instance_id());
            }
        });
    } else {
        shown.node = make_picture(name, form)->get_instance_id();
        shown.is_picture = true;
    }
    place(shown, form.pose);
    return shown;
}

std::vector<ModelNews> ModelView::update(const std::vector<ModelObject>& objects) {
    return roll_.update(
        objects, [this](const std::string& name, const ModelRoll::Form& form) { return show(name, form); },
        hide,
        [this](const std::string& name, const ModelRoll::Shown& shown) { return is_shown(name, shown); });
}

bool ModelView::is_shown(const std::string& name, const ModelRoll::Shown& shown) const {
    const CollisionObject3D* const body = scene_body(name);
    if (body != nullptr) {
        return body->get_instance_id() == shown.node;
    }
    auto* const picture = node_of_id<Node>(shown.node);
    return shown.is_picture && picture != nullptr && world_.is_ancestor_of(picture);
}

std::vector<const Node*> ModelView::bodies_only_here() const {
    std::vector<const Node*> all;
    for_each_below(world_, [&](const Node& node) {
        if (is_solid_body(&node) && roll_.body_of(node.get_instance_id()) == no_handle) {
            all.push_back(&node);
        }
    });
    return all;
}

void ModelView::show(const BodyState& state, std::uint64_t, Session&) {
    ModelRoll::Shown* const shown = roll_.shown(state.handle);
    if (shown == nullptr || std::exchange(shown->changed_at, state.changed_at) == state.changed_at) {
        return;
    }
    const std::uint64_t node = shown->node;
    place(*shown, state.pose);  // may call a script that ends all this
    if (auto* rigid = node_of_id<RigidBody3D>(node)) {
        rigid->set_linear_velocity(to_godot(state.linear_velocity));
        rigid->set_angular_velocity(to_godot(state.angular_velocity));
    }
}

void ModelView::release(Session&) {
    roll_.hide_all(hide);
    for (const std::uint64_t id : std::exchange(held_, {})) {
        if (const auto* body = node_of_id<RigidBody3D>(id)) {
            tactus::hold_still(*body, false);
        }
    }
}

}  // namespace tactus
