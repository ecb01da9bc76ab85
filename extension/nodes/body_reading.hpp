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
#include "nodes/shape_reading.hpp"
#include "session/session.hpp"

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

// What keeps a body from being touched where it stands, and what to do; empty where nothing does.
std::string problem_of_place(const godot::Transform3D& place);

// Whether a world mirrors this object at all: areas are not solid.
bool is_solid_body(const godot::Object* object);

bool is_rigid(const godot::CollisionObject3D& body);
// As Godot's own physics would have it.
godot::PhysicsServer3D::BodyMode own_mode(const godot::RigidBody3D& body);
Motion motion_of(const godot::CollisionObject3D& body);

HapticMesh* haptic_mesh_of(const godot::CollisionObject3D& body);

ShapeKey shape_key(godot::CollisionObject3D& body);
std::vector<godot::Ref<godot::Shape3D>> shapes_of(godot::CollisionObject3D& body);

struct BodyReading {
    std::vector<PlacedShape> shapes;    // that collide; touched, too, where there is no HapticMesh
    std::vector<MeshDraft> meshes;      // likewise
    std::vector<MeshDraft> touched;     // instead of these
    std::vector<std::string> problems;  // of single shapes; the rest of the body can still be touched
    bool touchable = false;             // false: nothing is left to touch, the problems say why
};

// Everything but the values below, which are cheap enough to ask for in every frame. The triangles of meshes
// are taken as they are; problems_of() looks at them, too.
BodyReading read_shapes(godot::CollisionObject3D& body);
bool same_shapes(const BodyReading& a, const BodyReading& b);
std::vector<std::string> problems_of(const BodyReading& reading);
std::string problem_of(const MeshDraft& draft);  // empty where the triangles are sound

// What a running body can take over as it is, without being made anew.
struct BodyValues {
    std::uint64_t material = 0;  // instance id of its PhysicsMaterial; 0: none
    Motion motion = Motion::Static;
    TouchMaterial touch;
    std::shared_ptr<const HeightImage> texture;  // null: none
    SurfaceMaterial surface;
    CollisionLayers layers;
    double gravity_scale = 1.0;
    double linear_damping = 0.0;
    double angular_damping = 0.0;
    godot::Vector3 constant_force;   // at the centre of mass, in the world (unit: newtons)
    godot::Vector3 constant_torque;  // in the world (unit: newton meters)
};
// Of any of the bodies that can have one.
godot::Ref<godot::PhysicsMaterial> material_of(const godot::CollisionObject3D& body);
BodyValues read_values(const godot::CollisionObject3D& body, const BodyDefaults& defaults);

// What a body is made from: a change makes it anew.
struct BodyMakings {
    double mass = 1.0;
    bool solid_of_mesh = false;  // what is not given below is that of the touched mesh, filled evenly
    godot::Vector3 inertia;      // zero: that of the shapes
    std::optional<Vec3> center_of_mass;
    bool continuous = false;
    bool can_sleep = true;
    std::uint32_t locks = 0;  // bit i: axis i of x, y, z, and of the turns about x, y, z
    bool operator==(const BodyMakings&) const = default;
};
BodyMakings read_makings(const godot::CollisionObject3D& body);

void put_into(BodyDescription& description, const BodyMakings& makings);
void put_into(BodyAddition& addition, const BodyValues& values);

}  // namespace tactus
