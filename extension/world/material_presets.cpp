#include "world/material_presets.hpp"

#include <algorithm>
#include <cstring>

#include "core/haptics/touch_values.hpp"

namespace tactus {

namespace {

constexpr std::uint32_t grain_side = 64;  // grains along a side of the texture

constexpr MaterialPreset presets[] = {
    MaterialPreset::rubber, MaterialPreset::ice,    MaterialPreset::sandpaper,
    MaterialPreset::steel,  MaterialPreset::sponge, MaterialPreset::wood,
    MaterialPreset::glass,  MaterialPreset::skin,   MaterialPreset::foam};

// Godot keeps friction and bounce in single precision.
bool same_values(const MaterialValues& a, const MaterialValues& b) {
    return same_values(a.touch, b.touch) &&
           static_cast<float>(a.friction) == static_cast<float>(b.friction) &&
           static_cast<float>(a.bounce) == static_cast<float>(b.bounce);
}

}  // namespace

// Chosen by what a device of 3000 N/m and a hand can render at 1 kHz; none is a measured sample of its name.
MaterialValues values_of(MaterialPreset preset) {
    MaterialValues values;
    TouchMaterial& touch = values.touch;
    switch (preset) {
        case MaterialPreset::rubber:
            touch = {.stiffness = 800.0, .damping = 1.5, .static_friction = 1.1, .dynamic_friction = 0.8};
            touch.stick_slip_stiffness = 300.0;
            touch.stick_slip_force = 0.6;
            values.friction = 0.9;
            values.bounce = 0.5;
            break;
        case MaterialPreset::ice:
            touch = {.stiffness = 2000.0, .damping = 1.0, .static_friction = 0.05, .dynamic_friction = 0.02};
            touch.stribeck_speed = 0.03;
            values.friction = 0.03;
            values.bounce = 0.1;
            break;
        case MaterialPreset::sandpaper:
            touch = {.stiffness = 1500.0, .damping = 1.0, .static_friction = 0.9, .dynamic_friction = 0.7};
            touch.texture_size = 0.05;
            touch.texture_depth = 0.0002;
            values.friction = 0.9;
            break;
        case MaterialPreset::steel:
            touch = {.stiffness = 3000.0, .damping = 1.5, .static_friction = 0.25, .dynamic_friction = 0.2};
            touch.impact_strength = 8.0;
            touch.impact_frequency = 300.0;
            touch.impact_decay = 0.012;
            values.friction = 0.3;
            values.bounce = 0.3;
            break;
        case MaterialPreset::sponge:
            touch = {.stiffness = 150.0, .damping = 2.0, .static_friction = 0.7, .dynamic_friction = 0.5};
            touch.stiffening = 5.0;
            touch.stiffening_depth = 0.03;
            touch.viscosity = 1.0;
            values.friction = 0.7;
            break;
        case MaterialPreset::wood:
            touch = {.stiffness = 2200.0, .damping = 1.2, .static_friction = 0.5, .dynamic_friction = 0.35};
            touch.texture_size = 0.04;
            touch.texture_depth = 0.00004;
            touch.impact_strength = 5.0;
            touch.impact_frequency = 100.0;
            touch.impact_decay = 0.01;
            values.friction = 0.5;
            values.bounce = 0.2;
            break;
        case MaterialPreset::glass:
            touch = {.stiffness = 2800.0, .damping = 1.4, .static_friction = 0.2, .dynamic_friction = 0.12};
            touch.stribeck_speed = 0.02;
            touch.impact_strength = 6.0;
            touch.impact_frequency = 400.0;
            touch.impact_decay = 0.02;
            values.friction = 0.2;
            values.bounce = 0.3;
            break;
        case MaterialPreset::skin:
            touch = {.stiffness = 300.0, .damping = 2.0, .static_friction = 0.8, .dynamic_friction = 0.6};
            touch.stiffening = 3.0;
            touch.stiffening_depth = 0.01;
            touch.viscosity = 0.5;
            values.friction = 0.8;
            break;
        case MaterialPreset::foam:
            touch = {.stiffness = 80.0, .damping = 1.0, .static_friction = 0.6, .dynamic_friction = 0.45};
            touch.stiffening = 8.0;
            touch.stiffening_depth = 0.04;
            values.friction = 0.6;
            break;
        case MaterialPreset::custom:
            break;
    }
    return values;
}

std::shared_ptr<const TouchImage> grain() {
    static const auto image = [] {
        auto made = std::make_shared<TouchImage>(TouchImage{grain_side, grain_side, {}});
        std::uint32_t random = 1;
        for (std::uint32_t i = 0; i < grain_side * grain_side; ++i) {
            random = random * 1664525u + 1013904223u;  // Numerical Recipes, 7.1
            made->values.push_back(static_cast<float>(random >> 8) * 0x1p-24f);
        }
        return made;
    }();
    return image;
}

std::shared_ptr<const TouchImage> touch_image(std::uint32_t columns, std::uint32_t rows,
                                              std::span<const std::uint8_t> bytes) {
    auto made = std::make_shared<TouchImage>();
    made->columns = columns;
    made->rows = rows;
    made->values.resize(std::size_t{columns} * rows);
    if (bytes.size() != made->values.size() * sizeof(float)) {
        return nullptr;
    }
    std::memcpy(made->values.data(), bytes.data(), bytes.size());
    for (float& height : made->values) {
        height = height >= 0.0f ? std::min(height, 1.0f) : 0.0f;
    }
    return made;
}

MaterialPreset PresetChoice::preset(const MaterialValues& now) const {
    if (chosen_ != MaterialPreset::custom || !left_.empty()) {
        return chosen_;
    }
    for (const MaterialPreset preset : presets) {
        if (same_values(now, values_of(preset))) {
            return preset;
        }
    }
    return MaterialPreset::custom;
}

std::optional<MaterialValues> PresetChoice::choose(MaterialPreset preset, const MaterialValues& now) {
    const MaterialPreset before = this->preset(now);
    if (preset == before) {
        return std::nullopt;
    }
    left_[before] = now;
    chosen_ = preset;
    const auto known = left_.find(preset);
    if (known != left_.end()) {
        return known->second;
    }
    return preset != MaterialPreset::custom ? std::optional(values_of(preset)) : std::nullopt;
}

}  // namespace tactus
