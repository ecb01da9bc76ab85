// One polygon as triangles, by cutting off ears (Meisters 1975; O'Rourke, Computational Geometry in C, 1.4).
#pragma once

#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"

namespace tactus {

// Adds the triangles of a polygon with these corners, given in order, wound as it is. It may be concave, have
// corners on a straight line or twice, and be not quite flat: it is cut as it looks along its mean normal. Of
// one that crosses itself, some triangles that cover it. False where that would take more than `work`
// comparisons of corners, which it counts down: nothing is added.
bool add_polygon(std::span<const Vec3> vertices, std::span<const std::uint32_t> corners, std::int64_t& work,
                 std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace tactus
