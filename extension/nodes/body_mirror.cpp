#include "nodes/body_mirror.hpp"

#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/core/object.hpp>

#include "nodes/conversions.hpp"
#include "nodes/haptic_mesh.hpp"

namespace tactus {

using namespace godot;

CollisionObject3D* BodyMirror::body() const {
    return Object::cast_to<CollisionObject3D>(ObjectDB::get_instance(id_));
}

// Static, for the engine's own physics: it then neither moves the body nor calls back with a place of its
// own, and what is outside the world still finds the body where it is.
void BodyMirror::hold_still_in_godot(CollisionObject3D& body) const {
    PhysicsServer3D* server = PhysicsServer3D::get_singleton();
    if (is_rigid(body) && server->body_get_mode(body.get_rid()) != PhysicsServer3D::BODY_MODE_STATIC) {
        server->body_set_mode(body.get_rid(), PhysicsServer3D::BODY_MODE_STATIC);
    }
}

void BodyMirror::remember_place(CollisionObject3D& body) {
    place_ = body.get_global_transform();
    if (const auto* rigid = Object::cast_to<RigidBody3D>(&body)) {
        linear_velocity_ = rigid->get_linear_velocity();
        angular_velocity_ = rigid->get_angular_velocity();
    }
}

BodyPlace BodyMirror::remembered() const {
    return {pose_of(place_), from_godot(linear_velocity_), from_godot(angular_velocity_)};
}

// Godot tells of changes of what it is made of from now on.
void BodyMirror::listen(CollisionObject3D& node, const Ref<PhysicsMaterial>& material,
                        const MirrorContext& context) {
    if (ObjectDB::get_instance(watch_) == nullptr) {
        watch_ = BodyWatch::put_into(node, context.news);
    }
    std::vector<Ref<Resource>> resources;
    for (const Ref<Shape3D>& shape : shapes_of(node)) {
        resources.push_back(shape);
    }
    material_ = material.is_valid() ? material->get_instance_id() : 0;
    if (material.is_valid()) {
        resources.push_back(material);
    }
    BodyWatch::listen_to(watch_, resources);
}

// Reads the body as it is and has a twin of it built: at once where that takes no time. What the workers
// build is handed over where everybody's is, or the order of bodies, which physics computes in, would depend
// on how fast they are.
void BodyMirror::plan(Session& session, const MirrorContext& context) {
    CollisionObject3D& node = *body();
    tried_ = true;
    place_problem_.clear();
    was_nowhere_ = !problem_of_place(node.get_global_transform()).empty();
    key_ = shape_key(node, node.get_global_transform());
    mesh_changes_ = HapticMesh::changes();
    const Ref<PhysicsMaterial> material = material_of(node);
    listen(node, material, context);
    if (handle() == no_handle) {
        remember_place(node);
    }
    BodyForm form = read_form(node);
    if (form.touchable) {
        hold_still_in_godot(node);
    }
    const bool ready = twin_.plan({std::move(form), read_values(node, material, context.defaults),
                                   read_makings(node), remembered(), is_rigid(node)},
                                  *context.workers);
    if (ready) {
        take_ready(session, context);
    }
}

void BodyMirror::take_ready(Session& session, const MirrorContext& context) {
    CollisionObject3D* node = body();
    if (node != nullptr && twin_.take_ready(session, context.takes_effect)) {
        hold_still_in_godot(*node);
        remember_place(*node);
        twin_.stand_at(session, remembered());
    }
}

bool BodyMirror::needs_a_new_twin(CollisionObject3D& node, const Transform3D& place, bool shapes_changed) {
    const bool is_back = was_nowhere_ && problem_of_place(place).empty();
    if (!tried_ || is_back || !(read_makings(node) == twin_.planned().makings) ||
        !(shape_key(node, place) == key_)) {
        return true;
    }
    if (!shapes_changed && mesh_changes_ == HapticMesh::changes()) {
        return false;
    }
    mesh_changes_ = HapticMesh::changes();
    return !same_form(read_form(node), twin_.planned().form);
}

std::vector<std::string> BodyMirror::problems() const {
    std::vector<std::string> all = twin_.problems();
    if (!place_problem_.empty()) {
        all.push_back(place_problem_);
    }
    return all;
}

void BodyMirror::send_place(const Transform3D& place, Session& session, double seconds,
                            std::uint64_t takes_effect) {
    if (place == place_) {
        place_problem_.clear();
        return;
    }
    place_problem_ = problem_of_place(place);
    if (place_problem_.empty()) {
        place_ = place;
        twin_.set_pose(session, pose_of(place_), seconds, takes_effect);
    }
}

void BodyMirror::send_speed(const CollisionObject3D& node, Session& session, std::uint64_t takes_effect) {
    const auto* rigid = Object::cast_to<RigidBody3D>(&node);
    if (rigid == nullptr || twin_.values().motion != Motion::Dynamic) {
        return;
    }
    const Vector3 linear = rigid->get_linear_velocity();
    const Vector3 angular = rigid->get_angular_velocity();
    if (!(linear == linear_velocity_) || !(angular == angular_velocity_)) {
        linear_velocity_ = linear;
        angular_velocity_ = angular;
        twin_.set_velocity(session, from_godot(linear), from_godot(angular), takes_effect);
    }
}

void BodyMirror::synchronise(Session& session, const MirrorContext& context, double seconds) {
    CollisionObject3D* node = body();
    if (node == nullptr) {
        return;
    }
    const Transform3D place = node->get_global_transform();
    if (needs_a_new_twin(*node, place, context.shapes_changed)) {
        plan(session, context);
    }
    if (handle() != no_handle) {
        hold_still_in_godot(*node);
        const Ref<PhysicsMaterial> material = material_of(*node);
        twin_.set_values(session, read_values(*node, material, context.defaults));
        if (material_ != (material.is_valid() ? material->get_instance_id() : 0)) {
            listen(*node, material, context);
        }
        send_place(place, session, seconds, context.takes_effect);
        send_speed(*node, session, context.takes_effect);
    }
}

bool BodyMirror::follow(Session& session, const MirrorContext& context, double seconds) {
    CollisionObject3D* node = handle() != no_handle ? body() : nullptr;
    if (node == nullptr) {
        return false;
    }
    send_place(node->get_global_transform(), session, seconds, context.takes_effect);
    send_speed(*node, session, context.takes_effect);
    return !place_problem_.empty();
}

void BodyMirror::follow_speed(Session& session, const MirrorContext& context) {
    if (const CollisionObject3D* node = handle() != no_handle ? body() : nullptr) {
        send_speed(*node, session, context.takes_effect);
    }
}

// Moving the node may call a script, which may let it go.
void BodyMirror::apply(const BodyState& state, std::uint64_t tick) {
    auto* rigid = place_problem_.empty() ? Object::cast_to<RigidBody3D>(body()) : nullptr;
    if (rigid == nullptr || !twin_.takes(state, tick)) {
        return;
    }
    const Transform3D pose = to_godot(state.pose);
    rigid->set_linear_velocity(to_godot(state.linear_velocity));
    rigid->set_angular_velocity(to_godot(state.angular_velocity));
    rigid->set_global_transform(Transform3D(pose.basis * key_.scaling, pose.origin));
    if (ObjectDB::get_instance(id_) != nullptr && rigid->is_inside_tree()) {
        remember_place(*rigid);
    }
}

void BodyMirror::release(Session& session) {
    twin_.remove(session);
    tried_ = false;
    BodyWatch::take_out(std::exchange(watch_, 0));
    if (auto* rigid = Object::cast_to<RigidBody3D>(body())) {
        PhysicsServer3D::get_singleton()->body_set_mode(rigid->get_rid(), own_mode(*rigid));
    }
}

}  // namespace tactus
