// Bodies for tests of discovery: one that uses every field, and meshes of any size.
#pragma once

#include <memory>

#include "network/messages.hpp"

namespace tactus::samples {

inline std::shared_ptr<const TriangleMesh> tetrahedron() {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->vertices = {{0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, {0.0, 0.25, 0.0}, {0.0, 0.0, 0.125}};
    mesh->triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return mesh;
}

inline ObjectDescription object_of_all_shapes(ObjectId id) {
    ObjectDescription object;
    object.object = id;
    object.name = "Table/Box";
    object.touch.stiffness = 750.0;
    object.touch.damping = 1.5;
    object.touch.static_friction = 0.5;
    object.touch.dynamic_friction = 0.25;
    object.touch.pop_through_force = 3.0;
    object.touch.impact_strength = 4.0;
    object.touch.impact_frequency = 250.0;
    object.touch.impact_decay = 0.125;
    object.touch.stribeck_speed = 0.0625;
    object.touch.stiffening = 2.5;
    object.touch.stiffening_depth = 0.03125;
    object.touch.by_uv = true;
    const TouchImage heights{2, 3, {0.0f, 0.25f, 0.5f, 0.75f, 1.0f, 0.125f}};
    const TouchImage friction{1, 2, {0.5f, 1.0f}};
    object.detail = std::make_shared<const TouchDetail>(TouchDetail{
        {std::make_shared<const TouchImage>(heights), std::make_shared<const TouchImage>(friction)}, {}});
    object.touch.detail = object.detail.get();

    BodyDescription& body = object.body;
    body.motion = Motion::Dynamic;
    body.may_move = true;
    body.pose = {{0.5, -1.0, 2.0}, {0.5, 0.5, -0.5, 0.5}};
    body.mass = 0.125;
    body.center_of_mass = Vec3(0.01, 0.02, 0.03);
    body.inertia = Vec3(0.001, 0.002, 0.003);
    body.material = {0.75, 0.25, true, false};
    body.linear_damping = 0.1;
    body.angular_damping = 0.2;
    body.gravity_scale = -1.0;
    body.linear_velocity = {1.0, 2.0, 3.0};
    body.angular_velocity = {-1.0, -2.0, -3.0};
    body.collision = {5, 0x80000003u};
    body.continuous = true;
    body.can_sleep = false;
    body.lock_linear[0] = true;
    body.lock_angular[2] = true;

    const Pose aside{{0.25, 0.5, 0.75}, {0.5, -0.5, 0.5, 0.5}};
    HeightFieldShape field;
    field.columns = 2;
    field.rows = 3;
    field.scale = {0.5, 2.0, 0.25};
    field.heights = std::make_shared<const std::vector<float>>(std::vector<float>{0, 1, -2, 3, 4, 5});
    body.shapes = {{SphereShape{0.1}, {}},
                   {BoxShape{{0.1, 0.2, 0.3}}, aside},
                   {CapsuleShape{0.1, 0.2}, aside},
                   {CylinderShape{0.3, 0.4}, {}},
                   {PlaneShape{{0.0, 0.0, 1.0}, -0.5}, {}},
                   {ConvexHullShape{tetrahedron()}, aside},
                   {MeshShape{tetrahedron(), 0.7}, {}},
                   {field, aside}};
    object.touch_shapes = {{MeshShape{tetrahedron(), 0.25}, aside}};
    return object;
}

// A strip of triangles: 24 bytes a corner and 12 a triangle.
inline ObjectDescription object_of_size(ObjectId id, std::uint32_t corners) {
    auto mesh = std::make_shared<TriangleMesh>();
    for (std::uint32_t i = 0; i < corners; ++i) {
        mesh->vertices.push_back({0.01 * i, i % 2 == 0 ? 0.0 : 0.1, 0.001 * id});
    }
    for (std::uint32_t i = 2; i < corners; ++i) {
        mesh->triangles.push_back({i - 2, i - 1, i});
    }
    ObjectDescription object;
    object.object = id;
    object.name = "Strip" + std::to_string(id);
    object.body.motion = Motion::Static;
    object.body.shapes = {{MeshShape{mesh, 0.0}, {}}};
    return object;
}

}  // namespace tactus::samples
