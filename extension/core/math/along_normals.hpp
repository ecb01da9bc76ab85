// What pushes along normals moves a thing by: each of them takes what those before it have left.
#pragma once

#include <array>
#include <cstddef>
#include <glm/geometric.hpp>

#include "core/math/types.hpp"

namespace tactus {

class AlongNormals {
public:
    // One that the others span already is left out.
    void add(Vec3 normal) {
        for (std::size_t i = 0; i < count_; ++i) {
            normal -= glm::dot(normal, axes_[i]) * axes_[i];
        }
        if (const double length = glm::length(normal); count_ < axes_.size() && length > 1e-6) {
            axes_[count_++] = normal / length;
        }
    }

    Vec3 part_of(const Vec3& way) const {
        Vec3 part(0.0);
        for (std::size_t i = 0; i < count_; ++i) {
            part += glm::dot(way, axes_[i]) * axes_[i];
        }
        return part;
    }

private:
    std::array<Vec3, 3> axes_;  // orthogonal, of length 1
    std::size_t count_ = 0;
};

}  // namespace tactus
