#include "nodes/haptic_material.hpp"

#include <algorithm>
#include <cstring>
#include <godot_cpp/classes/image.hpp>

#include "core/haptics/touch_values.hpp"
#include "nodes/messages.hpp"

namespace tactus {

using namespace godot;

namespace {

constexpr std::uint32_t grain_side = 64;  // grains along a side of the texture

// Grains of random height, the same everywhere: for roughness without an image.
std::shared_ptr<const HeightImage> grain() {
    static const auto image = [] {
        auto made = std::make_shared<HeightImage>(HeightImage{grain_side, grain_side, {}});
        std::uint32_t random = 1;
        for (std::uint32_t i = 0; i < grain_side * grain_side; ++i) {
            random = random * 1664525u + 1013904223u;  // Numerical Recipes, 7.1
            made->heights.push_back(static_cast<float>(random >> 8) * 0x1p-24f);
        }
        return made;
    }();
    return image;
}

std::shared_ptr<const HeightImage> heights_of(const Ref<Texture2D>& texture) {
    Ref<Image> image = texture->get_image();
    if (image.is_null() || image->is_empty()) {
        return nullptr;
    }
    image = image->duplicate();
    if (image->is_compressed()) {
        image->decompress();
    }
    image->clear_mipmaps();
    image->convert(Image::FORMAT_RF);
    auto made = std::make_shared<HeightImage>();
    made->columns = static_cast<std::uint32_t>(image->get_width());
    made->rows = static_cast<std::uint32_t>(image->get_height());
    made->heights.resize(std::size_t{made->columns} * made->rows);
    const PackedByteArray bytes = image->get_data();
    if (bytes.size() != static_cast<int64_t>(made->heights.size() * sizeof(float))) {
        return nullptr;
    }
    std::memcpy(made->heights.data(), bytes.ptr(), static_cast<std::size_t>(bytes.size()));
    for (float& height : made->heights) {
        height = height >= 0.0f ? std::min(height, 1.0f) : 0.0f;  // what is not a number is 0, too
    }
    return made;
}

}  // namespace

// Chosen by what a device of 3000 N/m and a hand can render at 1 kHz; none is a measured sample of its name.
HapticMaterial::PresetValues HapticMaterial::values_of(Preset preset) {
    PresetValues values;
    TouchMaterial& touch = values.touch;
    switch (preset) {
        case PRESET_RUBBER:
            touch = {.stiffness = 800.0, .damping = 1.5, .static_friction = 1.1, .dynamic_friction = 0.8};
            touch.stick_slip_stiffness = 300.0;
            touch.stick_slip_force = 0.6;
            values.friction = 0.9;
            values.bounce = 0.5;
            break;
        case PRESET_ICE:
            touch = {.stiffness = 2000.0, .damping = 1.0, .static_friction = 0.05, .dynamic_friction = 0.02};
            values.friction = 0.03;
            values.bounce = 0.1;
            break;
        case PRESET_SANDPAPER:
            touch = {.stiffness = 1500.0, .damping = 1.0, .static_friction = 0.9, .dynamic_friction = 0.7};
            touch.texture_size = 0.05;
            touch.texture_depth = 0.0002;
            values.friction = 0.9;
            break;
        case PRESET_STEEL:
            touch = {.stiffness = 3000.0, .damping = 1.5, .static_friction = 0.25, .dynamic_friction = 0.2};
            values.friction = 0.3;
            values.bounce = 0.3;
            break;
        case PRESET_SPONGE:
            touch = {.stiffness = 150.0, .damping = 2.0, .static_friction = 0.7, .dynamic_friction = 0.5};
            touch.viscosity = 1.0;
            values.friction = 0.7;
            break;
        case PRESET_CUSTOM:
            break;
    }
    return values;
}

void HapticMaterial::set_preset(Preset preset) {
    if (!is_one_of(*this, "preset", preset, PRESET_SPONGE, "PRESET")) {
        return;
    }
    const Preset before = get_preset();
    if (preset == before) {
        return;
    }
    left_[before] = values();
    const auto known = left_.find(preset);
    if (preset != PRESET_CUSTOM || known != left_.end()) {
        const PresetValues now = known != left_.end() ? known->second : values_of(preset);
        touch_ = now.touch;
        set_friction(static_cast<real_t>(now.friction));
        set_bounce(static_cast<real_t>(now.bounce));
    }
    preset_ = preset;
    notify_property_list_changed();
    emit_changed();
}

HapticMaterial::Preset HapticMaterial::get_preset() const {
    if (preset_ != PRESET_CUSTOM || !left_.empty()) {
        return preset_;
    }
    for (const Preset preset : {PRESET_RUBBER, PRESET_ICE, PRESET_SANDPAPER, PRESET_STEEL, PRESET_SPONGE}) {
        const PresetValues values = values_of(preset);
        if (same_values(touch_, values.touch) && get_friction() == static_cast<real_t>(values.friction) &&
            get_bounce() == static_cast<real_t>(values.bounce)) {
            return preset;
        }
    }
    return PRESET_CUSTOM;
}

void HapticMaterial::set_texture_image(const Ref<Texture2D>& texture) {
    const Callable on_change(this, "_texture_changed");
    if (texture_.is_valid() && texture_->is_connected("changed", on_change)) {
        texture_->disconnect("changed", on_change);
    }
    texture_ = texture;
    if (texture_.is_valid()) {
        texture_->connect("changed", on_change);
    }
    texture_changed();
}

// An image that is made in the background, as a NoiseTexture2D's is, comes late and says so.
void HapticMaterial::texture_changed() {
    heights_.reset();
    emit_changed();
}

std::shared_ptr<const HeightImage> HapticMaterial::heights() const {
    if (!(touch_.texture_depth > 0.0)) {
        return nullptr;
    }
    if (texture_.is_null()) {
        return grain();
    }
    if (heights_ == nullptr) {
        heights_ = heights_of(texture_);
    }
    return heights_;
}

TouchMaterial HapticMaterial::touch() const {
    TouchMaterial touch = touch_;
    touch.static_friction = std::max(touch.static_friction, touch.dynamic_friction);
    return touch;
}

}  // namespace tactus
