// Whether two forms of a body are the same surfaces at the same places.
#pragma once

#include <vector>

#include "core/geometry/shape.hpp"

namespace tactus {

bool same_pose(const Pose& a, const Pose& b);
bool same_shapes(const std::vector<PlacedShape>& a, const std::vector<PlacedShape>& b);

}  // namespace tactus
