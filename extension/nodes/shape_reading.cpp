#include "nodes/shape_reading.hpp"

#include <algorithm>
#include <godot_cpp/classes/box_shape3d.hpp>
#include <godot_cpp/classes/capsule_shape3d.hpp>
#include <godot_cpp/classes/concave_polygon_shape3d.hpp>
#include <godot_cpp/classes/convex_polygon_shape3d.hpp>
#include <godot_cpp/classes/cylinder_shape3d.hpp>
#include <godot_cpp/classes/height_map_shape3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/sphere_shape3d.hpp>
#include <godot_cpp/classes/world_boundary_shape3d.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <optional>
#include <unordered_map>

#include "nodes/conversions.hpp"
#include "nodes/mesh_source.hpp"

namespace tactus {

namespace {

using godot::Object;
using godot::Ref;

HeightFieldShape height_field(int64_t width, int64_t depth, const godot::PackedFloat32Array& data) {
    auto heights = std::make_shared<std::vector<float>>(data.ptr(), data.ptr() + data.size());
    std::ranges::replace_if(*heights, is_hole, hole_height);
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(depth), Vec3(1.0),
            std::move(heights)};
}

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
        return height_field(map->get_map_width(), map->get_map_depth(), map->get_map_data());
    }
    if (const auto* boundary = Object::cast_to<godot::WorldBoundaryShape3D>(object)) {
        const godot::Plane plane = boundary->get_plane();
        return PlaneShape{from_godot(plane.normal), plane.d};
    }
    return std::nullopt;
}

// Bodies with the same shape share its triangles, as long as one of them is there. `Id` keeps resources and
// RIDs apart.
template <class Id>
std::shared_ptr<TriangleSource> concave_source(std::uint64_t shape, const godot::PackedVector3Array& faces) {
    struct Known {
        godot::PackedVector3Array faces;
        std::weak_ptr<TriangleSource> source;
    };
    static std::unordered_map<std::uint64_t, Known> all;
    std::erase_if(all, [](const auto& entry) { return entry.second.source.expired(); });
    Known& known = all[shape];
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

// ShapeReading read(const Mat3& scaling, const Pose& pose).
template <class Read>
ShapeReading in_frame(const SceneFrame& frame, const Read& read) {
    if (std::string problem = problem_of_shape_frame(frame); !problem.empty()) {
        return {{}, {}, std::move(problem)};
    }
    return read(scaling_of(frame), pose_of(frame));
}

ShapeReading meshes_of(std::shared_ptr<TriangleSource> source, const Mat3& scaling, const Pose& pose) {
    return {{}, {{std::move(source), scaling, pose, 0.0, false, {}}}, {}};
}

// Godot copies all of them when it is asked.
constexpr int64_t max_server_corners = 3 * 500'000;
constexpr int64_t max_server_heights = 4'194'304;

ShapeReading too_large(const char* what) {
    return {{},
            {},
            std::string("it has more than ") + what +
                ", and is not felt: split it into several bodies, or give it as a StaticBody3D with a "
                "HapticMesh"};
}

ShapeReading server_height_map(const godot::Dictionary& data, const Mat3& scaling, const Pose& pose) {
    const godot::PackedFloat32Array heights = data["heights"];
    if (heights.size() > max_server_heights) {
        return too_large("4,194,304 heights");
    }
    return scaled_shape(height_field(data["width"], data["depth"], heights), scaling, pose);
}

ShapeReading server_concave(const godot::RID& shape, const godot::Dictionary& data, const Mat3& scaling,
                            const Pose& pose) {
    const godot::PackedVector3Array faces = data["faces"];
    if (faces.size() > max_server_corners) {
        return too_large("500,000 triangles");
    }
    const auto id = static_cast<std::uint64_t>(shape.get_id());
    return meshes_of(concave_source<godot::RID>(id, faces), scaling, pose);
}

// The shapes of a PhysicsServer3D, by its own measures.
ShapeReading server_shape(const godot::RID& shape, const Mat3& scaling, const Pose& pose) {
    using Server = godot::PhysicsServer3D;
    const Server::ShapeType type = Server::get_singleton()->shape_get_type(shape);
    const godot::Variant data = Server::get_singleton()->shape_get_data(shape);
    const auto measure = [&data](const char* name) {
        return static_cast<double>(static_cast<godot::Dictionary>(data)[name]);
    };
    switch (type) {
        case Server::SHAPE_BOX:
            return scaled_shape(BoxShape{from_godot(static_cast<godot::Vector3>(data))}, scaling, pose);
        case Server::SHAPE_SPHERE:
            return scaled_shape(SphereShape{static_cast<double>(data)}, scaling, pose);
        case Server::SHAPE_CAPSULE: {
            const double radius = measure("radius");
            return scaled_shape(CapsuleShape{radius, std::max(0.0, 0.5 * measure("height") - radius)},
                                scaling, pose);
        }
        case Server::SHAPE_CYLINDER:
            return scaled_shape(CylinderShape{measure("radius"), 0.5 * measure("height")}, scaling, pose);
        case Server::SHAPE_CONVEX_POLYGON:
            return scaled_hull(from_godot(static_cast<godot::PackedVector3Array>(data)), scaling, pose);
        case Server::SHAPE_CONCAVE_POLYGON:
            return server_concave(shape, data, scaling, pose);
        case Server::SHAPE_HEIGHTMAP:
            return server_height_map(data, scaling, pose);
        case Server::SHAPE_WORLD_BOUNDARY: {
            const godot::Plane plane = data;
            return scaled_shape(PlaneShape{from_godot(plane.normal), plane.d}, scaling, pose);
        }
        default:
            return {{}, {}, "one of its shapes is of a kind that cannot be felt: give it another shape"};
    }
}

}  // namespace

ShapeReading read_shape(const Ref<godot::Shape3D>& shape, const SceneFrame& frame) {
    return in_frame(frame, [&shape](const Mat3& scaling, const Pose& pose) -> ShapeReading {
        Object* object = shape.ptr();
        if (const std::optional<Shape> plain = plain_shape(object)) {
            return scaled_shape(*plain, scaling, pose);
        }
        if (const auto* convex = Object::cast_to<godot::ConvexPolygonShape3D>(object)) {
            return scaled_hull(from_godot(convex->get_points()), scaling, pose);
        }
        if (const auto* concave = Object::cast_to<godot::ConcavePolygonShape3D>(object)) {
            const auto source =
                concave_source<godot::Shape3D>(concave->get_instance_id(), concave->get_faces());
            return meshes_of(source, scaling, pose);
        }
        return {
            {},
            {},
            "a " + from_godot(shape->get_class()) +
                " cannot be touched: use a box, sphere, capsule, cylinder, convex, concave, height map or "
                "world boundary shape, or a HapticMesh"};
    });
}

ShapeReading read_server_shape(const godot::RID& shape, const SceneFrame& frame) {
    return in_frame(frame, [&shape](const Mat3& scaling, const Pose& pose) {
        return server_shape(shape, scaling, pose);
    });
}

}  // namespace tactus
