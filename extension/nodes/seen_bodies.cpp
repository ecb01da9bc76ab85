#include "nodes/seen_bodies.hpp"

#include <algorithm>
#include <godot_cpp/classes/box_shape3d.hpp>
#include <godot_cpp/classes/collision_shape3d.hpp>
#include <godot_cpp/classes/convex_polygon_shape3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/classes/static_body3d.hpp>
#include <unordered_set>
#include <utility>

#include "core/math/least_turn.hpp"
#include "core/teleop/body_motion.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_mesh.hpp"
#include "nodes/mesh_drawing.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

const Color known_color(0.25f, 0.65f, 0.35f, 1.0f);
const Color unknown_color(0.85f, 0.6f, 0.2f, 1.0f);
const Color cloud_color(0.2f, 0.75f, 0.9f, 1.0f);

// Of what nobody knows the mass of: that of water (unit: kilograms per cubic meter).
constexpr double unknown_density = 1000.0;

// Of the support (unit: meters).
constexpr float support_size = 2.0f;
constexpr float support_thickness = 0.04f;

// Less is noise of the camera (unit: meters; cosine of 0.5 degrees).
constexpr double support_shift = 0.002;
constexpr double support_cosine = 0.99996;

TriangleMesh copy_of(const MeshView& view) {
    return {{view.vertices.begin(), view.vertices.end()}, {view.triangles.begin(), view.triangles.end()}};
}

// Of a closed mesh, by the tetrahedra between its triangles and the origin.
double volume_of(const TriangleMesh& mesh) {
    double volume = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        volume += glm::dot(mesh.vertices[a], glm::cross(mesh.vertices[b], mesh.vertices[c])) / 6.0;
    }
    return std::abs(volume);
}

bool moves(const SightedObject& object) {
    return object.linear_velocity != Vec3(0.0) || object.angular_velocity != Vec3(0.0);
}

// Where it is after `seconds` if it goes on as it moves.
Pose pose_after(const SightedObject& object, double seconds) {
    if (!moves(object)) {
        return object.pose;
    }
    return {object.pose.position + seconds * object.linear_velocity,
            glm::normalize(turn_by(object.angular_velocity, seconds) * object.pose.rotation)};
}

bool is_known(const SightedObject& object, std::span<const SeenMesh> library) {
    return object.mesh >= 0 && static_cast<std::size_t>(object.mesh) < library.size();
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

String name_of_mesh(const SightedObject& object, std::span<const SeenMesh> library) {
    return is_known(object, library) ? library[static_cast<std::size_t>(object.mesh)].name
                                     : String("unknown");
}

// A body's name goes over the network with it: it must stay.
Node3D* SeenBodies::make(const SightedObject& object, std::span<const SeenMesh> library,
                         const Looks& looks) const {
    const bool knows = is_known(object, library);
    const TriangleMesh mesh =
        knows ? *library[static_cast<std::size_t>(object.mesh)].mesh : copy_of(object.hull);
    MeshInstance3D* const drawn =
        looks.show_objects ? picture(mesh, knows ? known_color : unknown_color) : nullptr;
    Node3D* made = drawn;
    if (looks.objects != SeenAs::pictures) {
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
        made->set_name(name_of_mesh(object, library) + "_" +
                       String::num_int64(static_cast<int64_t>(object.id)));
        made->set_as_top_level(true);
    }
    return made;
}

void SeenBodies::place(Made& made, const SightedObject& object, double age) const {
    made.pose = pose_after(object, age);
    auto* const node = node_of_id<Node3D>(made.node);
    if (node == nullptr) {
        return;
    }
    node->set_global_transform(to_godot(made.pose));
    auto* const body = Object::cast_to<RigidBody3D>(node);
    if (body != nullptr && !body->is_freeze_enabled()) {
        body->set_linear_velocity(to_godot(object.linear_velocity));
        body->set_angular_velocity(to_godot(object.angular_velocity));
    }
}

void SeenBodies::go_on(const Sight& sight, double age) {
    for (const SightedObject& object : sight.objects) {
        const auto made = made_.find(object.id);
        if (made != made_.end() && moves(object)) {
            place(made->second, object, age);
        }
    }
}

void SeenBodies::update(Node3D& sensor, const Sight& sight, std::span<const SeenMesh> library,
                        const Looks& looks, double age) {
    if (std::exchange(made_as_, looks.objects) != looks.objects ||
        std::exchange(are_shown_, looks.show_objects) != looks.show_objects) {
        clear();
    }
    std::unordered_set<std::uint64_t> there;
    for (const SightedObject& object : sight.objects) {
        if (object.state == SightState::lost) {
            continue;
        }
        there.insert(object.id);
        Made& made = made_[object.id];
        const bool is_other = made.mesh != object.mesh || made.hull_corners != object.hull.vertices.size();
        if (made.node != 0 && is_other) {
            free_later(made.node);
            made.node = 0;
        }
        if (made.node == 0) {
            made.mesh = object.mesh;
            made.hull_corners = object.hull.vertices.size();
            if (Node3D* const node = make(object, library, looks)) {
                node->set_transform(to_godot(object.pose));
                sensor.add_child(node, true);
                made.node = node->get_instance_id();
            }
        }
        place(made, object, age);
    }
    std::erase_if(made_, [&](const auto& one) {
        if (there.contains(one.first)) {
            return false;
        }
        free_later(one.second.node);
        return true;
    });
    hold_support(sensor, sight.plane, looks.objects != SeenAs::pictures);
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
    const double shift = std::abs(plane.offset - support_plane_.offset);
    if (!is_new && shift < support_shift && glm::dot(plane.normal, support_plane_.normal) > support_cosine) {
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
    const auto found = made_.find(object);
    return found != made_.end() ? node_of_id<Node3D>(found->second.node) : nullptr;
}

void SeenBodies::clear() {
    for (const auto& [id, made] : made_) {
        free_later(made.node);
    }
    made_.clear();
    free_later(std::exchange(cloud_, 0));
    free_later(std::exchange(support_, 0));
}

}  // namespace tactus
