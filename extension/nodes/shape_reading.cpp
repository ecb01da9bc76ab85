#include "nodes/shape_reading.hpp"

#include <algorithm>
#include <cmath>
#include <godot_cpp/classes/box_shape3d.hpp>
#include <godot_cpp/classes/capsule_shape3d.hpp>
#include <godot_cpp/classes/concave_polygon_shape3d.hpp>
#include <godot_cpp/classes/convex_polygon_shape3d.hpp>
#include <godot_cpp/classes/cylinder_shape3d.hpp>
#include <godot_cpp/classes/height_map_shape3d.hpp>
#include <godot_cpp/classes/sphere_shape3d.hpp>
#include <godot_cpp/classes/world_boundary_shape3d.hpp>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "core/geometry/convex_hull.hpp"
#include "core/geometry/touch_shape.hpp"
#include "nodes/conversions.hpp"

namespace tactus {

namespace {

using godot::Object;
using godot::Ref;

// How far two factors that should be equal may differ: Godot's single precision leaves about 1e-7 each.
constexpr double even = 1e-4;  // (dimensionless)

// The length of each axis after scaling, or an error where the axes no longer stand square to each other.
struct AxisFactors {
    Vec3 factors{1.0};
    bool square = true;
};

AxisFactors axis_factors(const godot::Basis& scaling) {
    const Vec3 x = from_godot(scaling.get_column(0));
    const Vec3 y = from_godot(scaling.get_column(1));
    const Vec3 z = from_godot(scaling.get_column(2));
    const Vec3 lengths{glm::length(x), glm::length(y), glm::length(z)};
    const auto square = [](const Vec3& a, const Vec3& b) {
        return std::abs(glm::dot(a, b)) <= even * glm::length(a) * glm::length(b);
    };
    return {lengths, square(x, y) && square(y, z) && square(z, x)};
}

bool same_factor(double a, double b) {
    return std::abs(a - b) <= even * std::abs(a);
}

ShapeReading failure(std::string error) {
    return {{}, {}, std::move(error)};
}

ShapeReading one(Shape shape, const Pose& pose) {
    return {{PlacedShape{std::move(shape), pose}}, {}, {}};
}

// A shape without triangles is made in no time, so that what is wrong with its size shows at once.
ShapeReading one_solid(Shape shape, const Pose& pose) {
    ShapeReading reading = one(std::move(shape), pose);
    std::string error = make_touch_shape(reading.shapes).error;
    return error.empty() ? reading : failure(std::move(error));
}

ShapeReading uneven(const char* kind) {
    return failure(std::string("its ") + kind +
                   " is scaled differently along its axes: scale it evenly, or touch a HapticMesh instead");
}

ShapeReading placed(const godot::BoxShape3D& box, const AxisFactors& scale, const Pose& pose) {
    if (!scale.square) {
        return uneven("box");
    }
    return one_solid(BoxShape{0.5 * from_godot(box.get_size()) * scale.factors}, pose);
}

ShapeReading placed(const godot::SphereShape3D& sphere, const AxisFactors& scale, const Pose& pose) {
    const Vec3& f = scale.factors;
    if (!scale.square || !same_factor(f.x, f.y) || !same_factor(f.x, f.z)) {
        return uneven("sphere");
    }
    return one_solid(SphereShape{sphere.get_radius() * f.x}, pose);
}

ShapeReading placed(const godot::CapsuleShape3D& capsule, const AxisFactors& scale, const Pose& pose) {
    const Vec3& f = scale.factors;
    if (!scale.square || !same_factor(f.x, f.y) || !same_factor(f.x, f.z)) {
        return uneven("capsule");
    }
    const double radius = capsule.get_radius();
    return one_solid(CapsuleShape{radius * f.x, std::max(0.0, 0.5 * capsule.get_height() - radius) * f.x},
                     pose);
}

ShapeReading placed(const godot::CylinderShape3D& cylinder, const AxisFactors& scale, const Pose& pose) {
    const Vec3& f = scale.factors;
    if (!scale.square || !same_factor(f.x, f.z)) {
        return uneven("cylinder");
    }
    return one_solid(CylinderShape{cylinder.get_radius() * f.x, 0.5 * cylinder.get_height() * f.y}, pose);
}

// A mirrored frame is one that is turned and scaled by less than zero along all axes. As well, it is turned
// by half a turn more about x, and mirrored along x alone: then up stays up.
ShapeReading placed(const godot::HeightMapShape3D& map, const AxisFactors& scale, bool mirrored, Pose pose) {
    if (!scale.square) {
        return uneven("height map");
    }
    Vec3 factors = scale.factors;
    if (mirrored) {
        factors.x = -factors.x;
        pose.rotation = pose.rotation * Quat(0.0, 1.0, 0.0, 0.0);
    }
    const godot::PackedFloat32Array data = map.get_map_data();
    auto heights = std::make_shared<std::vector<float>>(data.ptr(), data.ptr() + data.size());
    return one(HeightFieldShape{static_cast<std::uint32_t>(map.get_map_width()),
                                static_cast<std::uint32_t>(map.get_map_depth()), factors, std::move(heights)},
               pose);
}

ShapeReading placed(const godot::WorldBoundaryShape3D& boundary, const godot::Basis& scaling,
                    const Pose& pose) {
    const godot::Plane plane = boundary.get_plane();
    const Vec3 normal = from_godot(scaling.inverse().transposed().xform(plane.normal));
    const Vec3 point = from_godot(scaling.xform(plane.normal * plane.d));
    if (!(glm::length(normal) > 0.0)) {
        return failure("its world boundary has no direction: give its plane a normal");
    }
    const Vec3 unit = glm::normalize(normal);
    return one(PlaneShape{unit, glm::dot(unit, point)}, pose);
}

ShapeReading placed(const godot::ConvexPolygonShape3D& convex, const godot::Basis& scaling,
                    const Pose& pose) {
    const godot::PackedVector3Array given = convex.get_points();
    std::vector<Vec3> points;
    for (std::int64_t i = 0; i < given.size(); ++i) {
        points.push_back(from_godot(scaling.xform(given[i])));
    }
    TriangleMesh hull = convex_hull(points);
    if (hull.triangles.empty()) {
        return failure(
            "its convex shape has no volume: give it at least four points that are not in one plane");
    }
    return one(ConvexHullShape{std::make_shared<TriangleMesh>(std::move(hull))}, pose);
}

// Bodies with the same shape resource share its triangles, as long as one of them is there.
std::shared_ptr<MeshSource> source_of(const godot::ConcavePolygonShape3D& concave) {
    static std::unordered_map<std::uint64_t, std::weak_ptr<MeshSource>> sources;
    const godot::PackedVector3Array faces = concave.get_faces();
    std::erase_if(sources, [](const auto& entry) { return entry.second.expired(); });
    std::weak_ptr<MeshSource>& known = sources[concave.get_instance_id()];
    std::shared_ptr<MeshSource> source = known.lock();
    if (source == nullptr || !source->has_faces(faces)) {
        const auto made = std::make_shared<MeshSource>(faces);
        if (source != nullptr) {
            made->succeed(*source);
        }
        known = source = made;
    }
    return source;
}

ShapeReading placed(const godot::ConcavePolygonShape3D& concave, const godot::Basis& scaling,
                    const Pose& pose) {
    return {{}, {{source_of(concave), without_rounding(scaling), pose, 0.0, false, {}}}, {}};
}

bool is_finite(const godot::Transform3D& transform) {
    return transform.is_finite();
}

bool same(const std::shared_ptr<const TriangleMesh>& a, const std::shared_ptr<const TriangleMesh>& b) {
    return a == b || (a->vertices == b->vertices && a->triangles == b->triangles);
}
bool same(const SphereShape& a, const SphereShape& b) {
    return a.radius == b.radius;
}
bool same(const BoxShape& a, const BoxShape& b) {
    return a.half_extents == b.half_extents;
}
bool same(const CapsuleShape& a, const CapsuleShape& b) {
    return a.radius == b.radius && a.half_segment == b.half_segment;
}
bool same(const CylinderShape& a, const CylinderShape& b) {
    return a.radius == b.radius && a.half_height == b.half_height;
}
bool same(const PlaneShape& a, const PlaneShape& b) {
    return a.normal == b.normal && a.offset == b.offset;
}
bool same(const ConvexHullShape& a, const ConvexHullShape& b) {
    return same(a.hull, b.hull);
}
bool same(const MeshShape& a, const MeshShape& b) {
    return a.smooth_below == b.smooth_below && a.one_sided == b.one_sided && same(a.mesh, b.mesh);
}
bool same(const HeightFieldShape& a, const HeightFieldShape& b) {
    return a.columns == b.columns && a.rows == b.rows && a.scale == b.scale && *a.heights == *b.heights;
}

bool same_shape(const Shape& a, const Shape& b) {
    return std::visit(
        [](const auto& left, const auto& right) {
            if constexpr (std::is_same_v<decltype(left), decltype(right)>) {
                return same(left, right);
            } else {
                return false;
            }
        },
        a, b);
}

}  // namespace

ShapeReading read_shape(const Ref<godot::Shape3D>& shape, const godot::Transform3D& transform) {
    if (!is_finite(transform)) {
        return failure("its transform is not made of finite numbers: reset it in the inspector");
    }
    if (transform.basis.determinant() == 0) {
        return failure("it is scaled to zero along an axis: give it a scale that is not zero");
    }
    const Pose pose = pose_of(transform);
    const godot::Basis scaling = scaling_of(transform.basis);
    const AxisFactors factors = axis_factors(scaling);
    Object* object = shape.ptr();
    if (auto* box = Object::cast_to<godot::BoxShape3D>(object)) {
        return placed(*box, factors, pose);
    }
    if (auto* sphere = Object::cast_to<godot::SphereShape3D>(object)) {
        return placed(*sphere, factors, pose);
    }
    if (auto* capsule = Object::cast_to<godot::CapsuleShape3D>(object)) {
        return placed(*capsule, factors, pose);
    }
    if (auto* cylinder = Object::cast_to<godot::CylinderShape3D>(object)) {
        return placed(*cylinder, factors, pose);
    }
    if (auto* convex = Object::cast_to<godot::ConvexPolygonShape3D>(object)) {
        return placed(*convex, scaling, pose);
    }
    if (auto* concave = Object::cast_to<godot::ConcavePolygonShape3D>(object)) {
        return placed(*concave, scaling, pose);
    }
    if (auto* map = Object::cast_to<godot::HeightMapShape3D>(object)) {
        return placed(*map, factors, scaling.determinant() < 0, pose);
    }
    if (auto* boundary = Object::cast_to<godot::WorldBoundaryShape3D>(object)) {
        return placed(*boundary, scaling, pose);
    }
    return failure(
        "a " + from_godot(shape->get_class()) +
        " cannot be touched: use a box, sphere, capsule, cylinder, convex, concave, height map or world "
        "boundary shape, or a HapticMesh");
}

bool same_meshes(const std::vector<MeshDraft>& a, const std::vector<MeshDraft>& b) {
    return std::ranges::equal(a, b, [](const MeshDraft& left, const MeshDraft& right) {
        return left.source == right.source && left.scaling == right.scaling &&
               left.pose.position == right.pose.position && left.pose.rotation == right.pose.rotation &&
               left.smooth_below == right.smooth_below && left.one_sided == right.one_sided;
    });
}

bool same_shapes(const std::vector<PlacedShape>& a, const std::vector<PlacedShape>& b) {
    if (a.size() != b.size()) {
        return false;
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
        const bool same_place =
            a[i].pose.position == b[i].pose.position && a[i].pose.rotation == b[i].pose.rotation;
        if (!same_place || !same_shape(a[i].shape, b[i].shape)) {
            return false;
        }
    }
    return true;
}

}  // namespace tactus
