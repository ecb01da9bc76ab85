// How far any point is from a mesh, and which way off: closest points on a grid, looked up in one load.
//
// Each cell keeps the tangent plane n . p = c of the distance function at its own centre: the plane through
// the closest point of the mesh, across the way from it. For a point in the cell, n . p - c is its signed
// distance (negative inside) up to the square of half a cell over that distance, or over the surface's radius
// of curvature where that is larger; on flat faces it is exact.
#pragma once

#include <string>
#include <vector>

#include "core/math/pose.hpp"
#include "core/mesh/triangle_mesh.hpp"
#include "core/tree/parallel.hpp"

namespace tactus {

struct FieldPlane {
    float x, y, z;  // n, unit, out of the mesh
    float c;        // (unit: meters)
};

class MeshField {
public:
    // The mesh is sound (see check_mesh). `margin` around it is covered as well.
    static MeshField build(const TriangleMesh& mesh, double cell, double margin,
                           const ParallelRunner& run = run_serially);

    // As vector kernels need it: cell (i, j, k) has its planes at (k * sizes[1] + j) * sizes[0] + i.
    const FieldPlane* planes() const { return planes_.data(); }
    const int* sizes() const { return sizes_; }
    Vec3 low() const { return low_; }  // corner of the first cell (unit: meters)
    double cell() const { return cell_; }

    bool covers(const Vec3& point) const;
    // The plane of the cell that holds the point, or of the nearest one.
    const FieldPlane& plane_at(const Vec3& point) const;
    double distance(const Vec3& point) const;

private:
    std::vector<FieldPlane> planes_;
    int sizes_[3] = {0, 0, 0};
    Vec3 low_{0.0};
    double cell_ = 0.0;
};

}  // namespace tactus
