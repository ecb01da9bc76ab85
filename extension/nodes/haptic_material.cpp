#include "nodes/haptic_material.hpp"

#include <godot_cpp/classes/image.hpp>
#include <initializer_list>
#include <utility>

#include "nodes/messages.hpp"
#include "nodes/red_channel.hpp"

namespace tactus {

using namespace godot;

namespace {

std::shared_ptr<const TouchImage> image_of(const Ref<Texture2D>& texture) {
    const Ref<Image> image = texture->get_image();
    if (image.is_null() || image->is_empty()) {
        return nullptr;
    }
    const PackedByteArray bytes = red_channel(image);
    return touch_image(static_cast<std::uint32_t>(image->get_width()),
                       static_cast<std::uint32_t>(image->get_height()),
                       {bytes.ptr(), static_cast<std::size_t>(bytes.size())});
}

// Newtons over millimeters, from 0 mm on, where the force is 0.
std::shared_ptr<const ForceCurve> force_curve_of(const Curve& drawn) {
    constexpr std::size_t samples = 513;
    constexpr double millimeter = 1e-3;
    const double depth = drawn.get_max_domain();
    std::vector<double> forces(samples, 0.0);
    for (std::size_t i = 1; i < samples; ++i) {
        const double at = depth * static_cast<double>(i) / (samples - 1);
        forces[i] = drawn.sample(static_cast<real_t>(at));
    }
    return ForceCurve::of(depth * millimeter, std::move(forces));
}

// One that another thread makes has its image later, and says so.
bool is_without_image(const Ref<Texture2D>& texture, const std::shared_ptr<const TouchImage>& image) {
    return texture.is_valid() && image == nullptr && !texture->is_class("NoiseTexture2D");
}

// Of those that are set, as "'a', 'b'".
std::string names_of(std::initializer_list<std::pair<bool, const char*>> all) {
    std::string names;
    for (const auto& [is_set, name] : all) {
        names += is_set ? std::string(names.empty() ? "'" : ", '") + name + "'" : "";
    }
    return names;
}

}  // namespace

void HapticMaterial::set_preset(Preset preset) {
    if (preset < PRESET_CUSTOM || preset > PRESET_FOAM) {
        refuse(*this, "preset", static_cast<int64_t>(preset), "one of the constants PRESET_…");
        return;
    }
    if (preset == get_preset()) {
        return;
    }
    if (const auto now = choice_.choose(static_cast<MaterialPreset>(preset), values())) {
        touch_ = now->touch;
        set_friction(static_cast<real_t>(now->friction));
        set_bounce(static_cast<real_t>(now->bounce));
    }
    notify_property_list_changed();
    emit_changed();
}

HapticMaterial::Preset HapticMaterial::get_preset() const {
    return static_cast<Preset>(choice_.preset(values()));
}

// An image that is made in the background, as a NoiseTexture2D's is, comes late and says so.
void HapticMaterial::texture_changed() {
    read_.heights.reset();
    emit_changed();
}

void HapticMaterial::friction_changed() {
    read_.friction.reset();
    emit_changed();
}

void HapticMaterial::curve_changed() {
    read_.curve.reset();
    emit_changed();
}

TouchImages HapticMaterial::images() const {
    const auto read = [](const Ref<Texture2D>& texture, std::shared_ptr<const TouchImage>& image) {
        if (image == nullptr && texture.is_valid()) {
            image = image_of(texture);
        }
        return image;
    };
    TouchImages images;
    if (touch_.texture_depth > 0.0) {
        images.heights = texture_.is_null() ? grain() : read(texture_, read_.heights);
    }
    images.friction = read(friction_, read_.friction);
    if (curve_.is_valid() && read_.curve == nullptr) {
        read_.curve = force_curve_of(**curve_);
    }
    images.curve = read_.curve != nullptr && check_curve(*read_.curve).empty() ? read_.curve : nullptr;
    return images;
}

std::string HapticMaterial::problem() const {
    const TouchImages all = images();
    if (read_.curve != nullptr && images().curve == nullptr) {
        return "the 'force_curve' of its HapticMaterial is not felt: " + check_curve(*read_.curve);
    }
    const bool is_heights = touch_.texture_depth > 0.0 && is_without_image(texture_, all.heights);
    return is_heights || is_without_image(friction_, all.friction)
               ? std::string("the ") + (is_heights ? "'texture_image'" : "'friction_image'") +
                     " of its HapticMaterial has no image that can be read, and nothing is felt of it: "
                     "choose "
                     "a texture that is loaded from an image"
               : "";
}

std::shared_ptr<const TouchDetail> HapticMaterial::detail() const {
    TouchImages all = images();
    return all == TouchImages() ? nullptr
                                : std::make_shared<const TouchDetail>(TouchDetail{std::move(all), {}});
}

std::string HapticMaterial::unfelt_by_tools() const {
    return names_of({{curve_.is_valid(), "force_curve"},
                     {touch_.texture_depth > 0.0, "texture_depth"},
                     {touch_.magnet_force > 0.0, "magnet_force"},
                     {touch_.viscosity > 0.0, "viscosity"},
                     {touch_.stick_slip_force > 0.0 && touch_.stick_slip_stiffness > 0.0, "stick_slip_force"},
                     {touch_.vibration_force > 0.0, "vibration_force"},
                     {touch_.impact_strength > 0.0, "impact_strength"},
                     {touch_.pop_through_force > 0.0, "pop_through_force"}});
}

std::string HapticMaterial::untransmitted() const {
    return names_of({{curve_.is_valid(), "force_curve"}, {touch_.shaft_friction > 0.0, "shaft_friction"}});
}

TouchMaterial HapticMaterial::touch() const {
    TouchMaterial touch = touch_;
    touch.static_friction = std::max(touch.static_friction, touch.dynamic_friction);
    touch.by_uv = mapping_ == TEXTURE_MAPPING_UV;
    return touch;
}

}  // namespace tactus
