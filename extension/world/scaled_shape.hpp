// A shape as its body's frame scales it. Touch and physics know no scale: it goes into the shape's own
// measures where they can take it.
#pragma once

#include <string>
#include <vector>

#include "world/body_form.hpp"

namespace tactus {

struct ShapeReading {
    std::vector<PlacedShape> shapes;  // this or the next has one entry, or both none on an error
    std::vector<MeshDraft> meshes;
    std::string error;  // what is wrong and what to do
};

// `scaling`: what scales, mirrors and shears, as seen from `pose`, the shape's place in its body.
ShapeReading scaled_shape(const Shape& shape, const Mat3& scaling, const Pose& pose);

// The hull of these points.
ShapeReading scaled_hull(std::vector<Vec3> points, const Mat3& scaling, const Pose& pose);

}  // namespace tactus
