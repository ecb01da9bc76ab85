// From the shapes of core/geometry to Jolt's, in Jolt's units.
//
//   sphere, box, capsule, cylinder   the same, their edges rounded a little (see shape_conversion.cpp)
//   plane                            Jolt's plane; still bodies only
//   convex hull                      at most 256 corners, the outermost
//   mesh                             still and kinematic bodies: its triangles; dynamic ones: its convex hull
//   height field                     Jolt's, padded to a square with holes; a long strip as a mesh; still
//   bodies only
#pragma once

#include <string>

#include "core/geometry/shape.hpp"
#include "physics/body_description.hpp"
#include "physics/jolt.hpp"

#include <Jolt/Physics/Collision/Shape/Shape.h>

namespace tactus {

struct ShapeConversion {
    JPH::RefConst<JPH::Shape> shape;  // null: see error
    std::string error;                // what is wrong and what to do, without the shape's name
};

// What `may_turn_dynamic` asks for: a body that is only still or kinematic now keeps triangles, one that may
// become dynamic gets hulls.
ShapeConversion convert(const Shape& shape, bool may_turn_dynamic);

// One shape for the whole body, in the body's frame. `shapes` is not empty.
ShapeConversion convert(const std::vector<PlacedShape>& shapes, bool may_turn_dynamic);

const char* name(const Shape& shape);

}  // namespace tactus
