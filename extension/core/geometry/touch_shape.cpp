#include "core/geometry/touch_shape.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/mesh/closed_mesh.hpp"
#include "core/mesh/mesh_check.hpp"
#include "core/tree/triangle_tree.hpp"

namespace tactus {

namespace {

bool is_length(double value) {
    return value > 0.0 && value <= 1e9;
}

// An empty text, or why the shape cannot be touched.
// Whether three corners of any cell are there: those of a triangle.
bool has_ground(const HeightFieldShape& f) {
    const auto is_there = [&f](std::size_t vertex) { return !is_hole((*f.heights)[vertex]); };
    for (std::size_t corner = 0; corner + f.columns + 1 < f.heights->size(); ++corner) {
        const bool is_cell = (corner + 1) % f.columns != 0;
        if (is_cell && is_there(corner + 1) && is_there(corner + f.columns) &&
            (is_there(corner) || is_there(corner + f.columns + 1))) {
            return true;
        }
    }
    return false;
}

struct Check {
    std::string operator()(const SphereShape& s) const {
        return is_length(s.radius) ? "" : "the sphere's radius is not a positive length: set it above 0 m";
    }
    std::string operator()(const BoxShape& b) const {
        const Vec3& h = b.half_extents;
        return is_length(h.x) && is_length(h.y) && is_length(h.z)
                   ? ""
                   : "a side of the box is not a positive length: set all three above 0 m";
    }
    std::string operator()(const CapsuleShape& c) const {
        return is_length(c.radius) && c.half_segment >= 0.0 && c.half_segment <= 1e9
                   ? ""
                   : "the capsule's radius or height is not a positive length: set both above 0 m";
    }
    std::string operator()(const CylinderShape& c) const {
        return is_length(c.radius) && is_length(c.half_height)
                   ? ""
                   : "the cylinder's radius or height is not a positive length: set both above 0 m";
    }
    std::string operator()(const PlaneShape& p) const {
        return std::abs(glm::length(p.normal) - 1.0) < 1e-6 && std::abs(p.offset) <= 1e9
                   ? ""
                   : "the plane's normal has no direction: give it a length of 1";
    }
    std::string operator()(const ConvexHullShape& h) const {
        return h.hull ? check_mesh(*h.hull) : "the convex hull has no points: give it at least four";
    }
    std::string operator()(const MeshShape& m) const {
        if (!(m.smooth_below >= 0.0 && m.smooth_below <= 3.1416)) {
            return "the angle below which facets are smoothed is not between 0 and 180 degrees: set it so";
        }
        std::string error = m.mesh ? check_mesh(*m.mesh) : "the shape has no mesh: assign one";
        if (error.empty() && m.surfaces && !fits(*m.surfaces, *m.mesh)) {
            error =
                "the mesh's surfaces or texture coordinates are not as many as its triangles, or no "
                "numbers: make them anew";
        }
        if (error.empty() && m.one_sided && !is_closed(*m.mesh)) {
            error =
                "the mesh is to be touched from outside only, but it has no inside: close its holes and "
                "turn all its triangles alike, or let it be touched from both sides";
        }
        return error;
    }
    std::string operator()(const HeightFieldShape& f) const {
        const bool sized = f.columns >= 2 && f.rows >= 2 && f.heights &&
                           f.heights->size() == std::size_t{f.columns} * f.rows;
        if (!sized) {
            return "the height field needs at least 2 x 2 samples and as many heights as samples: set its "
                   "size and data";
        }
        if (f.heights->size() > 0x1000'0000u) {
            return "the height field has more than 268,435,456 samples: split it into several bodies";
        }
        if (!is_length(std::abs(f.scale.x)) || !is_length(f.scale.z) || !std::isfinite(f.scale.y)) {
            return "the height field's spacing is not a length: set its scale above 0 m";
        }
        const bool sound = std::ranges::all_of(*f.heights, [&](float h) {
            return is_hole(h) || std::abs(f.scale.y * static_cast<double>(h)) <= 1e9;
        });
        if (!sound) {
            return "a height of the height field is beyond 1e9 m: repair its data";
        }
        return !has_ground(f) ? "the height field is nothing but holes: give it heights that are numbers"
                              : "";
    }
};

TouchPart with_tree(const Pose& pose, const TriangleMesh& mesh, const ParallelRunner& run) {
    auto tree = std::make_shared<TriangleTree>(TriangleTree::build(mesh, run));
    const Vec3 center = tree->center();
    const double radius = tree->radius();
    return {pose,           std::shared_ptr<const TriangleTree>(std::move(tree)), center, radius, nullptr,
            is_closed(mesh)};
}

struct Compile {
    const Pose& pose;
    const ParallelRunner& run;

