#pragma once

#include <godot_cpp/classes/audio_stream_player3d.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <memory>

#include "core/feedback/touch_feedback.hpp"
#include "nodes/node_state.hpp"
#include "nodes/properties.hpp"
#include "world/tick_listeners.hpp"

namespace tactus {

// What a hand without motors is given instead of a force: vibration and sound of what its proxy touches. The
// loop puts every tick into a ring; each frame what is there drives a motor and a loudspeaker.
class HapticVibrationSound : public godot::Node3D {
    GDCLASS(HapticVibrationSound, godot::Node3D)

public:
    enum State : int64_t { STATE_OFF, STATE_FAILED, STATE_WAITING, STATE_WORKING };
    HapticVibrationSound();

    TACTUS_PROPERTIES(HapticVibrationSound)

    godot::Vector2 get_motor_levels() const;
    State get_state() const;
    godot::String get_state_text() const;

    godot::PackedStringArray _get_configuration_warnings() const override;

    // --- for the world that runs it

    // Else it is given no ticks.
    bool is_wanted() const { return vibration_ || sound_; }
    // The loop may still be writing into it when the node has left.
    const std::shared_ptr<TickRing>& ring() const { return ring_; }
    // The one that 'proxy' names; where that is empty, the one above, or the first of its world.
    const godot::Node3D* hand_node() const;
    godot::String problem() const;  // empty where there is none

protected:
    static void _bind_methods();
    void _notification(int what);

private:
    void play();
    void drive_motors(const MotorLevels& levels);
    void push_sound();
    void fall_silent();

    godot::NodePath proxy_;
    bool vibration_ = true;
    bool sound_ = true;
    int gamepad_ = 0;
    godot::NodePath controller_;
    MotorSettings motors_;
    double volume_db_ = 0.0;

    std::shared_ptr<TickRing> ring_;
    TouchFeedback feedback_;
    MotorLevels levels_;
    godot::AudioStreamPlayer3D* player_ = nullptr;  // made when there is something to hear
    ToldState<State> told_;
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::HapticVibrationSound::State);
