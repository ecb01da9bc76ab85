// An ordinary Godot body, as it is now, in the session's terms.
#pragma once

#include <godot_cpp/classes/collision_object3d.hpp>
#include <godot_cpp/classes/physics_material.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>

#include "nodes/conversions.hpp"
#include "nodes/shape_reading.hpp"
#include "world/body_form.hpp"

namespace tactus {

// Whether a world mirrors this object at all: areas are not solid.
bool is_solid_body(const godot::Object* object);

// Static, for the engine's own physics: it then neither moves the body nor calls back with a place of its
// own, and what is outside the world still finds the body where it is. Or as it would have it by itself.
void hold_still(const godot::RigidBody3D& body, bool held);

// As Godot's own physics has it, told by RigidBody3D or by a script past it.
double told(const godot::RID& body, godot::PhysicsServer3D::BodyParameter what);
SurfaceMaterial told_surface(const godot::RID& body);

// Godot's physics runs in a thread of its own: chosen before the program starts.
bool has_physics_thread();

// Of any of the bodies that can have one.
godot::Ref<godot::PhysicsMaterial> material_of(const godot::CollisionObject3D& body);

// Its process mode, or that of a node above it, is DISABLED; what that means for a body its 'disable_mode'
// says.
bool is_disabled(const godot::Node& node);
// By that, it is not in the physics for now.
bool is_out(const godot::CollisionObject3D& body);
// The triangles of meshes are taken as they are; problems_of() looks at them, too. `engine_moves`: see
// passed_over().
BodyForm read_form(godot::CollisionObject3D& body, bool engine_moves);
// `body_scale`: what the body's own frame scales, as it counts (scaling_of()).
BodyForm read_form(godot::CollisionObject3D& body, const Mat3& body_scale, bool engine_moves);

// Calls use(shape, its place in the body, Godot's owner of it) for each shape that takes part.
void for_each_shape(godot::CollisionObject3D& body, auto&& use) {
    const godot::PackedInt32Array owners = body.get_shape_owners();
    for (int64_t i = 0; i < owners.size(); ++i) {
        const auto owner = static_cast<std::uint32_t>(owners[i]);
        if (body.is_shape_owner_disabled(owner)) {
            continue;
        }
        const godot::Transform3D place = body.shape_owner_get_transform(owner);
        for (int shape = 0; shape < body.shape_owner_get_shape_count(owner); ++shape) {
            use(body.shape_owner_get_shape(owner, shape), place, body.shape_owner_get_owner(owner));
        }
    }
}

}  // namespace tactus
