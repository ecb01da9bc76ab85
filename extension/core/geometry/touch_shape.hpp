// What the proxy touches: the shapes of one body, made ready for distance and sweep queries. Immutable,
// shared by every body of the same form. Made off the haptic thread; queries allocate nothing.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/geometry/local_compliance.hpp"
#include "core/geometry/shape.hpp"
#include "core/geometry/solid.hpp"
#include "core/geometry/touchable.hpp"
#include "core/mesh/smooth_normals.hpp"
#include "core/tree/parallel.hpp"

namespace tactus {

class TriangleTree;

struct TouchPart {
    Pose pose;  // of the part in the body's frame
    std::variant<Solid, std::shared_ptr<const TriangleTree>> surface;
    Vec3 center{0.0};     // of a ball that holds the part, in the part's frame (unit: meters)
    double radius = 0.0;  // of that ball; infinite for a half-space (unit: meters)
    std::shared_ptr<const std::vector<CornerNormals>>
        smooth_normals;      // by triangle of the mesh; null: facets
    bool closed = false;     // a mesh that bounds a solid (see is_closed)
    bool one_sided = false;  // of closed meshes: touched from outside only; what is inside is let out
    std::shared_ptr<const SurfaceMap> surfaces =
        nullptr;  // null: the body's material is that of every triangle
    // Of just this tree; of another one, as after a deformation, it says nothing. Null: all may be touched.
    std::shared_ptr<const TouchableTriangles> touchable = nullptr;

    const TriangleTree* tree() const {
        const auto* shared = std::get_if<std::shared_ptr<const TriangleTree>>(&surface);
        return shared ? shared->get() : nullptr;
    }
    // What such a sphere has to be kept clear of, wherever it fits (see touchable.hpp).
    const TriangleTree* tree_for(double sphere_radius) const {
        const bool holds = touchable && touchable->whole == tree() && sphere_radius >= touchable->radius;
        return holds ? touchable->tree.get() : tree();
    }
    const Solid& solid() const { return *std::get_if<Solid>(&surface); }
};

struct TouchShape {
    std::vector<TouchPart> parts;
    // Largest distance of any point of the body from its origin: how far a turn of one radian moves it at
    // most (unit: meters). Infinite with a half-space.
    double reach = 0.0;
    LocalCompliance give;  // of a soft body: what its surface does not show of a press
};

// Whether what it says is of this mesh's triangles, and of numbers.
bool fits(const SurfaceMap& map, const TriangleMesh& mesh);

// True where both are made of the same meshes at the same places and only corners have moved: what touches
// the one can be swept against the way to the other (see DeformSweep).
bool is_deformation(const TouchShape& from, const TouchShape& to);

struct TouchShapeResult {
    std::shared_ptr<const TouchShape> shape;  // null where there is an error
    std::string error;                        // what is wrong and what to do
};

// Refuses an empty list, sizes that are not positive finite numbers and meshes that check_mesh refuses.
TouchShapeResult make_touch_shape(std::span<const PlacedShape> shapes,
                                  const ParallelRunner& run = run_serially);

// The same for spheres of that radius (unit: meters), and larger ones: what they can touch of each mesh
// stands in a tree of its own. To touch it is the same, sooner. Null where that is of no use, or not wanted
// any more.
std::shared_ptr<const TouchShape> narrowed(const TouchShape& shape, double radius,
                                           const ParallelRunner& run = run_serially,
                                           const StillWanted& is_wanted = is_always_wanted);

// The surface of a height field as triangles, counter-clockwise from above; each cell is cut from its corner
// (column + 1, row) to (column, row + 1), as Godot's is.
TriangleMesh height_field_mesh(const HeightFieldShape& field);

}  // namespace tactus
