#include "physics/shape_conversion.hpp"
#include "physics/jolt.hpp"

#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/CapsuleShape.h>
#include <Jolt/Physics/Collision/Shape/ConvexHullShape.h>
#include <Jolt/Physics/Collision/Shape/CylinderShape.h>
#include <Jolt/Physics/Collision/Shape/HeightFieldShape.h>
#include <Jolt/Physics/Collision/Shape/MeshShape.h>
#include <Jolt/Physics/Collision/Shape/PlaneShape.h>
#include <Jolt/Physics/Collision/Shape/RotatedTranslatedShape.h>
#include <Jolt/Physics/Collision/Shape/ScaledShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/Collision/Shape/StaticCompoundShape.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/touch_shape.hpp"
#include "physics/jolt_units.hpp"

namespace tactus {

namespace {

// Lengths outside of this are a mistake in the scene, not a thing to be touched, and float would not hold
// them.
constexpr double smallest_length = 1e-5;  // (unit: meters)
constexpr double largest_length = 1e5;    // (unit: meters)

// Jolt keeps a convex shape as a smaller one with a skin, which makes contacts cheap and steady. The faces
// stay where they are; only edges are rounded, by this share of the smallest half extent.
constexpr double edge_rounding = 0.05;

// How far the plane's contacts reach to each side: beyond what any scene needs, within float.
constexpr double plane_half_extent = 1e4;  // (unit: meters)

// A hull whose volume fills less than this share of its bounding cube has no inside to push from.
constexpr double flat_hull = 1e-7;  // (dimensionless)

ShapeConversion failure(std::string error) {
    return {nullptr, std::move(error)};
}

ShapeConversion finished(const JPH::ShapeSettings& settings) {
    const JPH::ShapeSettings::ShapeResult result = settings.Create();
    if (result.HasError())
        return failure(result.GetError().c_str());
    return {result.Get(), {}};
}

bool is_length(double meters) {
    return meters >= smallest_length && meters <= largest_length;
}

bool is_point(const Vec3& p) {
    return std::abs(p.x) <= largest_length && std::abs(p.y) <= largest_length &&
           std::abs(p.z) <= largest_length;
}

std::string not_a_length(const char* what, double value) {
    return std::string(what) + " is " + std::to_string(value) + " m; make it between 0.00001 and 100000 m";
}

float rounding(double smallest_half_extent) {
    return units::length(edge_rounding * smallest_half_extent);
}

ShapeConversion of(const SphereShape& sphere, bool) {
    if (!is_length(sphere.radius))
        return failure(not_a_length("radius", sphere.radius));
    return finished(JPH::SphereShapeSettings(units::length(sphere.radius)));
}

ShapeConversion of(const BoxShape& box, bool) {
    const Vec3 h = box.half_extents;
    for (const double half : {h.x, h.y, h.z})
        if (!is_length(half))
            return failure(not_a_length("half extent", half));
    return finished(JPH::BoxShapeSettings(units::vector(h), rounding(std::min({h.x, h.y, h.z}))));
}

ShapeConversion of(const CapsuleShape& capsule, bool) {
    if (!is_length(capsule.radius))
        return failure(not_a_length("radius", capsule.radius));
    // A capsule without a middle is a sphere, and Jolt wants it so.
    if (capsule.half_segment >= 0.0 && capsule.half_segment < smallest_length)
        return finished(JPH::SphereShapeSettings(units::length(capsule.radius)));
    if (!is_length(capsule.half_segment))
        return failure(not_a_length("half the distance between the capsule's ends", capsule.half_segment));
    return finished(
        JPH::CapsuleShapeSettings(units::length(capsule.half_segment), units::length(capsule.radius)));
}

ShapeConversion of(const CylinderShape& cylinder, bool) {
    if (!is_length(cylinder.radius))
        return failure(not_a_length("radius", cylinder.radius));
    if (!is_length(cylinder.half_height))
        return failure(not_a_length("half height", cylinder.half_height));
    return finished(JPH::CylinderShapeSettings(units::length(cylinder.half_height),
                                               units::length(cylinder.radius),
                                               rounding(std::min(cylinder.radius, cylinder.half_height))));
}

ShapeConversion of(const PlaneShape& plane, bool may_turn_dynamic) {
    if (may_turn_dynamic)
        return failure("a plane has no end and cannot move; make the body static or use a box");
    if (!(std::abs(glm::length(plane.normal) - 1.0) < 1e-3) || !(std::abs(plane.offset) <= largest_length))
        return failure("the plane's normal is not of length 1 or its offset is not a length");
    const JPH::Plane surface(units::plain(glm::normalize(plane.normal)), units::length(-plane.offset));
    return finished(JPH::PlaneShapeSettings(surface, nullptr, units::length(plane_half_extent)));
}

std::string wrong_in_mesh(const TriangleMesh* mesh) {
    if (mesh == nullptr || mesh->vertices.empty())
        return "the mesh has no vertices; give the collision shape its points";
    for (std::size_t i = 0; i < mesh->vertices.size(); ++i)
        if (!is_point(mesh->vertices[i]))
            return "vertex " + std::to_string(i) + " is not a finite point; export the mesh again";
    return {};
}

ShapeConversion hull_of(const TriangleMesh* mesh) {
    if (std::string wrong = wrong_in_mesh(mesh); !wrong.empty())
        return failure(std::move(wrong));
    JPH::Array<JPH::Vec3> points;
    points.reserve(mesh->vertices.size());
    JPH::AABox bounds;
    for (const Vec3& vertex : mesh->vertices) {
        points.push_back(units::vector(vertex));
        bounds.Encapsulate(points.back());
    }
    const JPH::Vec3 extent = bounds.GetExtent();
    const double smallest = units::meters(extent.ReduceMin());
    const double largest = units::meters(extent.ReduceMax());
    if (largest > largest_length || smallest < smallest_length)
        return failure("the hull is flat or too small: its points span " + std::to_string(2.0 * smallest) +
                       " m at the narrowest; use a box, or give it thickness");

    JPH::ConvexHullShapeSettings settings(points, rounding(smallest));
    settings.mMaxErrorConvexRadius = rounding(smallest);
    settings.mHullTolerance = 1e-4f * extent.ReduceMax();
    ShapeConversion hull = finished(settings);
    if (hull.shape == nullptr)
        return failure("no convex hull can be made of its points (" + hull.error +
                       "); use a box or other points");
    const float edge = 2.0f * extent.ReduceMax();
    if (static_cast<double>(hull.shape->GetVolume()) < flat_hull * static_cast<double>(edge * edge * edge))
        return failure("the hull is flat; use a box, or give it thickness");
    return hull;
}

ShapeConversion of(const ConvexHullShape& hull, bool) {
    return hull_of(hull.hull.get());
}

ShapeConversion triangles_of(const std::vector<JPH::Float3>& points,
                             const JPH::IndexedTriangleList& triangles) {
    JPH::VertexList vertices;
    vertices.assign(points.data(), points.data() + points.size());
    JPH::MeshShapeSettings settings(std::move(vertices), triangles);
    settings.Sanitize();
    if (settings.mIndexedTriangles.empty())
        return failure("the mesh has no triangle with an area; check its scale and export it again");
    return finished(settings);
}

JPH::Float3 stored(const Vec3& p) {
    return {units::length(p.x), units::length(p.y), units::length(p.z)};
}

ShapeConversion of(const MeshShape& mesh, bool may_turn_dynamic) {
    if (may_turn_dynamic)
        return hull_of(mesh.mesh.get());
    if (std::string wrong = wrong_in_mesh(mesh.mesh.get()); !wrong.empty())
        return failure(std::move(wrong));
    std::vector<JPH::Float3> points;
    points.reserve(mesh.mesh->vertices.size());
    for (const Vec3& vertex : mesh.mesh->vertices)
        points.push_back(stored(vertex));
    JPH::IndexedTriangleList triangles;
    triangles.reserve(mesh.mesh->triangles.size());
    for (const auto& t : mesh.mesh->triangles) {
        for (const std::uint32_t corner : t)
            if (corner >= points.size())
                return failure("a triangle names vertex " + std::to_string(corner) + " of " +
                               std::to_string(points.size()) + "; export the mesh again");
        triangles.emplace_back(t[0], t[1], t[2], 0u);
    }
    return triangles_of(points, triangles);
}

// As it is touched.
ShapeConversion strip_as_mesh(const HeightFieldShape& field) {
    const TriangleMesh mesh = height_field_mesh(field);
    std::vector<JPH::Float3> points;
    points.reserve(mesh.vertices.size());
    for (const Vec3& vertex : mesh.vertices)
        points.push_back(stored(vertex));
    JPH::IndexedTriangleList triangles;
    triangles.reserve(mesh.triangles.size());
    for (const auto& t : mesh.triangles)
        triangles.emplace_back(t[0], t[1], t[2], 0u);
    return triangles_of(points, triangles);
}

ShapeConversion of(const HeightFieldShape& field, bool may_turn_dynamic) {
    if (may_turn_dynamic)
        return failure("a height field cannot move; make the body static or use a convex shape");
    const std::size_t samples = static_cast<std::size_t>(field.columns) * field.rows;
    if (field.columns < 2 || field.rows < 2 || field.heights == nullptr || field.heights->size() != samples)
        return failure("the height field needs at least 2 x 2 heights and exactly columns x rows of them");
    if (!is_length(std::abs(field.scale.x)) || !is_length(field.scale.z) || !is_length(field.scale.y))
        return failure("the height field's scale is not a length");
    for (std::size_t i = 0; i < samples; ++i)
        if (!is_hole((*field.heights)[i]) &&
            !(std::abs(field.scale.y * (*field.heights)[i]) <= largest_length))
            return failure("height " + std::to_string(i) + " is not a finite number");

    // Padding a long strip to a square would cost more than its triangles do.
    constexpr std::size_t max_padding = 4;
    constexpr std::uint32_t block = 2;
    const std::uint32_t longest = std::max(field.columns, field.rows);
    const std::uint32_t side = std::max(2 * block, (longest + block - 1) / block * block);
    if (static_cast<std::size_t>(side) * side > max_padding * samples && samples > 64)
        return strip_as_mesh(field);

    // Jolt cuts its cells along the other diagonal than Godot and touch do: of its mirror image it cuts the
    // same one.
    std::vector<float> padded(static_cast<std::size_t>(side) * side,
                              JPH::HeightFieldShapeConstants::cNoCollisionValue);
    static_assert(JPH::HeightFieldShapeConstants::cNoCollisionValue == hole_height);
    for (std::uint32_t row = 0; row < field.rows; ++row)
        std::copy_n(field.heights->data() + static_cast<std::size_t>(field.rows - 1 - row) * field.columns,
                    field.columns, padded.data() + static_cast<std::size_t>(row) * side);
    std::ranges::replace_if(padded, is_hole, hole_height);
    const Vec3 scale(std::abs(field.scale.x), field.scale.y, field.scale.z);
    const Vec3 corner{-0.5 * scale.x * (field.columns - 1), 0.0, -0.5 * scale.z * (field.rows - 1)};
    JPH::HeightFieldShapeSettings settings(padded.data(), units::vector(corner), units::vector(scale), side);
    settings.mBlockSize = block;
    settings.mBitsPerSample = 16;
    const ShapeConversion mirrored = finished(settings);
    if (mirrored.shape == nullptr)
        return mirrored;
    return finished(
        JPH::ScaledShapeSettings(mirrored.shape, JPH::Vec3(field.scale.x < 0.0 ? -1.0f : 1.0f, 1.0f, -1.0f)));
}

bool is_identity(const Pose& pose) {
    return pose.position == Vec3(0.0) && pose.rotation.x == 0.0 && pose.rotation.y == 0.0 &&
           pose.rotation.z == 0.0;
}

std::string in_compound(std::size_t index, const Shape& shape, const std::string& error) {
    return "shape " + std::to_string(index + 1) + " (" + name(shape) + "): " + error;
}

}  // namespace

const char* name(const Shape& shape) {
    constexpr const char* names[] = {"sphere", "box",  "capsule", "cylinder",
                                     "plane",  "hull", "mesh",    "height field"};
    return names[shape.index()];
}

ShapeConversion convert(const Shape& shape, bool may_turn_dynamic) {
    return std::visit([may_turn_dynamic](const auto& any) { return of(any, may_turn_dynamic); }, shape);
}

ShapeConversion convert(const std::vector<PlacedShape>& shapes, bool may_turn_dynamic) {
    JPH::StaticCompoundShapeSettings compound;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const auto& [shape, pose] = shapes[i];
        const double turn = glm::length(pose.rotation);
        if (!is_point(pose.position) || !(std::abs(turn - 1.0) < 1e-3))
            return failure(in_compound(i, shape, "its place in the body is not a finite, unscaled pose"));
        ShapeConversion converted = convert(shape, may_turn_dynamic);
        if (converted.shape == nullptr)
            return failure(in_compound(i, shape, converted.error));
        if (shapes.size() > 1) {
            compound.AddShape(units::vector(pose.position), units::rotation(pose.rotation), converted.shape);
            continue;
        }
        if (is_identity(pose))
            return converted;
        return finished(JPH::RotatedTranslatedShapeSettings(units::vector(pose.position),
                                                            units::rotation(pose.rotation), converted.shape));
    }
    return finished(compound);
}

}  // namespace tactus
