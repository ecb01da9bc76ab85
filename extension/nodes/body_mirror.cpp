#include "nodes/body_mirror.hpp"

#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/core/object.hpp>

#include "nodes/conversions.hpp"
#include "nodes/haptic_mesh.hpp"

namespace tactus {

using namespace godot;

BodyMirror::BodyMirror(CollisionObject3D& body)
    : id_(body.get_instance_id()), body_(&body), rigid_(Object::cast_to<RigidBody3D>(&body)) {}

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
    if (rigid_ != nullptr) {
        linear_velocity_ = rigid_->get_linear_velocity();
        angular_velocity_ = rigid_->get_angular_velocity();
    }
}

BodyPlace BodyMirror::remembered() const {
    return {pose_of(place_), from_godot(linear_velocity_), from_godot(angular_velocity_)};
}

// Godot tells of changes of what it is made of from now on.
void BodyMirror::listen(CollisionObject3D& node, const Ref<PhysicsMaterial>& material,
                        const MirrorContext& context) {
    if (ObjectDB::get_instance(watch_) == nullptr) {
        watch_ = BodyWatch::put_into(node, context.news, place_);
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
void BodyMirror::plan(const MirrorContext& context) {
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
    BodyPlan plan{std::move(form), read_values(node, material, context.defaults), read_makings(node),
                  remembered(), is_rigid(node)};
    if (twin_.plan(std::move(plan), context.workers)) {
        hand_over(context);
    }
}

void BodyMirror::hand_over(const MirrorContext& context) {
    CollisionObject3D* node = body();
    if (node != nullptr && twin_.take_ready(context.session, context.takes_effect)) {
        hold_still_in_godot(*node);
        remember_place(*node);
        twin_.stand_at(context.session, remembered());
    }
}

void BodyMirror::take_ready(const MirrorContext& context) {
    hand_over(context);
    say_problems(context.complaints);
}

void BodyMirror::say_problems(Complaints& complaints) const {
    if (const CollisionObject3D* node = body()) {
        for (const std::string& problem : problems()) {
            complaints.say(*node, problem);
        }
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

void BodyMirror::send_place(const Transform3D& place, const MirrorContext& context) {
    if (place == place_) {
        place_problem_.clear();
        return;
    }
    place_problem_ = problem_of_place(place);
    if (place_problem_.empty()) {
        place_ = place;
        twin_.set_pose(context.session, pose_of(place_), context.seconds, context.takes_effect);
    }
}

// One that is no number is none, and is written over.
bool BodyMirror::has_other_speed() const {
    const Vector3 linear = rigid_->get_linear_velocity();
    const Vector3 angular = rigid_->get_angular_velocity();
    return linear.is_finite() && angular.is_finite() &&
           !(linear == linear_velocity_ && angular == angular_velocity_);
}

void BodyMirror::send_speed(const MirrorContext& context) {
    if (rigid_ != nullptr && twin_.values().motion == Motion::Dynamic && has_other_speed()) {
        linear_velocity_ = rigid_->get_linear_velocity();
        angular_velocity_ = rigid_->get_angular_velocity();
        twin_.set_velocity(context.session, from_godot(linear_velocity_), from_godot(angular_velocity_),
                           context.takes_effect);
    }
}

void BodyMirror::synchronise(const MirrorContext& context, bool shapes_changed) {
    CollisionObject3D* node = body();
    if (node == nullptr) {
        return;
    }
    const Transform3D place = node->get_global_transform();
    if (needs_a_new_twin(*node, place, shapes_changed)) {
        plan(context);
    }
    if (handle() != no_handle) {
        hold_still_in_godot(*node);
        const Ref<PhysicsMaterial> material = material_of(*node);
        twin_.set_values(context.session, read_values(*node, material, context.defaults));
        if (material_ != (material.is_valid() ? material->get_instance_id() : 0)) {
            listen(*node, material, context);
        }
        send_place(place, context);
        send_speed(context);
        if (twin_.values().motion != Motion::Dynamic) {
            come_to_rest();
        }
    }
    say_problems(context.complaints);
}

void BodyMirror::follow(const MirrorContext& context) {
    CollisionObject3D* node = handle() != no_handle ? body() : nullptr;
    if (node == nullptr) {
        return;
    }
    send_place(node->get_global_transform(), context);
    send_speed(context);
    if (!place_problem_.empty()) {
        context.complaints.say(*node, place_problem_);
    }
}

void BodyMirror::follow_speed(const MirrorContext& context) {
    if (handle() != no_handle && is_there()) {
        send_speed(context);
    }
}

// What moves is asked here whether a script has moved it: to be told of its place as well would cost as much
// again. Moving the node may call a script, which may let it go.
BodyMirror::Applied BodyMirror::apply(const BodyState& state, std::uint64_t tick) {
    const auto is_in_scene = [this] { return is_there() && rigid_->is_inside_tree(); };
    if (rigid_ == nullptr || !place_problem_.empty() || !is_in_scene()) {
        return Applied::no;
    }
    if (has_other_speed() || has_other_place()) {
        return Applied::elsewhere;
    }
    if (!twin_.takes(state, tick)) {
        return Applied::no;
    }
    if (!std::exchange(moves_, true)) {
        BodyWatch::tell_of_places(watch_, false);
    }
    linear_velocity_ = to_godot(state.linear_velocity);
    angular_velocity_ = to_godot(state.angular_velocity);
    if (!(rigid_->get_linear_velocity() == linear_velocity_)) {
        rigid_->set_linear_velocity(linear_velocity_);
    }
    if (!(rigid_->get_angular_velocity() == angular_velocity_)) {
        rigid_->set_angular_velocity(angular_velocity_);
    }
    const Transform3D pose = to_godot(state.pose);
    rigid_->set_global_transform(Transform3D(pose.basis * key_.scaling, pose.origin));
    if (is_in_scene()) {
        place_ = rigid_->get_global_transform();
    }
    return Applied::yes;
}

bool BodyMirror::come_to_rest() {
    if (!std::exchange(moves_, false)) {
        return false;
    }
    BodyWatch::tell_of_places(watch_, true);
    return is_there() && rigid_->is_inside_tree() && (has_other_speed() || has_other_place());
}

void BodyMirror::release(Session& session) {
    twin_.remove(session);
    tried_ = false;
    BodyWatch::take_out(std::exchange(watch_, 0));
    moves_ = false;
    if (rigid_ != nullptr && is_there()) {
        PhysicsServer3D::get_singleton()->body_set_mode(rigid_->get_rid(), own_mode(*rigid_));
    }
}

}  // namespace tactus
