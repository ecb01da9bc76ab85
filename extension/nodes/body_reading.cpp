#include "nodes/body_reading.hpp"

#include <algorithm>
#include <godot_cpp/classes/animatable_body3d.hpp>
#include <godot_cpp/classes/character_body3d.hpp>
#include <godot_cpp/classes/physics_body3d.hpp>
#include <godot_cpp/classes/physics_material.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/classes/static_body3d.hpp>

#include "nodes/conversions.hpp"
#include "nodes/haptic_material.hpp"
#include "nodes/haptic_mesh.hpp"
#include "nodes/shape_reading.hpp"

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
        values.texture = haptic->heights();
        return;
    }
    values.touch = defaults.touch;
    values.texture = defaults.texture;
    if (material.is_valid()) {
        values.touch.static_friction = values.touch.dynamic_friction =
            std::max(0.0, static_cast<double>(material->get_friction()));
    }
}

double damping_of(RigidBody3D::DampMode mode, double own, double project) {
    return std::max(0.0, mode == RigidBody3D::DAMP_MODE_REPLACE ? own : own + project);
}

// Calls use(shape, its place in the body's frame, Godot's owner of it) for each shape that takes part.
void for_each_shape(CollisionObject3D& body, auto&& use) {
    const PackedInt32Array owners = body.get_shape_owners();
    for (int64_t i = 0; i < owners.size(); ++i) {
        const auto owner = static_cast<std::uint32_t>(owners[i]);
        if (body.is_shape_owner_disabled(owner)) {
            continue;
        }
        const Transform3D place = body.shape_owner_get_transform(owner);
        for (int shape = 0; shape < body.shape_owner_get_shape_count(owner); ++shape) {
            use(body.shape_owner_get_shape(owner, shape), place, body.shape_owner_get_owner(owner));
        }
    }
}

std::string name_of_owner(const Object* owner) {
    const Node* node = Object::cast_to<Node>(owner);
    return node != nullptr ? "'" + from_godot(String(node->get_name())) + "': " : std::string();
}

}  // namespace

Ref<PhysicsMaterial> material_of(const CollisionObject3D& body) {
    if (const auto* rigid = Object::cast_to<RigidBody3D>(&body)) {
        return rigid->get_physics_material_override();
    }
    if (const auto* still = Object::cast_to<StaticBody3D>(&body)) {  // an AnimatableBody3D is one, too
        return still->get_physics_material_override();
    }
    return Ref<PhysicsMaterial>();
}

bool is_solid_body(const Object* object) {
    return Object::cast_to<RigidBody3D>(object) != nullptr ||
           Object::cast_to<StaticBody3D>(object) != nullptr ||
           Object::cast_to<CharacterBody3D>(object) != nullptr;
}

bool is_rigid(const CollisionObject3D& body) {
    return Object::cast_to<RigidBody3D>(&body) != nullptr;
}

PhysicsServer3D::BodyMode own_mode(const RigidBody3D& body) {
    if (body.is_freeze_enabled()) {
        return body.get_freeze_mode() == RigidBody3D::FREEZE_MODE_KINEMATIC
                   ? PhysicsServer3D::BODY_MODE_KINEMATIC
                   : PhysicsServer3D::BODY_MODE_STATIC;
    }
    return body.is_lock_rotation_enabled() ? PhysicsServer3D::BODY_MODE_RIGID_LINEAR
                                           : PhysicsServer3D::BODY_MODE_RIGID;
}

Motion motion_of(const CollisionObject3D& body) {
    if (const auto* rigid = Object::cast_to<RigidBody3D>(&body)) {
        if (!rigid->is_freeze_enabled()) {
            return Motion::Dynamic;
        }
        return rigid->get_freeze_mode() == RigidBody3D::FREEZE_MODE_KINEMATIC ? Motion::Kinematic
                                                                              : Motion::Static;
    }
    const bool told = Object::cast_to<AnimatableBody3D>(&body) != nullptr ||
                      Object::cast_to<CharacterBody3D>(&body) != nullptr;
    return told ? Motion::Kinematic : Motion::Static;
}

HapticMesh* haptic_mesh_of(const CollisionObject3D& body) {
    for (int i = 0; i < body.get_child_count(); ++i) {
        if (auto* mesh = Object::cast_to<HapticMesh>(body.get_child(i))) {
            return mesh;
        }
    }
    return nullptr;
}

ShapeKey shape_key(CollisionObject3D& body, const Transform3D& body_place) {
    ShapeKey key;
    key.scaling = without_rounding(scaling_of(body_place.basis));
    for_each_shape(body, [&key](const Ref<Shape3D>& shape, const Transform3D& place, Object*) {
        key.shapes.push_back({shape->get_instance_id(), place});
    });
    return key;
}

