#include "sensing/discovery/mesh_field.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/mesh/closed_mesh.hpp"
#include "core/tree/closest_point_on_triangle.hpp"
#include "core/tree/triangle_tree.hpp"

namespace tactus {

namespace {

struct Closest {
    Vec3 point{0.0};
    Vec3 face_normal{0.0};  // of the triangle it lies in, as its corners run; not unit
};

Closest closest_on(const TriangleTree& tree, const Vec3& point) {
    const NearestTriangle nearest = tree.nearest(point, std::numeric_limits<float>::max());
    Closest closest;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t lane = 0; lane < lane_count; ++lane) {
        const TriangleCorners corners = tree.corners(nearest.pack * lane_count + lane);
        const Vec3 on = closest_point_on_triangle(point, corners.a, corners.b, corners.c).point;
        const Vec3 way = point - on;
        const double squared = glm::dot(way, way);
        if (squared < least) {
            least = squared;
            closest = {on, glm::cross(corners.b - corners.a, corners.c - corners.a)};
        }
    }
    return closest;
}

// Six times the volume that the triangles enclose: negative where they run clockwise seen from outside.
double signed_volume(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (const auto& [i, j, k] : mesh.triangles) {
        sum += glm::dot(mesh.vertices[i], glm::cross(mesh.vertices[j], mesh.vertices[k]));
    }
    return sum;
}

// Where a point is so near the surface that the way to it is no direction any more, the face's normal is.
constexpr double no_way = 1e-7;  // (unit: meters)

class FieldRow {
public:
    FieldRow(const TriangleTree& tree, bool closed, double outward, double cell)
        : tree_(tree), closed_(closed), outward_(outward), cell_(cell) {}

    // Along a row of cells: where the surface is farther than the next cell, that one is on the same side.
    FieldPlane at(const Vec3& center) {
        const Closest closest = closest_on(tree_, center);
        Vec3 way = center - closest.point;
        const double distance = glm::length(way);
        if (!(last_ > 1.001 * cell_)) {
            WorkBudget work(std::numeric_limits<std::int64_t>::max());
            inside_ = closed_ && tree_.winding(center, work).inside();
        }
        last_ = distance;
        way = distance > no_way ? (inside_ ? -1.0 : 1.0) / distance * way
                                : outward_ * unit(closest.face_normal);
        return {static_cast<float>(way.x), static_cast<float>(way.y), static_cast<float>(way.z),
                static_cast<float>(glm::dot(way, closest.point))};
    }

private:
    static Vec3 unit(const Vec3& v) {
        const double length = glm::length(v);
        return length > 0.0 ? v / length : Vec3(0.0, 1.0, 0.0);
    }

    const TriangleTree& tree_;
    bool closed_;
    double outward_;  // 1: faces run counter-clockwise seen from outside, -1: clockwise
    double cell_;
    double last_ = 0.0;  // distance of the cell before from the surface
    bool inside_ = false;
};

}  // namespace

MeshField MeshField::build(const TriangleMesh& mesh, double cell, double margin, const ParallelRunner& run) {
    MeshField field;
    const CornerExtent extent = corner_extent(mesh, run);
    const TriangleTree tree = TriangleTree::build(mesh, run);
    field.cell_ = cell;
    field.low_ = extent.low - Vec3(margin);
    for (int axis = 0; axis < 3; ++axis) {
        field.sizes_[axis] =
            static_cast<int>(std::ceil((extent.high - extent.low)[axis] / cell + 2.0 * margin / cell));
    }
    const auto [nx, ny, nz] = field.sizes_;
    field.planes_.resize(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) *
                         static_cast<std::size_t>(nz));
    const bool closed = is_closed(mesh);
    const double outward = signed_volume(mesh) < 0.0 ? -1.0 : 1.0;
    run(static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz), [&](std::size_t line) {
        FieldRow row(tree, closed, outward, cell);
        const double y =
            field.low_.y + (static_cast<double>(line % static_cast<std::size_t>(ny)) + 0.5) * cell;
        const double z =
            field.low_.z + (static_cast<double>(line / static_cast<std::size_t>(ny)) + 0.5) * cell;
        for (int i = 0; i < nx; ++i) {
            field.planes_[line * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i)] =
                row.at({field.low_.x + (i + 0.5) * cell, y, z});
        }
    });
    return field;
}

bool MeshField::covers(const Vec3& point) const {
    const Vec3 at = (point - low_) / cell_;
    return at.x >= 0.0 && at.y >= 0.0 && at.z >= 0.0 && at.x < sizes_[0] && at.y < sizes_[1] &&
           at.z < sizes_[2];
}

const FieldPlane& MeshField::plane_at(const Vec3& point) const {
    std::size_t index = 0;
    for (int axis = 2; axis >= 0; --axis) {
        const double at = std::clamp((point[axis] - low_[axis]) / cell_, 0.0, sizes_[axis] - 0.5);
        index = index * static_cast<std::size_t>(sizes_[axis]) + static_cast<std::size_t>(at);
    }
    return planes_[index];
}

double MeshField::distance(const Vec3& point) const {
    const FieldPlane& plane = plane_at(point);
    return plane.x * point.x + plane.y * point.y + plane.z * point.z - plane.c;
}

}  // namespace tactus