    TouchPart operator()(const ConvexHullShape& h) const { return with_tree(pose, *h.hull, run); }
    TouchPart operator()(const MeshShape& m) const {
        TouchPart part = with_tree(pose, *m.mesh, run);
        part.one_sided = m.one_sided && part.closed;
        part.surfaces = m.surfaces;
        if (m.smooth_below > 0.0) {
            part.smooth_normals =
                std::make_shared<const std::vector<CornerNormals>>(smooth_normals(*m.mesh, m.smooth_below));
        }
        return part;
    }
    TouchPart operator()(const HeightFieldShape& f) const {
        return with_tree(pose, height_field_mesh(f), run);
    }
    template <class ClosedForm>
    TouchPart operator()(const ClosedForm& shape) const {
        const Solid solid = shape;
        return {pose, solid, Vec3(0.0), bounding_radius(solid), nullptr};
    }
};

bool is_sound(const Pose& pose) {
    const Vec3& p = pose.position;
    return std::abs(p.x) <= 1e9 && std::abs(p.y) <= 1e9 && std::abs(p.z) <= 1e9 &&
           std::abs(glm::length(pose.rotation) - 1.0) < 1e-3;
}

}  // namespace

bool fits(const SurfaceMap& map, const TriangleMesh& mesh) {
    const auto is_sound = [](const SurfaceMap::Corners& corners) {
        return std::ranges::all_of(
            corners, [](const auto& at) { return std::abs(at[0]) <= 1e6f && std::abs(at[1]) <= 1e6f; });
    };
    return (map.surface.empty() || map.surface.size() == mesh.triangles.size()) &&
           (map.uv.empty() || map.uv.size() == mesh.triangles.size()) &&
           std::ranges::all_of(map.uv, is_sound);
}

bool is_deformation(const TouchShape& from, const TouchShape& to) {
    return std::ranges::equal(from.parts, to.parts, [](const TouchPart& p, const TouchPart& q) {
        return p.tree() && q.tree() && q.tree()->is_refit_of(*p.tree()) &&
               p.pose.position == q.pose.position && p.pose.rotation == q.pose.rotation;
    });
}

std::shared_ptr<const TouchShape> narrowed(const TouchShape& shape, double radius, const ParallelRunner& run,
                                           const StillWanted& is_wanted) {
    auto result = std::make_shared<TouchShape>(shape);
    bool is_narrower = false;
    for (TouchPart& part : result->parts) {
        if (part.tree()) {
            part.touchable = touchable_triangles(*part.tree(), touchable_share * radius, run, is_wanted);
            is_narrower = is_narrower || part.touchable != nullptr;
        }
    }
    return is_narrower ? result : nullptr;
}

TriangleMesh height_field_mesh(const HeightFieldShape& field) {
    TriangleMesh mesh;
    mesh.vertices.reserve(std::size_t{field.columns} * field.rows);
    const double half_width = 0.5 * (field.columns - 1);
    const double half_depth = 0.5 * (field.rows - 1);
    const auto is_missing = [&](std::uint32_t vertex) { return is_hole((*field.heights)[vertex]); };
    double height = 0.0;  // of a hole: the last one that there was, which no triangle has
    for (std::uint32_t z = 0; z < field.rows; ++z) {
        for (std::uint32_t x = 0; x < field.columns; ++x) {
            const std::uint32_t vertex = z * field.columns + x;
            height = is_missing(vertex) ? height : static_cast<double>((*field.heights)[vertex]);
            mesh.vertices.push_back(field.scale * Vec3(x - half_width, height, z - half_depth));
        }
    }
    mesh.triangles.reserve(2 * std::size_t{field.columns - 1} * (field.rows - 1));
    const bool mirrored = field.scale.x < 0.0;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (is_missing(a) || is_missing(b) || is_missing(c)) {
            return;
        }
        mesh.triangles.push_back(mirrored ? std::array{a, c, b} : std::array{a, b, c});
    };
    for (std::uint32_t z = 0; z + 1 < field.rows; ++z) {
        for (std::uint32_t x = 0; x + 1 < field.columns; ++x) {
            const std::uint32_t corner = z * field.columns + x;
            add(corner, corner + field.columns, corner + 1);
            add(corner + 1, corner + field.columns, corner + field.columns + 1);
        }
    }
    return mesh;
}

TouchShapeResult make_touch_shape(std::span<const PlacedShape> shapes, const ParallelRunner& run) {
    if (shapes.empty()) {
        return {nullptr, "the body has no shape: add a CollisionShape3D with a shape below it"};
    }
    auto result = std::make_shared<TouchShape>();
    for (const PlacedShape& placed : shapes) {
        std::string error = std::visit(Check{}, placed.shape);
        if (error.empty() && !is_sound(placed.pose)) {
            error =
                "the shape's place in its body is not a finite position with a pure rotation: reset its "
                "transform";
        }
        if (!error.empty()) {
            return {nullptr, std::move(error)};
        }
        TouchPart part = std::visit(Compile{placed.pose, run}, placed.shape);
        result->reach = std::max(result->reach, glm::length(to_parent(part.pose, part.center)) + part.radius);
        result->parts.push_back(std::move(part));
    }
    return {std::move(result), {}};
}

}  // namespace tactus
