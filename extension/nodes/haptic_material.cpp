#include "nodes/haptic_material.hpp"

#include <algorithm>
#include <cstring>
#include <godot_cpp/classes/image.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <string>

#include "nodes/messages.hpp"
#include "nodes/touch_values.hpp"

namespace tactus {

using namespace godot;

namespace {

struct ValueName {
    double TouchMaterial::* member;
    const char* name;
};

constexpr ValueName value_names[] = {
    {&TouchMaterial::stiffness, "stiffness"},
    {&TouchMaterial::damping, "damping"},
    {&TouchMaterial::static_friction, "static_friction"},
    {&TouchMaterial::dynamic_friction, "dynamic_friction"},
    {&TouchMaterial::viscosity, "viscosity"},
    {&TouchMaterial::pop_through_force, "pop_through_force"},
    {&TouchMaterial::texture_size, "texture_size"},
    {&TouchMaterial::texture_depth, "texture_depth"},
    {&TouchMaterial::magnet_force, "magnet_force"},
    {&TouchMaterial::magnet_range, "magnet_range"},
    {&TouchMaterial::stick_slip_stiffness, "stick_slip_stiffness"},
    {&TouchMaterial::stick_slip_force, "stick_slip_force"},
    {&TouchMaterial::vibration_force, "vibration_force"},
    {&TouchMaterial::vibration_frequency, "vibration_frequency"},
};

const char* name_of_value(double TouchMaterial::* member) {
    return std::ranges::find(value_names, member, &ValueName::member)->name;
}

// Lengths that other values are divided by.
bool must_be_above_zero(double TouchMaterial::* member) {
    return member == &TouchMaterial::texture_size || member == &TouchMaterial::magnet_range;
}

struct PresetValues {
    TouchMaterial touch;
    double friction = 1.0;  // between bodies, as PhysicsMaterial has it
    double bounce = 0.0;
};

// Chosen by what a device of 3000 N/m and a hand can render at 1 kHz; none is a measured sample of its name.
PresetValues values_of(HapticMaterial::Preset preset) {
    PresetValues values;
    TouchMaterial& touch = values.touch;
    switch (preset) {
        case HapticMaterial::PRESET_RUBBER:
            touch = {.stiffness = 800.0, .damping = 1.5, .static_friction = 1.1, .dynamic_friction = 0.8};
            touch.stick_slip_stiffness = 300.0;
            touch.stick_slip_force = 0.6;
            values.friction = 0.9;
            values.bounce = 0.5;
            break;
        case HapticMaterial::PRESET_ICE:
            touch = {.stiffness = 2000.0, .damping = 1.0, .static_friction = 0.05, .dynamic_friction = 0.02};
            values.friction = 0.03;
            values.bounce = 0.1;
            break;
        case HapticMaterial::PRESET_SANDPAPER:
            touch = {.stiffness = 1500.0, .damping = 1.0, .static_friction = 0.9, .dynamic_friction = 0.7};
            touch.texture_size = 0.05;
            touch.texture_depth = 0.0002;
            values.friction = 0.9;
            break;
        case HapticMaterial::PRESET_STEEL:
            touch = {.stiffness = 3000.0, .damping = 1.5, .static_friction = 0.25, .dynamic_friction = 0.2};
            values.friction = 0.3;
            values.bounce = 0.3;
            break;
        case HapticMaterial::PRESET_SPONGE:
            touch = {.stiffness = 150.0, .damping = 2.0, .static_friction = 0.7, .dynamic_friction = 0.5};
            touch.viscosity = 1.0;
            values.friction = 0.7;
            break;
        case HapticMaterial::PRESET_CUSTOM:
            break;
    }
    return values;
}

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

void HapticMaterial::set_preset(Preset preset) {
    if (preset == PRESET_CUSTOM) {
        return;
    }
    const PresetValues values = values_of(preset);
    touch_ = values.touch;
    set_friction(static_cast<real_t>(values.friction));
    set_bounce(static_cast<real_t>(values.bounce));
    notify_property_list_changed();
    emit_changed();
}

HapticMaterial::Preset HapticMaterial::get_preset() const {
    for (const Preset preset : {PRESET_RUBBER, PRESET_ICE, PRESET_SANDPAPER, PRESET_STEEL, PRESET_SPONGE}) {
        const PresetValues values = values_of(preset);
        if (same_values(touch_, values.touch) && get_friction() == static_cast<real_t>(values.friction) &&
            get_bounce() == static_cast<real_t>(values.bounce)) {
            return preset;
        }
    }
    return PRESET_CUSTOM;
}

template <double TouchMaterial::* member>
void HapticMaterial::set_value(double value) {
    if (!is_at_least_zero(value) || (must_be_above_zero(member) && value == 0.0)) {
        refuse(*this, name_of_value(member), value,
               must_be_above_zero(member) ? "a finite number above 0" : "a finite number, 0 or more");
        return;
    }
    if (touch_.*member != value) {
        touch_.*member = value;
        emit_changed();
    }
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

template <double TouchMaterial::* member>
void HapticMaterial::bind_value(const char* name, const char* hint) {
    const std::string setter = std::string("set_") + name;
    const std::string getter = std::string("get_") + name;
    ClassDB::bind_method(D_METHOD(setter.c_str(), "value"), &HapticMaterial::set_value<member>);
    ClassDB::bind_method(D_METHOD(getter.c_str()), &HapticMaterial::get_value<member>);
    ADD_PROPERTY(PropertyInfo(Variant::FLOAT, name, PROPERTY_HINT_RANGE, String::utf8(hint)), setter.c_str(),
                 getter.c_str());
}

void HapticMaterial::_bind_methods() {
    ClassDB::bind_method(D_METHOD("set_preset", "preset"), &HapticMaterial::set_preset);
    ClassDB::bind_method(D_METHOD("get_preset"), &HapticMaterial::get_preset);
    ClassDB::bind_method(D_METHOD("set_texture_image", "texture"), &HapticMaterial::set_texture_image);
    ClassDB::bind_method(D_METHOD("get_texture_image"), &HapticMaterial::get_texture_image);
    ClassDB::bind_method(D_METHOD("_texture_changed"), &HapticMaterial::texture_changed);

    // Not stored: the values it fills in are.
    ADD_PROPERTY(PropertyInfo(Variant::INT, "preset", PROPERTY_HINT_ENUM,
                              "Custom,Rubber,Ice,Sandpaper,Steel,Sponge", PROPERTY_USAGE_EDITOR),
                 "set_preset", "get_preset");
    ADD_GROUP("Touch", "");
    bind_value<&TouchMaterial::stiffness>("stiffness", "0,5000,1,or_greater,suffix:N/m");
    bind_value<&TouchMaterial::damping>("damping", "0,20,0.01,or_greater,suffix:N·s/m");
    bind_value<&TouchMaterial::static_friction>("static_friction", "0,2,0.01,or_greater");
    bind_value<&TouchMaterial::dynamic_friction>("dynamic_friction", "0,2,0.01,or_greater");
    bind_value<&TouchMaterial::viscosity>("viscosity", "0,20,0.01,or_greater,suffix:N·s/m");
    bind_value<&TouchMaterial::pop_through_force>("pop_through_force", "0,20,0.01,or_greater,suffix:N");
    ADD_GROUP("Texture", "texture_");
    ADD_PROPERTY(PropertyInfo(Variant::OBJECT, "texture_image", PROPERTY_HINT_RESOURCE_TYPE, "Texture2D"),
                 "set_texture_image", "get_texture_image");
    bind_value<&TouchMaterial::texture_size>("texture_size", "0.001,1,0.001,or_greater,suffix:m");
    bind_value<&TouchMaterial::texture_depth>("texture_depth", "0,0.01,0.00001,or_greater,suffix:m");
    ADD_GROUP("Magnet", "magnet_");
    bind_value<&TouchMaterial::magnet_force>("magnet_force", "0,10,0.01,or_greater,suffix:N");
    bind_value<&TouchMaterial::magnet_range>("magnet_range", "0.001,0.1,0.001,or_greater,suffix:m");
    ADD_GROUP("Stick-Slip", "stick_slip_");
    bind_value<&TouchMaterial::stick_slip_stiffness>("stick_slip_stiffness",
                                                     "0,2000,1,or_greater,suffix:N/m");
    bind_value<&TouchMaterial::stick_slip_force>("stick_slip_force", "0,10,0.01,or_greater,suffix:N");
    ADD_GROUP("Vibration", "vibration_");
    bind_value<&TouchMaterial::vibration_force>("vibration_force", "0,5,0.01,or_greater,suffix:N");
    bind_value<&TouchMaterial::vibration_frequency>("vibration_frequency", "0,500,0.1,or_greater,suffix:Hz");

    BIND_ENUM_CONSTANT(PRESET_CUSTOM);
    BIND_ENUM_CONSTANT(PRESET_RUBBER);
    BIND_ENUM_CONSTANT(PRESET_ICE);
    BIND_ENUM_CONSTANT(PRESET_SANDPAPER);
    BIND_ENUM_CONSTANT(PRESET_STEEL);
    BIND_ENUM_CONSTANT(PRESET_SPONGE);
}

}  // namespace tactus
