// A triangle mesh as plain data, in the frame of the body that carries it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math/types.hpp"

namespace tactus {

struct TriangleMesh {
    std::vector<Vec3> vertices;  // (unit: meters)
    std::vector<std::array<std::uint32_t, 3>>
        triangles;  // indices into vertices, counter-clockwise from outside
};

}  // namespace tactus
