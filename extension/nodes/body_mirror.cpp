#include "nodes/body_mirror.hpp"

#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/core/object.hpp>

#include "core/haptics/touch_values.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_mesh.hpp"
#include "nodes/shape_reading.hpp"

namespace tactus {

using namespace godot;

namespace {

// Building a tree over so many takes about a millisecond.
constexpr std::size_t most_triangles_at_once = 2000;

bool operator==(const SurfaceMaterial& a, const SurfaceMaterial& b) {
    return a.friction == b.friction && a.restitution == b.restitution && a.rough == b.rough &&
           a.absorbent == b.absorbent;
}

bool operator==(const CollisionLayers& a, const CollisionLayers& b) {
    return a.layer == b.layer && a.mask == b.mask;
}

// Unlike any that another body has had: handles are given again.
std::uint64_t next_revision() {
    static std::uint64_t last = 0;
    return ++last;
}

}  // namespace

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

void BodyMirror::remove(Session& session) {
    if (handle_ != no_handle) {
        session.remove_body(handle_);
        handle_ = no_handle;
        shown_change_ = 0;
    }
}

// Godot tells of changes of what it is made of from now on.
void BodyMirror::listen(const MirrorContext& context) {
    CollisionObject3D& node = *body();
    if (ObjectDB::get_instance(watch_) == nullptr) {
        watch_ = BodyWatch::put_into(node, context.news);
    }
    std::vector<Ref<Resource>> resources;
    for (const Ref<Shape3D>& shape : shapes_of(node)) {
        resources.push_back(shape);
    }
    if (const Ref<PhysicsMaterial> material = material_of(node); material.is_valid()) {
        resources.push_back(material);
    }
    BodyWatch::listen_to(watch_, resources);
}

// Reads the body as it is and has a twin of it built: at once where that takes no time.
void BodyMirror::plan(Session& session, const MirrorContext& context) {
    CollisionObject3D& node = *body();
    tried_ = true;
    place_problem_.clear();
    was_nowhere_ = !problem_of_place(node.get_global_transform()).empty();
    key_ = shape_key(node);
    mesh_changes_ = HapticMesh::changes();
    makings_ = read_makings(node);
    listen(context);
    shapes_ = read_shapes(node);
    if (handle_ == no_handle) {
        remember_place(node);
    }
    auto job = std::make_shared<Job>();
    job->plan = {shapes_,          read_values(node, context.defaults),
                 makings_,         place_,
                 linear_velocity_, angular_velocity_,
                 is_rigid(node)};
    job_ = job;
    if (shapes_.touchable) {
        hold_still_in_godot(node);
    }
    if (triangle_count(shapes_) <= most_triangles_at_once) {
        job->built = build_body(job->plan, run_serially);
        job->done = true;
        take_ready(session, context);
    } else {
        context.workers->add([job, run = context.workers->runner()] {
            // Nobody else holds it: nobody waits for it any more.
            if (job.use_count() > 1) {
                job->built = build_body(job->plan, run);
            }
            job->done.store(true, std::memory_order_release);
        });
    }
}

void BodyMirror::take_ready(Session& session, const MirrorContext& context) {
    if (job_ == nullptr || !job_->done.load(std::memory_order_acquire) || body() == nullptr) {
        return;
    }
    const std::shared_ptr<Job> job = std::move(job_);
    job_.reset();
    problems_ = std::move(job->built.problems);
    if (deform(session, *job)) {
        return;
    }
    remove(session);
    if (!job->built.buildable) {
        return;
    }
    AddResult added = session.add_body(std::move(job->built.body));
    handle_ = added.handle;
    if (handle_ == no_handle) {
        problems_.push_back(std::move(added.error));
        return;
    }
    shown_from_ = context.takes_effect;
    values_ = job->plan.values;
    addition_ = std::move(job->built.addition);
    made_of_ = job->plan.makings;
    revision_ = next_revision();
    catch_up(session, job->plan);
}

// Where only corners of its meshes have moved, the twin stays and takes the new form: whoever touches it is
// taken along.
bool BodyMirror::deform(Session& session, Job& job) {
    const BodyAddition& now = job.built.addition;
    if (handle_ == no_handle || !job.built.buildable || !job.built.body.error.empty() ||
        !(job.plan.makings == made_of_) || !is_deformation(*addition_.touch, *now.touch)) {
        return false;
    }
    session.deform_body(handle_, std::move(job.built.body));
    addition_ = std::move(job.built.addition);
    revision_ = next_revision();
    return true;
}

// What has changed while the twin was built.
void BodyMirror::catch_up(Session& session, const BodyPlan& plan) {
    CollisionObject3D& node = *body();
    hold_still_in_godot(node);
    remember_place(node);
    if (plan.values.constant_force != Vector3() || plan.values.constant_torque != Vector3()) {
        session.set_body_push(handle_, from_godot(plan.values.constant_force),
                              from_godot(plan.values.constant_torque));
    }
    if (!(place_ == plan.place)) {
        session.teleport_body(handle_, pose_of(place_));
    }
    if (!(linear_velocity_ == plan.linear_velocity) || !(angular_velocity_ == plan.angular_velocity)) {
        session.set_body_velocity(handle_, from_godot(linear_velocity_), from_godot(angular_velocity_));
    }
}

bool BodyMirror::needs_a_new_twin(CollisionObject3D& node, bool shapes_changed) {
    const bool is_back = was_nowhere_ && problem_of_place(node.get_global_transform()).empty();
    if (!tried_ || is_back || !(read_makings(node) == makings_) || !(shape_key(node) == key_)) {
        return true;
    }
    if (!shapes_changed && mesh_changes_ == HapticMesh::changes()) {
        return false;
    }
    mesh_changes_ = HapticMesh::changes();
    return !same_shapes(read_shapes(node), shapes_);
}

void BodyMirror::send_values(Session& session, const MirrorContext& context) {
    const BodyValues before = values_;
    values_ = read_values(*body(), context.defaults);
    if (values_.material != before.material) {
        listen(context);
    }
    bool described_anew = false;
    const auto changes = [&described_anew](bool differs) {
        described_anew = described_anew || differs;
        return differs;
    };
    if (changes(!same_values(values_.touch, before.touch) || values_.texture != before.texture)) {
        session.set_touch_material(handle_, values_.touch, values_.texture);
    }
    if (changes(!(values_.surface == before.surface))) {
        session.set_body_surface(handle_, values_.surface);
    }
    if (changes(!(values_.layers == before.layers))) {
        session.set_body_layers(handle_, values_.layers);
    }
    if (changes(values_.motion != before.motion)) {
        session.set_body_motion(handle_, values_.motion);
    }
    if (changes(values_.gravity_scale != before.gravity_scale)) {
        session.set_body_gravity_scale(handle_, values_.gravity_scale);
    }
    if (values_.constant_force != before.constant_force ||
        values_.constant_torque != before.constant_torque) {
        session.set_body_push(handle_, from_godot(values_.constant_force),
                              from_godot(values_.constant_torque));
    }
    if (changes(values_.linear_damping != before.linear_damping ||
                values_.angular_damping != before.angular_damping)) {
        session.set_body_damping(handle_, values_.linear_damping, values_.angular_damping);
    }
    if (described_anew) {
        revision_ = next_revision();
    }
}

BodyAddition BodyMirror::addition() const {
    BodyAddition now = addition_;
    put_into(now, values_);
    now.description.pose = pose_of(place_);
    now.description.linear_velocity = from_godot(linear_velocity_);
    now.description.angular_velocity = from_godot(angular_velocity_);
    return now;
}

std::vector<std::string> BodyMirror::problems() const {
    std::vector<std::string> all = problems_;
    if (!place_problem_.empty()) {
        all.push_back(place_problem_);
    }
    return all;
}

void BodyMirror::send_motion(Session& session, double seconds, std::uint64_t takes_effect) {
    CollisionObject3D& node = *body();
    const Transform3D place = node.get_global_transform();
    place_problem_ = problem_of_place(place);
    if (!(place == place_) && place_problem_.empty()) {
        place_ = place;
        if (values_.motion == Motion::Dynamic) {
            session.teleport_body(handle_, pose_of(place_));
            shown_from_ = takes_effect;
        } else {
            session.move_body(handle_, pose_of(place_), seconds);
        }
    }
    const auto* rigid = Object::cast_to<RigidBody3D>(&node);
    if (rigid == nullptr || values_.motion != Motion::Dynamic) {
        return;
    }
    const Vector3 linear = rigid->get_linear_velocity();
    const Vector3 angular = rigid->get_angular_velocity();
    if (!(linear == linear_velocity_) || !(angular == angular_velocity_)) {
        linear_velocity_ = linear;
        angular_velocity_ = angular;
        session.set_body_velocity(handle_, from_godot(linear), from_godot(angular));
        shown_from_ = takes_effect;
    }
}

void BodyMirror::synchronise(Session& session, const MirrorContext& context, double seconds) {
    CollisionObject3D* node = body();
    if (node == nullptr) {
        return;
    }
    if (needs_a_new_twin(*node, context.shapes_changed)) {
        plan(session, context);
    } else {
        take_ready(session, context);
    }
    if (handle_ != no_handle) {
        hold_still_in_godot(*node);
        send_values(session, context);
        send_motion(session, seconds, context.takes_effect);
    }
}

bool BodyMirror::follow(Session& session, const MirrorContext& context, double seconds) {
    if (handle_ == no_handle || body() == nullptr) {
        return false;
    }
    send_motion(session, seconds, context.takes_effect);
    return !place_problem_.empty();
}

// Moving the node may call a script, which may let it go.
void BodyMirror::apply(const BodyState& state, std::uint64_t tick) {
    if (!place_problem_.empty() || state.changed_at == shown_change_ || values_.motion != Motion::Dynamic ||
        tick < shown_from_) {
        return;
    }
    auto* rigid = Object::cast_to<RigidBody3D>(body());
    if (rigid == nullptr) {
        return;
    }
    shown_change_ = state.changed_at;
    const Transform3D pose = to_godot(state.pose);
    rigid->set_linear_velocity(to_godot(state.linear_velocity));
    rigid->set_angular_velocity(to_godot(state.angular_velocity));
    rigid->set_global_transform(Transform3D(pose.basis * key_.scaling, pose.origin));
    if (ObjectDB::get_instance(id_) != nullptr && rigid->is_inside_tree()) {
        remember_place(*rigid);
    }
}

void BodyMirror::release(Session& session) {
    remove(session);
    job_.reset();
    tried_ = false;
    BodyWatch::take_out(std::exchange(watch_, 0));
    if (auto* rigid = Object::cast_to<RigidBody3D>(body())) {
        PhysicsServer3D::get_singleton()->body_set_mode(rigid->get_rid(), own_mode(*rigid));
    }
}

}  // namespace tactus
