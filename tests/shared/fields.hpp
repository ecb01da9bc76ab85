// Fields of samples that tests and benches share.
#pragma once

#include <vector>

#include "core/mesh/sampled_field.hpp"

namespace tactus::shared {

// A field with its values.
struct OwnField {
    SampledField field;
    std::vector<float> values;

    SampledField get() const {
        SampledField all = field;
        all.values = values;
        return all;
    }
};

// Samples of a function of the place, from the lowest corner of the grid on.
template <class Function>
OwnField sampled(const std::array<std::uint32_t, 3>& size, const Vec3& spacing, Function&& of) {
    OwnField made;
    made.field.size = size;
    made.field.spacing = spacing;
    const Vec3 middle = 0.5 * (Vec3(size[0], size[1], size[2]) - 1.0);
    made.values.reserve(std::size_t{size[0]} * size[1] * size[2]);
    for (std::uint32_t z = 0; z < size[2]; ++z) {
        for (std::uint32_t y = 0; y < size[1]; ++y) {
            for (std::uint32_t x = 0; x < size[0]; ++x) {
                made.values.push_back(static_cast<float>(of(spacing * (Vec3(x, y, z) - middle))));
            }
        }
    }
    return made;
}

}  // namespace tactus::shared
