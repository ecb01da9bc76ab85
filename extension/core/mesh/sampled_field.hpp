// Numbers on a grid: a voxel volume, as a scanner gives it, or distances from a surface.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "core/math/types.hpp"

namespace tactus {

// Samples at the corners of equal cells, the middle of them all at the origin.
struct SampledField {
    std::array<std::uint32_t, 3> size{};  // samples along x, y and z, each >= 2
    Vec3 spacing{1.0};                    // from one to the next (unit: meters), each > 0
    std::span<const float> values;        // x runs fastest, then y, then z
    double iso = 0.0;
    // The solid is where the field is above the iso-value, as densities are; else below, as signed distances.
    bool inside_above = false;
};

// Empty where the field has a surface; otherwise what is wrong and what to do about it.
std::string check_field(const SampledField& field);

}  // namespace tactus
