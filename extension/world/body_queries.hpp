// What of many bodies is near a point, or on a way: asked by scripts, beside the loop.
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/surface_query.hpp"
#include "core/tree/tree_boxes.hpp"

namespace tactus {

struct QueriedBody {
    const TouchShape* touch = nullptr;
    Pose pose;
    std::size_t index = 0;  // the asker's
};

struct BodyPoint {
    std::size_t index = 0;
    SurfaceHit at;  // at.hit: whether anything is met
};

// Nearest of all surfaces to a point of the world, where one is nearer than `max_distance` (unit: meters).
BodyPoint nearest_of(const std::vector<QueriedBody>& bodies, const Vec3& point, double max_distance);

// The first surface from one point to another; `at.distance` is that from the first.
BodyPoint first_on_way(const std::vector<QueriedBody>& bodies, const Vec3& from, const Vec3& to);

// Indices of those that a ball meets.
std::vector<std::size_t> within(const std::vector<QueriedBody>& bodies, const Vec3& center, double radius);

// Boxes of the trees of those that have some, see TreeBoxes::around; each with the place of its mesh in the
// world. `most` of all together.
struct PlacedTreeBox {
    TreeBox box;
    Pose pose;
};
std::vector<PlacedTreeBox> tree_boxes(const std::vector<QueriedBody>& bodies, const Vec3& point,
                                      double radius, std::size_t most);

}  // namespace tactus
