#include "nodes/touched_cloud.hpp"

#include <godot_cpp/classes/collision_shape3d.hpp>
#include <godot_cpp/classes/mesh_instance3d.hpp>
#include <godot_cpp/classes/sphere_shape3d.hpp>
#include <utility>

#include "nodes/conversions.hpp"
#include "nodes/haptic_mesh.hpp"
#include "nodes/mesh_drawing.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

// What collides instead, where nothing is: hands alone feel the points, for bodies they are too rough (unit:
// meters).
constexpr float away = -10.0f;
constexpr float tiny = 0.001f;

}  // namespace

StaticBody3D* new_still_body(const char* name, const Ref<Shape3D>& shape, const Vector3& at) {
    auto* const body = memnew(StaticBody3D);
    body->set_name(name);
    body->set_as_top_level(true);
    auto* const part = memnew(CollisionShape3D);
    part->set_shape(shape);
    part->set_position(at);
    body->add_child(part);
    return body;
}

void TouchedCloud::make(Node3D& sensor, bool is_shown) {
    is_shown_ = is_shown;
    Ref<SphereShape3D> sphere;
    sphere.instantiate();
    sphere->set_radius(tiny);
    StaticBody3D* const body = new_still_body("cloud", sphere, Vector3(0.0f, away, 0.0f));
    auto* const touched = memnew(HapticMesh);
    touched->set("mesh", mesh_);
    body->add_child(touched);
    if (is_shown) {
        auto* const drawn = memnew(MeshInstance3D);
        drawn->set_mesh(mesh_);
        drawn->set_material_override(see_through_material(cloud_color));
        body->add_child(drawn);
    }
    sensor.add_child(body, true);
    body_ = body->get_instance_id();
}

void TouchedCloud::update(Node3D& sensor, const MeshView& surface, bool is_shown) {
    if (surface.triangles.empty()) {
        return;
    }
    if (is_shown != is_shown_) {
        clear();
    }
    PackedInt32Array indices;
    indices.resize(static_cast<int64_t>(3 * surface.triangles.size()));
    int64_t at = 0;
    for (const auto& [a, b, c] : surface.triangles) {
        // Godot's front is clockwise.
        for (const std::uint32_t corner : {a, c, b}) {
            indices[at++] = static_cast<int32_t>(corner);
        }
    }
    if (mesh_.is_null()) {
        mesh_.instantiate();
    }
    mesh_->clear_surfaces();
    add_surface(**mesh_, Mesh::PRIMITIVE_TRIANGLES, {packed(surface.vertices), {}, indices});
    mesh_->emit_changed();
    if (node_of_id<Node>(body_) == nullptr) {
        make(sensor, is_shown);
    }
}

void TouchedCloud::clear() {
    free_later(std::exchange(body_, 0));
    mesh_.unref();
}

}  // namespace tactus
