#include "nodes/godot_body.hpp"

#include <algorithm>
#include <godot_cpp/classes/animatable_body3d.hpp>
#include <godot_cpp/classes/character_body3d.hpp>
#include <godot_cpp/classes/physics_direct_body_state3d.hpp>
#include <godot_cpp/classes/physics_material.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/scene_tree.hpp>
#include <godot_cpp/core/object.hpp>

#include "nodes/haptic_material.hpp"
#include "nodes/haptic_mesh.hpp"

namespace tactus {

using namespace godot;

namespace {

using Axis = PhysicsServer3D::BodyAxis;

constexpr Axis axes[6] = {PhysicsServer3D::BODY_AXIS_LINEAR_X,  PhysicsServer3D::BODY_AXIS_LINEAR_Y,
                          PhysicsServer3D::BODY_AXIS_LINEAR_Z,  PhysicsServer3D::BODY_AXIS_ANGULAR_X,
                          PhysicsServer3D::BODY_AXIS_ANGULAR_Y, PhysicsServer3D::BODY_AXIS_ANGULAR_Z};
constexpr std::uint32_t all_turns = 0b111000;

void read_touch(const Ref<PhysicsMaterial>& material, const BodyDefaults& defaults, BodyValues& values) {
    if (const auto* haptic = Object::cast_to<HapticMaterial>(material.ptr())) {
        values.touch = haptic->touch();
        values.detail = haptic->detail();
        return;
    }
    values.touch = defaults.touch;
    values.detail = defaults.detail;
    if (material.is_valid()) {
        values.touch.static_friction = values.touch.dynamic_friction =
            std::max(0.0, static_cast<double>(material->get_friction()));
    }
}

void read_surfaces(const HapticMesh& mesh, BodyValues& values) {
    SurfaceFeels feels = mesh.surface_feels();
    if (!feels.empty()) {
        values.detail = std::make_shared<const TouchDetail>(
            TouchDetail{values.detail ? values.detail->images : TouchImages(), std::move(feels)});
    }
}

double damping_of(RigidBody3D::DampMode mode, double own, double project) {
    return std::max(0.0, mode == RigidBody3D::DAMP_MODE_REPLACE ? own : own + project);
}

Motion motion_of(const CollisionObject3D& body) {
    if (const auto* rigid = Object::cast_to<RigidBody3D>(&body)) {
        if (!rigid->is_freeze_enabled()) {
            return Motion::Dynamic;
        }
        return rigid->get_freeze_mode() == RigidBody3D::FREEZE_MODE_KINEMATIC ? Motion::Kinematic
                                                                              : Motion::Static;
    }
    const bool is_told = Object::cast_to<AnimatableBody3D>(&body) != nullptr ||
                         Object::cast_to<CharacterBody3D>(&body) != nullptr;
    return is_told ? Motion::Kinematic : Motion::Static;
}

std::vector<std::uint64_t> ids_of(const std::vector<Ref<Resource>>& resources) {
    std::vector<std::uint64_t> ids;
    for (const Ref<Resource>& resource : resources) {
        ids.push_back(resource->get_instance_id());
    }
    return ids;
}

}  // namespace

GodotBody::GodotBody(CollisionObject3D& node, const GodotScene& scene, std::shared_ptr<BodyNews> news)
    : id_(node.get_instance_id()),
      node_(node),
      rigid_(Object::cast_to<RigidBody3D>(&node)),
      scene_(scene),
      news_(std::move(news)) {}

void GodotBody::is_in_tree(bool now) {
    is_in_tree_ = now;
    is_below_world_ = now && node_.get_parent() == &scene_.world;
}

// A watch lives and dies in its body.
bool GodotBody::is_there() const {
    return watch_ != nullptr || UtilityFunctions::is_instance_id_valid(static_cast<int64_t>(id_));
}

bool GodotBody::is_in_scene() const {
    return watch_ != nullptr ? is_in_tree_ : is_there() && node_.is_inside_tree();
}

std::uint64_t GodotBody::carrier() const {
    for (const Node* above = node_.get_parent(); above != nullptr && above != &scene_.world;
         above = above->get_parent()) {
        if (Object::cast_to<RigidBody3D>(above) != nullptr) {
            return above->get_instance_id();
        }
    }
    return 0;
}

std::string GodotBody::path() const {
    return from_godot(String(scene_.world.get_path_to(&node_)));
}

SceneSpeed GodotBody::speed() const {
    return rigid_ != nullptr ? SceneSpeed{from_godot(rigid_->get_linear_velocity()),
                                          from_godot(rigid_->get_angular_velocity())}
                             : SceneSpeed{};
}

BodyMakings GodotBody::makings(const Mat3& scaling) const {
    BodyMakings makings;
    const HapticMesh* mesh = part_of<HapticMesh>(node_);
    if (mesh != nullptr) {
        const auto* material = Object::cast_to<HapticMaterial>(material_of(node_).ptr());
        makings.textured_by_uv = material != nullptr && material->is_laid_by_uv();
    }
    if (rigid_ == nullptr) {
        return makings;
    }
    for (std::uint32_t i = 0; i < 6; ++i) {
        makings.locks |= rigid_->get_axis_lock(axes[i]) ? 1u << i : 0u;
    }
    makings.locks |= rigid_->is_lock_rotation_enabled() ? all_turns : 0u;
    makings.mass =
        scene_.engine_moves ? told(node_.get_rid(), PhysicsServer3D::BODY_PARAM_MASS) : rigid_->get_mass();
    if (mesh != nullptr && mesh->is_giving_mass()) {
        makings.mass = mesh->library_mass(scaling);
        makings.solid_of_mesh = true;
    }
    makings.inertia = from_godot(rigid_->get_inertia());
    if (rigid_->get_center_of_mass_mode() == RigidBody3D::CENTER_OF_MASS_MODE_CUSTOM) {
        makings.center_of_mass = from_godot(rigid_->get_center_of_mass());
    }
    makings.continuous = rigid_->is_using_continuous_collision_detection();
    makings.can_sleep = rigid_->is_able_to_sleep();
    return makings;
}

ShapeKey GodotBody::shape_key() const {
    ShapeKey key;
    key.scaling = scaling_of(frame());
    key.is_out = is_out(node_);
    for_each_shape(node_, [&key](const Ref<Shape3D>& shape, const Transform3D& place, Object*) {
        key.shapes.push_back({shape->get_instance_id(), frame_of(place)});
    });
    return key;
}

BodyValues GodotBody::values(const BodyDefaults& defaults) {
    const Ref<PhysicsMaterial> material = material_of(node_);
    const HapticMesh* const mesh = part_of<HapticMesh>(node_);
    if (watch_ != nullptr && materials_ != ids_of(material_resources(mesh))) {
        listen();
    }
    BodyValues values;
    const bool is_still = is_disabled(node_)
                              ? node_.get_disable_mode() == CollisionObject3D::DISABLE_MODE_MAKE_STATIC
                              : scene_.world.can_process() && !node_.can_process();
    values.motion = is_still ? Motion::Static : motion_of(node_);
    values.is_paused = is_still && rigid_ != nullptr;
    // Godot's physics stands while the tree is paused, and would keep what hands give until it goes on.
    if (scene_.engine_moves && values.motion == Motion::Dynamic && scene_.world.get_tree()->is_paused()) {
        values.motion = Motion::Kinematic;
    }
    read_touch(material, defaults, values);
    if (mesh != nullptr) {
        read_surfaces(*mesh, values);
    }
    if (scene_.engine_moves) {
        values.surface = told_surface(node_.get_rid());
    } else if (material.is_valid()) {
        values.surface = {std::max(0.0, static_cast<double>(material->get_friction())),
                          std::clamp(static_cast<double>(material->get_bounce()), 0.0, 1.0),
                          material->is_rough(), material->is_absorbent()};
    }
    values.layers = {static_cast<std::uint32_t>(node_.get_collision_layer()),
                     static_cast<std::uint32_t>(node_.get_collision_mask())};
    if (rigid_ != nullptr) {
        values.gravity_scale = rigid_->get_gravity_scale();
        values.constant_force = from_godot(rigid_->get_constant_force());
        values.constant_torque = from_godot(rigid_->get_constant_torque());
        values.linear_damping =
            damping_of(rigid_->get_linear_damp_mode(), rigid_->get_linear_damp(), defaults.linear_damping);
        values.angular_damping =
            damping_of(rigid_->get_angular_damp_mode(), rigid_->get_angular_damp(), defaults.angular_damping);
    }
    return values;
}

std::vector<Ref<Resource>> GodotBody::material_resources(const HapticMesh* mesh) const {
    std::vector<Ref<Resource>> resources;
    if (mesh != nullptr) {
        for (const Ref<HapticMaterial>& material : mesh->surface_materials()) {
            if (material.is_valid()) {
                resources.push_back(material);
            }
        }
    }
    if (const Ref<PhysicsMaterial> material = material_of(node_); material.is_valid()) {
        resources.push_back(material);
    }
    return resources;
}

BodyMotion GodotBody::true_motion() const {
    const PhysicsDirectBodyState3D* const state =
        PhysicsServer3D::get_singleton()->body_get_direct_state(node_.get_rid());
    if (state == nullptr) {  // it is not in a space at the moment
        return {pose_of(frame()), speed().linear, speed().angular};
    }
    return {pose_of(frame_of(state->get_transform())), from_godot(state->get_linear_velocity()),
            from_godot(state->get_angular_velocity())};
}

void GodotBody::push(const Vec3& impulse, const Vec3& turn) {
    PhysicsServer3D* const server = PhysicsServer3D::get_singleton();
    if (!server->body_get_space(node_.get_rid()).is_valid()) {  // it is switched off at the moment
        return;
    }
    server->body_apply_central_impulse(node_.get_rid(), to_godot(impulse));
    server->body_apply_torque_impulse(node_.get_rid(), to_godot(turn));
}

void GodotBody::hold_still(bool held) {
    if (rigid_ != nullptr) {
        tactus::hold_still(*rigid_, held);
    }
}

void GodotBody::listen() {
    if (watch_ == nullptr) {
        watch_ = BodyWatch::put_into(node_, *this);
    }
    if (watch_ == nullptr) {
        return;
    }
    std::vector<Ref<Resource>> resources;
    for_each_shape(node_, [&resources](const Ref<Shape3D>& shape, const Transform3D&, Object*) {
        resources.push_back(shape);
    });
    const std::vector<Ref<Resource>> materials = material_resources(part_of<HapticMesh>(node_));
    resources.insert(resources.end(), materials.begin(), materials.end());
    materials_ = ids_of(materials);
    watch_->listen_to(std::move(resources));
}

void GodotBody::tell_of_moves(bool tell) {
    if (watch_ != nullptr) {
        watch_->tell_of_moves(tell);
    }
}

void GodotBody::let_go() {
    if (watch_ != nullptr) {
        std::exchange(watch_, nullptr)->take_out();
    }
    if (rigid_ != nullptr && is_there()) {
        tactus::hold_still(*rigid_, false);
        if (!scene_.engine_moves) {  // Godot has put it to sleep and forgotten its speed while it was held
            rigid_->set_linear_velocity(rigid_->get_linear_velocity());
            rigid_->set_angular_velocity(rigid_->get_angular_velocity());
            rigid_->set_sleeping(false);
        }
    }
}

SceneSpeed GodotBody::set_speed(const SceneSpeed& speed) {
    rigid_->set_linear_velocity(to_godot(speed.linear));
    rigid_->set_angular_velocity(to_godot(speed.angular));
    return this->speed();
}

SceneFrame GodotBody::stand_at(const Pose& pose, const Mat3& scaling) {
    return put(to_godot(pose, scaling));
}

SceneFrame GodotBody::put(const Transform3D& place) {
    if (scene_.is_at_origin && is_below_world_) {
        node_.set_transform(place);
        return frame_of(place);
    }
    node_.set_global_transform(place);
    return is_in_scene() ? frame() : frame_of(place);
}

}  // namespace tactus
