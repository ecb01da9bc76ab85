#include "nodes/body_reading.hpp"

#include <algorithm>
#include <cmath>
#include <godot_cpp/classes/character_body3d.hpp>
#include <godot_cpp/classes/physics_body3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/classes/static_body3d.hpp>

#include "nodes/body_parts.hpp"
#include "nodes/haptic_material.hpp"
#include "nodes/haptic_mesh.hpp"
#include "nodes/haptic_soft_body.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/passed_over.hpp"
#include "nodes/scene_warnings.hpp"

namespace tactus {

using namespace godot;

namespace {

PhysicsServer3D::BodyMode own_mode(const RigidBody3D& body) {
    if (body.is_freeze_enabled()) {
        return body.get_freeze_mode() == RigidBody3D::FREEZE_MODE_KINEMATIC
                   ? PhysicsServer3D::BODY_MODE_KINEMATIC
                   : PhysicsServer3D::BODY_MODE_STATIC;
    }
    return body.is_lock_rotation_enabled() ? PhysicsServer3D::BODY_MODE_RIGID_LINEAR
                                           : PhysicsServer3D::BODY_MODE_RIGID;
}

// Takes over what was read, and says whose it is.
void take(ShapeReading reading, const Object* owner, BodyForm& form, std::vector<MeshDraft>& meshes) {
    const Node* node = Object::cast_to<Node>(owner);
    const std::string name = node != nullptr ? "'" + from_godot(String(node->get_name())) + "': " : "";
    if (!reading.error.empty()) {
        form.problems.push_back(name + reading.error);
    }
    for (MeshDraft& mesh : reading.meshes) {
        mesh.owner = name;
    }
    std::ranges::move(reading.shapes, std::back_inserter(form.shapes));
    std::ranges::move(reading.meshes, std::back_inserter(meshes));
}

void take_problem_of(const HapticMaterial* material, BodyForm& form) {
    if (std::string problem = material != nullptr ? material->problem() : ""; !problem.empty()) {
        form.problems.push_back(std::move(problem));
    }
}

// Of one that a hand can push as the haptic world moves it.
void take_problem_of_mass(const RigidBody3D& body, const HapticMaterial* material, double mass,
                          BodyForm& form) {
    const HapticWorld* world = HapticWorld::above(&body);
    if (world == nullptr || body.is_freeze_enabled()) {
        return;
    }
    const TouchMaterial touch = material != nullptr ? material->touch() : world->body_defaults().touch;
    if (std::string problem = problem_of_mass(mass, touch, world->tick_seconds()); !problem.empty()) {
        form.problems.push_back(std::move(problem));
    }
}

// A shape that a script has switched off is missing on purpose.
bool has_shape_switched_off(CollisionObject3D& body) {
    const PackedInt32Array owners = body.get_shape_owners();
    for (int64_t i = 0; i < owners.size(); ++i) {
        const auto owner = static_cast<std::uint32_t>(owners[i]);
        if (body.is_shape_owner_disabled(owner) && body.shape_owner_get_shape_count(owner) > 0) {
            return true;
        }
    }
    return false;
}

}  // namespace

double told(const RID& body, PhysicsServer3D::BodyParameter what) {
    return static_cast<double>(PhysicsServer3D::get_singleton()->body_get_param(body, what));
}

// PhysicsMaterial tells rough and absorbent by the sign.
SurfaceMaterial told_surface(const RID& body) {
    const double friction = told(body, PhysicsServer3D::BODY_PARAM_FRICTION);
    const double bounce = told(body, PhysicsServer3D::BODY_PARAM_BOUNCE);
    return {std::abs(friction), std::clamp(std::abs(bounce), 0.0, 1.0), friction < 0.0, bounce < 0.0};
}

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

void hold_still(const RigidBody3D& body, bool held) {
    PhysicsServer3D* server = PhysicsServer3D::get_singleton();
    const PhysicsServer3D::BodyMode mode = held ? PhysicsServer3D::BODY_MODE_STATIC : own_mode(body);
    if (server->body_get_mode(body.get_rid()) != mode) {
        server->body_set_mode(body.get_rid(), mode);
    }
}

BodyForm read_form(CollisionObject3D& body, bool engine_moves) {
    return read_form(body, scaling_of(frame_of(body.get_global_transform())), engine_moves);
}

bool has_physics_thread() {
    static const bool has_one =
        ProjectSettings::get_singleton()->get_setting("physics/3d/run_on_separate_thread", false);
    return has_one;
}

bool is_disabled(const Node& node) {
    const Node* decides = &node;
    while (decides->get_process_mode() == Node::PROCESS_MODE_INHERIT && decides->get_parent() != nullptr) {
        decides = decides->get_parent();
    }
    return decides->get_process_mode() == Node::PROCESS_MODE_DISABLED;
}

bool is_out(const CollisionObject3D& body) {
    return body.get_disable_mode() == CollisionObject3D::DISABLE_MODE_REMOVE && !is_edited() &&
           is_disabled(body);
}

BodyForm read_form(CollisionObject3D& body, const Mat3& body_scale, bool engine_moves) {
    BodyForm form;
    if (is_out(body)) {
        return form;
    }
    if (std::string problem = problem_of_place(frame_of(body.get_global_transform())); !problem.empty()) {
        form.problems.push_back(std::move(problem));
        return form;
    }
    form.problems = passed_over(body, engine_moves);
    const SceneFrame scaling{body_scale};
    const auto* material = Object::cast_to<HapticMaterial>(material_of(body).ptr());
    take_problem_of(material, form);
    HapticMesh* const mesh = part_of<HapticMesh>(body);
    for (const Ref<HapticMaterial>& surface :
         mesh != nullptr ? mesh->surface_materials() : std::vector<Ref<HapticMaterial>>()) {
        take_problem_of(surface.ptr(), form);
    }
    if (const auto* rigid = Object::cast_to<RigidBody3D>(&body); rigid != nullptr && !engine_moves) {
        const bool is_meshs = mesh != nullptr && mesh->is_giving_mass();
        take_problem_of_mass(*rigid, material, is_meshs ? mesh->library_mass(body_scale) : rigid->get_mass(),
                             form);
    }
    const std::size_t besides = form.problems.size();  // what is said of its shapes follows
    for_each_shape(body, [&](const Ref<Shape3D>& shape, const Transform3D& place, Object* owner) {
        take(read_shape(shape, compose(scaling, frame_of(place))), owner, form, form.meshes);
    });
    if (mesh != nullptr) {
        mesh->follow_instance();
        take(mesh->read(scaling, material != nullptr && material->is_laid_by_uv()), mesh, form, form.touched);
    }
    if (const HapticSoftBody* soft = part_of<HapticSoftBody>(body)) {
        const String problem = soft->problem();
        if (problem.is_empty()) {
            form.soft = soft->plan(scaling);
        } else {
            form.problems.push_back("'" + from_godot(String(soft->get_name())) + "': " + from_godot(problem));
        }
    }
    form.touchable =
        !form.shapes.empty() || !form.meshes.empty() || !form.touched.empty() || form.soft != nullptr;
    if (!form.touchable && form.problems.size() == besides && !has_shape_switched_off(body)) {
        form.problems.push_back("it has no shape: give it a CollisionShape3D or a HapticMesh as a child");
    }
    return form;
}

}  // namespace tactus
