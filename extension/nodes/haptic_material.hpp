#pragma once

#include <godot_cpp/classes/curve.hpp>
#include <godot_cpp/classes/physics_material.hpp>
#include <godot_cpp/classes/texture2d.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <memory>
#include <string>

#include "core/haptics/touch_material.hpp"
#include "nodes/properties.hpp"
#include "world/material_presets.hpp"

namespace tactus {

// What a surface feels like. Goes into the ordinary physics_material_override of a body, and keeps what a
// PhysicsMaterial says about contacts between bodies.
class HapticMaterial : public godot::PhysicsMaterial {
    GDCLASS(HapticMaterial, godot::PhysicsMaterial)

public:
    enum Preset : int64_t {
        PRESET_CUSTOM = static_cast<int64_t>(MaterialPreset::custom),
        PRESET_RUBBER = static_cast<int64_t>(MaterialPreset::rubber),
        PRESET_ICE = static_cast<int64_t>(MaterialPreset::ice),
        PRESET_SANDPAPER = static_cast<int64_t>(MaterialPreset::sandpaper),
        PRESET_STEEL = static_cast<int64_t>(MaterialPreset::steel),
        PRESET_SPONGE = static_cast<int64_t>(MaterialPreset::sponge),
        PRESET_WOOD = static_cast<int64_t>(MaterialPreset::wood),
        PRESET_GLASS = static_cast<int64_t>(MaterialPreset::glass),
        PRESET_SKIN = static_cast<int64_t>(MaterialPreset::skin),
        PRESET_FOAM = static_cast<int64_t>(MaterialPreset::foam),
    };

    TACTUS_PROPERTIES(HapticMaterial)

    // All values become the preset's, or those that they were when it was left. Nothing is forgotten: what
    // the material had before comes back with the preset that it had before.
    void set_preset(Preset preset);
    // The one that was chosen; where none was, the one whose values these are.
    Preset get_preset() const;

    enum TextureMapping : int64_t { TEXTURE_MAPPING_FRAME, TEXTURE_MAPPING_UV };

    // Ready for use, without images: static friction is never below dynamic friction.
    TouchMaterial touch() const;
    TouchImages images() const;
    // Which of them cannot be read, and what to do; empty where there is none.
    std::string problem() const;
    // The same for a body; null where there are none.
    std::shared_ptr<const TouchDetail> detail() const;
    // The properties that are set and that tools do not feel, as "'a', 'b'"; empty where there are none.
    std::string unfelt_by_tools() const;
    // The same of those that are not transmitted over a network.
    std::string untransmitted() const;
    bool is_laid_by_uv() const { return mapping_ == TEXTURE_MAPPING_UV && (images() != TouchImages()); }

protected:
    static void _bind_methods();

private:
    void texture_changed();
    void friction_changed();
    void curve_changed();

    MaterialValues values() const { return {touch_, get_friction(), get_bounce()}; }

    TouchMaterial touch_ = MaterialValues().touch;
    PresetChoice choice_;
    godot::Ref<godot::Texture2D> texture_;
    godot::Ref<godot::Texture2D> friction_;
    godot::Ref<godot::Curve> curve_;
    TextureMapping mapping_ = TEXTURE_MAPPING_FRAME;
    mutable TouchImages read_;  // each once, when somebody asks
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::HapticMaterial::Preset);
