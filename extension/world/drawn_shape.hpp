// Triangles for the eye: what is shown of shapes that have none, and of paths.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "core/geometry/shape.hpp"
#include "devices/hand_path.hpp"

namespace tactus {

// Counter-clockwise seen from outside.
struct Drawing {
    TriangleMesh mesh;
    double crease = 0.0;  // facets that meet at less than this are one round surface (unit: radians)
};

// Of what bends from facet to facet and is meant to look round (unit: radians).
constexpr double round_crease = 0.7;

// As graphics cards take them: three corners a triangle, clockwise seen from outside, each with its normal.
struct DrawnCorners {
    std::vector<glm::vec3> places, normals;
};
DrawnCorners corners_of(const Drawing& drawing);

// A plane is drawn as a square about its nearest point to the origin.
Drawing drawn_shape(const Shape& shape);

// A tube along the points, for lines that stay visible from anywhere (unit of thickness: meters). Less than
// two points are no line.
Drawing tube(const std::vector<Vec3>& points, double thickness, bool closed);

// The edges of a cube about the origin, as tubes.
Drawing drawn_cube_edges(double half_side, double thickness);

// The same along a hand's path; nothing of one that cannot be followed.
Drawing drawn_path(const HandPath& path, double thickness);

}  // namespace tactus
