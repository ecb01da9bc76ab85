// An ordinary Godot body, as it is now, in the session's terms.
#pragma once

#include <godot_cpp/classes/collision_object3d.hpp>
#include <godot_cpp/classes/physics_material.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/variant/string.hpp>
#include <optional>
#include <vector>

#include "core/haptics/touch_material.hpp"
#include "nodes/conversions.hpp"
#include "nodes/shape_reading.hpp"
#include "world/body_form.hpp"
#include "world/problem_of_place.hpp"

namespace tactus {

class HapticMesh;

// What a world adds to each of its bodies.
struct BodyDefaults {
    TouchMaterial touch;                         // of bodies without a physics_material_override
    std::shared_ptr<const HeightImage> texture;  // of the same
    double linear_damping = 0.1;   // that Godot's project settings give to every rigid body (unit: 1/seconds)
    double angular_damping = 0.1;  // likewise
};

// What touch and collision take their form from. Two equal ones need no new reading, unless a shape said that
// it changed.
struct ShapeKey {
    struct Entry {
        std::uint64_t shape = 0;  // instance id
        godot::Transform3D place;
        bool operator==(const Entry& other) const { return shape == other.shape && place == other.place; }
    };
    std::vector<Entry> shapes;
    godot::Basis scaling;
    bool operator==(const ShapeKey& other) const {
        return shapes == other.shapes && scaling == other.scaling;
    }
};

// See world/problem_of_place.hpp.
inline std::string problem_of_place(const godot::Transform3D& place) {
    return problem_of_place(matrix_of(place.basis), from_godot(place.origin));
}

// Whether a world mirrors this object at all: areas are not solid.
bool is_solid_body(const godot::Object* object);

bool is_rigid(const godot::CollisionObject3D& body);
// As Godot's own physics would have it.
godot::PhysicsServer3D::BodyMode own_mode(const godot::RigidBody3D& body);
Motion motion_of(const godot::CollisionObject3D& body);

HapticMesh* haptic_mesh_of(const godot::CollisionObject3D& body);

// `body_place`: in the world.
ShapeKey shape_key(godot::CollisionObject3D& body, const godot::Transform3D& body_place);
std::vector<godot::Ref<godot::Shape3D>> shapes_of(godot::CollisionObject3D& body);

// Everything but the values and makings, which are cheap enough to ask for in every frame. The triangles of
// meshes are taken as they are; problems_of() looks at them, too.
BodyForm read_form(godot::CollisionObject3D& body);
// Of any of the bodies that can have one.
godot::Ref<godot::PhysicsMaterial> material_of(const godot::CollisionObject3D& body);
BodyValues read_values(const godot::CollisionObject3D& body,
                       const godot::Ref<godot::PhysicsMaterial>& material, const BodyDefaults& defaults);

BodyMakings read_makings(const godot::CollisionObject3D& body);

}  // namespace tactus
