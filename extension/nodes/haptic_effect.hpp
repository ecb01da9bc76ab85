#pragma once

#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <optional>

#include "core/haptics/hand_effect.hpp"
#include "nodes/haptic_force.hpp"
#include "nodes/haptic_guide.hpp"
#include "nodes/node_state.hpp"
#include "nodes/properties.hpp"
#include "world/frame_budget.hpp"

namespace tactus {

// A force on the hand: in closed form, of a guide, or as a script computes it, once a frame. The haptic
// thread never calls a script.
class HapticEffect : public godot::Node {
    GDCLASS(HapticEffect, godot::Node)

public:
    enum State : int64_t { STATE_OFF, STATE_FAILED, STATE_WAITING, STATE_WORKING };

    TACTUS_PROPERTIES(HapticEffect)

    State get_state() const;
    godot::String get_state_text() const;
    double get_duration() const { return to_seconds(taken_); }
    double get_time_ms() const { return 1e3 * to_seconds(taken_); }

    godot::PackedStringArray _get_configuration_warnings() const override;

    // --- for the world that it is in

    const godot::Node3D* hand_node() const;         // a ProxyPointer or a HapticTool; null: none
    godot::String problem() const;                  // of its own; empty where there is none
    std::optional<HandEffect> closed_form() const;  // nothing where it has none, or is off
    std::optional<HandGuide> placed_guide() const;  // as above
    // Once a frame: why its hand has no room for it, and what to do; empty where it has.
    void set_without_room(const godot::String& why) { without_room_ = why; }
    // Once a frame: whether the script is asked in this one, the questions, and whether it may stay on. It
    // answers with the force on that hand at this time of the world (unit: seconds), or with nothing where
    // that switches it off. The script may free whatever it likes but this node.
    bool begin_frame();
    std::optional<Vec3> ask(const HandMotion& hand, double time);
    bool end_frame();

protected:
    static void _bind_methods();
    void _notification(int what);

private:
    godot::String hindrance() const;  // its problem, or the lack of room
    void enabled_changed();
    bool is_on() const;
    godot::Transform3D frame() const;
    void switch_off(const godot::String& why);

    godot::NodePath proxy_;
    godot::Ref<HapticForce> formula_;
    godot::Ref<HapticGuide> guide_;
    godot::String method_ = "_get_force";
    double time_budget_ = 1e-3;  // (unit: seconds)
    bool enabled_ = true;

    godot::String why_off_;  // by itself; empty: it is not
    godot::String without_room_;
    Nanoseconds taken_ = 0;  // by the script, for one frame
    FrameBudget budget_;
    ToldState<State> told_;
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::HapticEffect::State);
