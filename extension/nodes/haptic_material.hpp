#pragma once

#include <godot_cpp/classes/physics_material.hpp>
#include <godot_cpp/classes/texture2d.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <map>
#include <memory>

#include "core/haptics/touch_material.hpp"
#include "nodes/value_rows.hpp"

namespace tactus {

// What a surface feels like. Goes into the ordinary physics_material_override of a body, and keeps what a
// PhysicsMaterial says about contacts between bodies.
class HapticMaterial : public godot::PhysicsMaterial {
    GDCLASS(HapticMaterial, godot::PhysicsMaterial)

public:
    enum Preset : int64_t {
        PRESET_CUSTOM,
        PRESET_RUBBER,
        PRESET_ICE,
        PRESET_SANDPAPER,
        PRESET_STEEL,
        PRESET_SPONGE,
    };

    static std::span<const ValueRow<TouchMaterial>> rows();
    void set_value(int64_t index, const godot::Variant& value) {
        tactus::set_value(*this, rows(), index, touch_, value);
    }
    godot::Variant get_value(int64_t index) const { return tactus::get_value(rows(), index, touch_); }

    // All values become the preset's, or those that they were when it was left. Nothing is forgotten: what
    // the material had before comes back with the preset that it had before.
    void set_preset(Preset preset);
    // The one that was chosen; where none was, the one whose values these are.
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
    void texture_changed();

    struct PresetValues {
        TouchMaterial touch;
        double friction = 1.0;  // between bodies, as PhysicsMaterial has it
        double bounce = 0.0;
    };
    static PresetValues values_of(Preset preset);
    PresetValues values() const { return {touch_, get_friction(), get_bounce()}; }

    TouchMaterial touch_;
    Preset preset_ = PRESET_CUSTOM;
    std::map<Preset, PresetValues> left_;  // as they were when another preset was chosen
    godot::Ref<godot::Texture2D> texture_;
    mutable std::shared_ptr<const HeightImage> heights_;  // read once, when somebody asks
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::HapticMaterial::Preset);
