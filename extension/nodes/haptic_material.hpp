#pragma once

#include <godot_cpp/classes/physics_material.hpp>
#include <godot_cpp/classes/texture2d.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <memory>

#include "core/haptics/touch_material.hpp"

namespace tactus {

// What a surface feels like. Goes into the ordinary physics_material_override of a body, and keeps what a
// PhysicsMaterial says about contacts between bodies.
class HapticMaterial : public godot::PhysicsMaterial {
    GDCLASS(HapticMaterial, godot::PhysicsMaterial)

public:
    enum Preset {
        PRESET_CUSTOM,
        PRESET_RUBBER,
        PRESET_ICE,
        PRESET_SANDPAPER,
        PRESET_STEEL,
        PRESET_SPONGE,
    };

    // Fills all values; PRESET_CUSTOM changes none.
    void set_preset(Preset preset);
    // The preset whose values these are.
    Preset get_preset() const;

    void set_texture_image(const godot::Ref<godot::Texture2D>& texture);
    godot::Ref<godot::Texture2D> get_texture_image() const { return texture_; }

    // Ready for use, without the texture: static friction is never below dynamic friction.
    TouchMaterial touch() const;
    // The texture's heights; null where it has no depth.
    std::shared_ptr<const HeightImage> heights() const;

protected:
    static void _bind_methods();

private:
    template <double TouchMaterial::* member>
    void set_value(double value);
    template <double TouchMaterial::* member>
    double get_value() const {
        return touch_.*member;
    }
    template <double TouchMaterial::* member>
    static void bind_value(const char* name, const char* hint);
    void texture_changed();

    TouchMaterial touch_;
    godot::Ref<godot::Texture2D> texture_;
    mutable std::shared_ptr<const HeightImage> heights_;  // read once, when somebody asks
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::HapticMaterial::Preset);
