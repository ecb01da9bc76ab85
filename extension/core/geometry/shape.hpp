// What a body is made of: the description that touch (core/haptics) and rigid-body physics (physics/) are
// both built from. Every shape is given in its own frame, centred and aligned like Godot's shapes (long axis
// along y); a PlacedShape puts it into the frame of its body.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include "core/math/pose.hpp"
#include "core/mesh/triangle_mesh.hpp"

namespace tactus {

struct SphereShape {
    double radius = 0.5;  // (unit: meters), > 0
};

struct BoxShape {
    Vec3 half_extents{0.5};  // (unit: meters), each > 0
};

struct CapsuleShape {
    double radius = 0.5;        // (unit: meters), > 0
    double half_segment = 0.5;  // half the distance between the two end spheres' centres (unit: meters), >= 0
};

struct CylinderShape {
    double radius = 0.5;       // (unit: meters), > 0
    double half_height = 1.0;  // (unit: meters), > 0
};

// The half-space below the plane is solid: normal . x <= offset.
struct PlaneShape {
    Vec3 normal{0.0, 1.0, 0.0};  // unit length
    double offset = 0.0;         // (unit: meters)
};

struct ConvexHullShape {
    std::shared_ptr<const TriangleMesh> hull;  // closed surface of the hull
};

// What a mesh says of its triangles besides where they are; by triangle, empty where it says nothing.
struct SurfaceMap {
    using Corners = std::array<std::array<float, 2>, 3>;  // on images, in repetitions

    std::vector<std::uint8_t> surface;  // the one of the mesh that it belongs to
    std::vector<Corners> uv;
};

// Any triangles: closed or open, touched from both sides, or, where they are closed, from outside only.
struct MeshShape {
    std::shared_ptr<const TriangleMesh> mesh;
    // Force shading: facets that meet at less than this give the force one smoothly turning direction (unit:
    // radians, 0 to pi); 0: the force is that of the facets.
    double smooth_below = 0.0;
    bool one_sided = false;
    std::shared_ptr<const SurfaceMap> surfaces = nullptr;  // null: it says nothing
};

// Heights over a grid in x-z, centred on the origin, z-major: heights[row * columns + column].
struct HeightFieldShape {
    std::uint32_t columns = 0;  // samples along x, >= 2
    std::uint32_t rows = 0;     // samples along z, >= 2
    // Spacing in x (negative: mirrored) and z (unit: meters), factor on the heights in y.
    Vec3 scale{1.0};
    // hole_height: there is none here, and no triangle that has it for a corner.
    std::shared_ptr<const std::vector<float>> heights;
};

inline constexpr float hole_height = std::numeric_limits<float>::max();
// Of heights as others write them: holes are NaN or infinite, or the largest number there is.
inline bool is_hole(float height) {
    return !(std::abs(height) < hole_height);
}

using Shape = std::variant<SphereShape, BoxShape, CapsuleShape, CylinderShape, PlaneShape, ConvexHullShape,
                           MeshShape, HeightFieldShape>;

struct PlacedShape {
    Shape shape;
    Pose pose;  // of the shape in the body's frame
};

}  // namespace tactus
