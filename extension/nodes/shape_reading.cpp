#include "nodes/shape_reading.hpp"

#include <algorithm>
#include <godot_cpp/classes/box_shape3d.hpp>
#include <godot_cpp/classes/capsule_shape3d.hpp>
#include <godot_cpp/classes/concave_polygon_shape3d.hpp>
#include <godot_cpp/classes/convex_polygon_shape3d.hpp>
#include <godot_cpp/classes/cylinder_shape3d.hpp>
#include <godot_cpp/classes/height_map_shape3d.hpp>
#include <godot_cpp/classes/sphere_shape3d.hpp>
#include <godot_cpp/classes/world_boundary_shape3d.hpp>
#include <optional>
#include <unordered_map>

#include "nodes/conversions.hpp"
#include "nodes/mesh_source.hpp"

namespace tactus {

namespace {

using godot::Object;
using godot::Ref;

// What the shape is before it is scaled; nothing where it is made of points or triangles, or none at all.
std::optional<Shape> plain_shape(Object* object) {
    if (const auto* box = Object::cast_to<godot::BoxShape3D>(object)) {
        return BoxShape{0.5 * from_godot(box->get_size())};
    }
    if (const auto* sphere = Object::cast_to<godot::SphereShape3D>(object)) {
        return SphereShape{sphere->get_radius()};
    }
    if (const auto* capsule = Object::cast_to<godot::CapsuleShape3D>(object)) {
        const double radius = capsule->get_radius();
        return CapsuleShape{radius, std::max(0.0, 0.5 * capsule->get_height() - radius)};
    }
    if (const auto* cylinder = Object::cast_to<godot::CylinderShape3D>(object)) {
        return CylinderShape{cylinder->get_radius(), 0.5 * cylinder->get_height()};
    }
    if (const auto* map = Object::cast_to<godot::HeightMapShape3D>(object)) {
        const godot::PackedFloat32Array data = map->get_map_data();
        auto heights = std::make_shared<std::vector<float>>(data.ptr(), data.ptr() + data.size());
        std::ranges::replace_if(*heights, is_hole, hole_height);
        return HeightFieldShape{static_cast<std::uint32_t>(map->get_map_width()),
                                static_cast<std::uint32_t>(map->get_map_depth()), Vec3(1.0),
                                std::move(heights)};
    }
    if (const auto* boundary = Object::cast_to<godot::WorldBoundaryShape3D>(object)) {
        const godot::Plane plane = boundary->get_plane();
        return PlaneShape{from_godot(plane.normal), plane.d};
    }
    return std::nullopt;
}

// Bodies with the same shape resource share its triangles, as long as one of them is there.
std::shared_ptr<TriangleSource> concave_source(const godot::ConcavePolygonShape3D& concave) {
    struct Known {
        godot::PackedVector3Array faces;
        std::weak_ptr<TriangleSource> source;
    };
    static std::unordered_map<std::uint64_t, Known> all;
    const godot::PackedVector3Array faces = concave.get_faces();
    std::erase_if(all, [](const auto& entry) { return entry.second.source.expired(); });
    Known& known = all[concave.get_instance_id()];
    std::shared_ptr<TriangleSource> source = known.source.lock();
    const bool is_same = known.faces.ptr() == faces.ptr() || known.faces == faces;
    if (source == nullptr || !is_same) {
        const std::shared_ptr<TriangleSource> made = source_of(faces);
        if (source != nullptr) {
            made->succeed(source);
        }
        source = made;
        known = {faces, source};
    }
    return source;
}

}  // namespace

ShapeReading read_shape(const Ref<godot::Shape3D>& shape, const SceneFrame& frame) {
    ShapeReading reading;
    reading.error = problem_of_shape_frame(frame);
    if (!reading.error.empty()) {
        return reading;
    }
    const Pose pose = pose_of(frame);
    const Mat3 scaling = scaling_of(frame);
    Object* object = shape.ptr();
    if (const std::optional<Shape> plain = plain_shape(object)) {
        return scaled_shape(*plain, scaling, pose);
    }
    if (const auto* convex = Object::cast_to<godot::ConvexPolygonShape3D>(object)) {
        return scaled_hull(from_godot(convex->get_points()), scaling, pose);
    }
    if (const auto* concave = Object::cast_to<godot::ConcavePolygonShape3D>(object)) {
        reading.meshes.push_back({concave_source(*concave), scaling, pose, 0.0, false, {}});
        return reading;
    }
    reading.error =
        "a " + from_godot(shape->get_class()) +
        " cannot be touched: use a box, sphere, capsule, cylinder, convex, concave, height map or "
        "world boundary shape, or a HapticMesh";
    return reading;
}

}  // namespace tactus
