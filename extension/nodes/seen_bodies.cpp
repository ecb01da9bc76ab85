#include "nodes/seen_bodies.hpp"

#include <algorithm>
#include <godot_cpp/classes/box_shape3d.hpp>
#include <godot_cpp/classes/collision_shape3d.hpp>
#include <godot_cpp/classes/convex_polygon_shape3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/classes/static_body3d.hpp>
#include <utility>

#include "core/math/least_turn.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_mesh.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/mesh_drawing.hpp"
#include "nodes/tree_walk.hpp"
#include "physics/solid_properties.hpp"

namespace tactus {

using namespace godot;

namespace {

const Color known_color(0.25f, 0.65f, 0.35f, 1.0f);
const Color unknown_color(0.85f, 0.6f, 0.2f, 1.0f);

// Of what nobody knows the mass of: that of water (unit: kilograms per cubic meter).
constexpr double unknown_density = 1000.0;

// Of the support (unit: meters).
constexpr float support_size = 2.0f;
constexpr float support_thickness = 0.04f;

TriangleMesh copy_of(const MeshView& view) {
    return {{view.vertices.begin(), view.vertices.end()}, {view.triangles.begin(), view.triangles.end()}};
}

// (unit: cubic meters)
double volume_of(const TriangleMesh& mesh) {
    const std::optional<SolidProperties> solid = solid_properties(mesh);
    return solid ? solid->volume : 0.0;
}

bool is_known(std::int32_t mesh, std::span<const SeenMesh> library) {
    return mesh >= 0 && static_cast<std::size_t>(mesh) < library.size();
}

Ref<ConvexPolygonShape3D> hull_shape(const TriangleMesh& mesh) {
    PackedVector3Array corners;
    for (const Vec3& vertex : mesh.vertices) {
        corners.push_back(to_godot(vertex));
    }
    Ref<ConvexPolygonShape3D> shape;
    shape.instantiate();
    shape->set_points(corners);
    return shape;
}

MeshInstance3D* picture(const TriangleMesh& mesh, const Color& color) {
    auto* const drawn = memnew(MeshInstance3D);
    drawn->set_mesh(drawn_mesh({mesh}));
    drawn->set_material_override(lit_material(color));
    return drawn;
}

}  // namespace

String name_of_mesh(std::int32_t mesh, std::span<const SeenMesh> library) {
    return is_known(mesh, library) ? library[static_cast<std::size_t>(mesh)].name : String("unknown");
}

// A body's name goes over the network with it: it must stay.
Node3D* SeenBodies::make(const SightedObject& object, std::span<const SeenMesh> library,
                         const Looks& looks) const {
    const bool knows = is_known(object.mesh, library);
    const TriangleMesh mesh =
        knows ? *library[static_cast<std::size_t>(object.mesh)].mesh : copy_of(object.hull);
    MeshInstance3D* const drawn =
        looks.show_objects ? picture(mesh, knows ? known_color : unknown_color) : nullptr;
    Node3D* made = drawn;
    if (looks.objects != SeenAs::pictures && (knows || !looks.touch_cloud)) {
        auto* const body = memnew(RigidBody3D);
        const double mass = knows ? library[static_cast<std::size_t>(object.mesh)].mass : 0.0;
        body->set_mass(std::max(1e-3, mass > 0.0 ? mass : unknown_density * volume_of(mesh)));
        body->set_freeze_mode(RigidBody3D::FREEZE_MODE_KINEMATIC);
        body->set_freeze_enabled(looks.objects == SeenAs::held_bodies);
        if (drawn != nullptr) {
            body->add_child(drawn);
        }
        if (knows) {
            auto* const touched = memnew(HapticMesh);
            touched->set("library_mesh", library[static_cast<std::size_t>(object.mesh)].name);
            body->add_child(touched);
        } else {
            auto* const shape = memnew(CollisionShape3D);
            shape->set_shape(hull_shape(mesh));
            body->add_child(shape);
        }
        made = body;
    }
    if (made != nullptr) {
        made->set_name(name_of_mesh(object.mesh, library) + "_" +
                       String::num_int64(static_cast<int64_t>(object.id)));
        made->set_as_top_level(true);
    }
    return made;
}

// What is pushed belongs to the loop, which is told at once; its node follows. All else goes where its node
// is put.
void SeenBodies::place(HapticWorld* world, const SightedObject& object, double age) const {
    Node3D* const node = node_of(object.id);
    if (node == nullptr) {
        return;
    }
    const BodySighting sighting{
        {object.pose, object.linear_velocity, object.angular_velocity}, age, object.chance};
    const bool is_told =
        looks_.objects == SeenAs::free_bodies && world != nullptr && world->see(node, sighting);
    if (!is_told) {
        node->set_global_transform(to_godot(pose_after(object, age)));
    }
}

void SeenBodies::go_on(const Sight& sight, double age) {
    for (const SightedObject& object : sight.objects) {
        if (moves(object) && looks_.objects != SeenAs::free_bodies) {
            place(nullptr, object, age);
        }
    }
}

void SeenBodies::update(Node3D& sensor, const Sight& sight, std::span<const SeenMesh> library,
                        const Looks& looks, double age) {
    const Looks before = std::exchange(looks_, looks);
    if (before.objects != looks.objects || before.show_objects != looks.show_objects ||
        before.touch_cloud != looks.touch_cloud) {
        clear();
    }
    const auto show = [&](const SightedObject& object) -> std::uint64_t {
        Node3D* const node = make(object, library, looks);
        if (node == nullptr) {
            return 0;
        }
        node->set_transform(to_godot(object.pose));
        sensor.add_child(node, true);
        return node->get_instance_id();
    };
    roll_.update(sight, show, free_later);
    HapticWorld* const world = HapticWorld::above(&sensor);
    for (const SightedObject& object : sight.objects) {
        place(world, object, age);
    }
    hold_support(sensor, sight.plane, looks.objects != SeenAs::pictures || looks.touch_cloud);
    if (looks.touch_cloud) {
        touched_cloud_.update(sensor, sight.surface, looks.show_objects);
    } else {
        touched_cloud_.clear();
    }
    draw_cloud(sensor, sight, looks.show_cloud);
}

// What the objects stand on is a slab, and is put elsewhere only where it is seen to be: its noise would
// shake all that stands on it.
void SeenBodies::hold_support(Node3D& sensor, const SupportPlane& plane, bool is_wanted) {
    auto* slab = node_of_id<Node3D>(support_);
    if (!is_wanted || !plane.is_found) {
        if (!is_wanted) {
            free_later(std::exchange(support_, 0));
        }
        return;
    }
    const bool is_new = slab == nullptr;
    if (is_new) {
        Ref<BoxShape3D> box;
        box.instantiate();
        box->set_size(Vector3(support_size, support_thickness, support_size));
        auto* const shape = memnew(CollisionShape3D);
        shape->set_shape(box);
        slab = memnew(StaticBody3D);
        slab->set_name("support");
        slab->set_as_top_level(true);
        slab->add_child(shape);
        sensor.add_child(slab, true);
        support_ = slab->get_instance_id();
    }
    if (!is_new && !is_elsewhere(plane, support_plane_)) {
        return;
    }
    support_plane_ = plane;
    const Vec3 under = (plane.offset - 0.5 * support_thickness) * plane.normal;
    slab->set_global_transform(to_godot(Pose{under, least_turn({0.0, 1.0, 0.0}, plane.normal)}));
}

void SeenBodies::draw_cloud(Node3D& sensor, const Sight& sight, bool is_wanted) {
    auto* drawn = node_of_id<MeshInstance3D>(cloud_);
    if (!is_wanted) {
        free_later(std::exchange(cloud_, 0));
        return;
    }
    if (drawn == nullptr) {
        drawn = memnew(MeshInstance3D);
        drawn->set_material_override(see_through_material(cloud_color));
        sensor.add_child(drawn, false, Node::INTERNAL_MODE_BACK);
        cloud_ = drawn->get_instance_id();
    }
    PackedVector3Array points;
    points.resize(static_cast<int64_t>(sight.cloud.size()));
    for (std::size_t i = 0; i < sight.cloud.size(); ++i) {
        points[static_cast<int64_t>(i)] = to_godot(Vec3(sight.cloud[i]));
    }
    Ref<ArrayMesh> mesh;
    mesh.instantiate();
    if (!points.is_empty()) {
        Array arrays;
        arrays.resize(Mesh::ARRAY_MAX);
        arrays[Mesh::ARRAY_VERTEX] = points;
        mesh->add_surface_from_arrays(Mesh::PRIMITIVE_POINTS, arrays);
    }
    drawn->set_mesh(mesh);
}

Node3D* SeenBodies::node_of(std::uint64_t object) const {
    return node_of_id<Node3D>(roll_.node_of(object));
}

void SeenBodies::clear() {
    roll_.hide_all(free_later);
    free_later(std::exchange(cloud_, 0));
    free_later(std::exchange(support_, 0));
    touched_cloud_.clear();
}

}  // namespace tactus