std::vector<Ref<Shape3D>> shapes_of(CollisionObject3D& body) {
    std::vector<Ref<Shape3D>> shapes;
    for_each_shape(
        body, [&shapes](const Ref<Shape3D>& shape, const Transform3D&, Object*) { shapes.push_back(shape); });
    return shapes;
}

BodyForm read_form(CollisionObject3D& body) {
    BodyForm reading;
    const Transform3D transform = body.get_global_transform();
    if (std::string problem = problem_of_place(transform); !problem.empty()) {
        reading.problems.push_back(std::move(problem));
        return reading;
    }
    const Basis scaling = without_rounding(scaling_of(transform.basis));
    for_each_shape(body, [&](const Ref<Shape3D>& shape, const Transform3D& place, Object* owner) {
        ShapeReading one = read_shape(shape, Transform3D(scaling, Vector3()) * place);
        if (!one.error.empty()) {
            reading.problems.push_back(name_of_owner(owner) + one.error);
        }
        for (MeshDraft& mesh : one.meshes) {
            mesh.owner = name_of_owner(owner);
        }
        std::ranges::move(one.shapes, std::back_inserter(reading.shapes));
        std::ranges::move(one.meshes, std::back_inserter(reading.meshes));
    });
    if (const HapticMesh* mesh = haptic_mesh_of(body)) {
        ShapeReading touched = mesh->read(scaling);
        if (!touched.error.empty()) {
            reading.problems.push_back(name_of_owner(mesh) + touched.error);
        }
        for (MeshDraft& draft : touched.meshes) {
            draft.owner = name_of_owner(mesh);
        }
        reading.touched = std::move(touched.meshes);
    }
    if (is_rigid(body) && body.has_method("_integrate_forces")) {
        reading.problems.push_back(
            "its script has _integrate_forces(), which is not called while a HapticWorld moves the body: use "
            "_process() and HapticWorld.apply_force()");
    }
    reading.touchable = !reading.shapes.empty() || !reading.meshes.empty() || !reading.touched.empty();
    if (!reading.touchable && reading.problems.empty()) {
        reading.problems.push_back("it has no shape: give it a CollisionShape3D or a HapticMesh as a child");
    }
    return reading;
}

BodyValues read_values(const CollisionObject3D& body, const Ref<PhysicsMaterial>& material,
                       const BodyDefaults& defaults) {
    BodyValues values;
    values.motion = motion_of(body);
    read_touch(material, defaults, values);
    if (material.is_valid()) {
        values.surface = {std::max(0.0, static_cast<double>(material->get_friction())),
                          std::clamp(static_cast<double>(material->get_bounce()), 0.0, 1.0),
                          material->is_rough(), material->is_absorbent()};
    }
    values.layers = {static_cast<std::uint32_t>(body.get_collision_layer()),
                     static_cast<std::uint32_t>(body.get_collision_mask())};
    if (const auto* rigid = Object::cast_to<RigidBody3D>(&body)) {
        values.gravity_scale = rigid->get_gravity_scale();
        values.constant_force = from_godot(rigid->get_constant_force());
        values.constant_torque = from_godot(rigid->get_constant_torque());
        values.linear_damping =
            damping_of(rigid->get_linear_damp_mode(), rigid->get_linear_damp(), defaults.linear_damping);
        values.angular_damping =
            damping_of(rigid->get_angular_damp_mode(), rigid->get_angular_damp(), defaults.angular_damping);
    }
    return values;
}

BodyMakings read_makings(const CollisionObject3D& body) {
    BodyMakings makings;
    if (const auto* rigid = Object::cast_to<RigidBody3D>(&body)) {
        for (std::uint32_t i = 0; i < 6; ++i) {
            makings.locks |= rigid->get_axis_lock(axes[i]) ? 1u << i : 0u;
        }
        makings.mass = rigid->get_mass();
        const HapticMesh* mesh = haptic_mesh_of(body);
        if (mesh != nullptr && mesh->is_giving_mass()) {
            makings.mass =
                mesh->library_mass(without_rounding(scaling_of(body.get_global_transform().basis)));
            makings.solid_of_mesh = true;
        }
        makings.inertia = from_godot(rigid->get_inertia());
        if (rigid->get_center_of_mass_mode() == RigidBody3D::CENTER_OF_MASS_MODE_CUSTOM) {
            makings.center_of_mass = from_godot(rigid->get_center_of_mass());
        }
        makings.continuous = rigid->is_using_continuous_collision_detection();
        makings.can_sleep = rigid->is_able_to_sleep();
        makings.locks |= rigid->is_lock_rotation_enabled() ? all_turns : 0u;
    }
    return makings;
}

}  // namespace tactus
