// What common materials feel like, and how choosing one loses nothing of what was there before.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>

#include "core/haptics/touch_material.hpp"

namespace tactus {

enum class MaterialPreset : std::uint8_t {
    custom,
    rubber,
    ice,
    sandpaper,
    steel,
    sponge,
    wood,
    glass,
    skin,
    foam
};

struct MaterialValues {
    TouchMaterial touch{.static_friction = 0.4, .dynamic_friction = 0.3};  // as most dry surfaces, not as ice
    double friction = 1.0;  // between bodies, as Godot's PhysicsMaterial has it
    double bounce = 0.0;
};

// Those of custom are a new material's.
MaterialValues values_of(MaterialPreset preset);

// Grains of random height, the same everywhere: for roughness without an image.
std::shared_ptr<const TouchImage> grain();

// Of floats, row by row, as an engine's image packs them. What is no height from 0 to 1 becomes the nearest
// one, what is no number 0. Null where there are more or fewer.
std::shared_ptr<const TouchImage> touch_image(std::uint32_t columns, std::uint32_t rows,
                                              std::span<const std::uint8_t> bytes);

// Nothing is forgotten: what the material had before comes back with the preset that it had before.
class PresetChoice {
public:
    // The one that was chosen; where none was, the one whose values these are.
    MaterialPreset preset(const MaterialValues& now) const;
    // What the values are to become; none: they stay.
    std::optional<MaterialValues> choose(MaterialPreset preset, const MaterialValues& now);

private:
    MaterialPreset chosen_ = MaterialPreset::custom;
    std::map<MaterialPreset, MaterialValues> left_;  // as they were when another preset was chosen
};

}  // namespace tactus
