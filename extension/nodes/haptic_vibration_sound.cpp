#include "nodes/haptic_vibration_sound.hpp"

#include <algorithm>
#include <godot_cpp/classes/audio_stream_generator.hpp>
#include <godot_cpp/classes/audio_stream_generator_playback.hpp>
#include <godot_cpp/classes/input.hpp>
#include <godot_cpp/classes/xr_controller3d.hpp>

#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/proxy_choice.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

// Eight times the highest tap that is heard, and no more.
constexpr float sound_rate = 22050.0f;

// Two frames of a slow picture are in it; what is heard is that late (unit: seconds).
constexpr float sound_buffer = 0.1f;

// A second of ticks: after a longer pause what came first is no news.
constexpr std::size_t ring_capacity = 1024;

// Longer than a frame, so that the motor does not stop between two; short enough not to go on by itself
// (unit: seconds).
constexpr double pulse_seconds = 0.1;

}  // namespace

HapticVibrationSound::HapticVibrationSound()
    : ring_(std::make_shared<TickRing>(ring_capacity)), feedback_(static_cast<double>(sound_rate)) {}

const Node3D* HapticVibrationSound::hand_node() const {
    return chosen_hand(*this, proxy_);
}

String HapticVibrationSound::problem() const {
    return problem_of_hand(*this, proxy_);
}

HapticVibrationSound::State HapticVibrationSound::get_state() const {
    if (problem().is_empty() && !is_wanted()) {
        return STATE_OFF;
    }
    const bool has_world = HapticWorld::of(this) != nullptr;
    return state_of<State>(!problem().is_empty(), has_world, has_world);
}

String HapticVibrationSound::get_state_text() const {
    if (const String wrong = problem(); !wrong.is_empty()) {
        return wrong;
    }
    if (!is_wanted()) {
        return "both 'vibration' and 'sound' are off";
    }
    const bool has_motor = Object::cast_to<XRController3D>(get_node_or_null(controller_)) != nullptr ||
                           Input::get_singleton()->get_connected_joypads().has(gamepad_);
    return vibration_ && !has_motor ? "working; no gamepad or controller is there to vibrate" : "working";
}

PackedStringArray HapticVibrationSound::_get_configuration_warnings() const {
    PackedStringArray warnings;
    if (is_inside_tree()) {
        for (const String& wrong : {problem(), problem_without_world(*this)}) {
            warn(warnings, "This HapticVibrationSound is silent", wrong);
        }
    }
    return warnings;
}

Vector2 HapticVibrationSound::get_motor_levels() const {
    return {static_cast<real_t>(levels_.heavy), static_cast<real_t>(levels_.light)};
}

void HapticVibrationSound::drive_motors(const MotorLevels& levels) {
    const bool was_still = levels_.heavy == 0.0 && levels_.light == 0.0;
    levels_ = levels;
    if (was_still && levels.heavy == 0.0 && levels.light == 0.0) {
        return;
    }
    const auto heavy = static_cast<float>(levels.heavy);
    const auto light = static_cast<float>(levels.light);
    if (auto* controller = Object::cast_to<XRController3D>(get_node_or_null(controller_))) {
        controller->trigger_haptic_pulse("haptic", 0.0, std::max(levels.heavy, levels.light), pulse_seconds,
                                         0.0);
    } else if (heavy > 0.0f || light > 0.0f) {
        Input::get_singleton()->start_joy_vibration(gamepad_, light, heavy, pulse_seconds);
    } else {
        Input::get_singleton()->stop_joy_vibration(gamepad_);
    }
}

// What finds no room is late already.
void HapticVibrationSound::push_sound() {
    const std::vector<float> samples = feedback_.take_samples();
    if (samples.empty() || !sound_) {
        return;
    }
    if (player_ == nullptr) {
        Ref<AudioStreamGenerator> stream;
        stream.instantiate();
        stream->set_mix_rate(sound_rate);
        stream->set_buffer_length(sound_buffer);
        player_ = memnew(AudioStreamPlayer3D);
        player_->set_stream(stream);
        player_->set_as_top_level(true);
        add_child(player_, false, INTERNAL_MODE_BACK);
        player_->play();
        // Godot plays on for a moment when the player has gone, and does not hold the stream itself.
        if (const Ref<AudioStreamPlayback> playing = player_->get_stream_playback(); playing.is_valid()) {
            playing->set_meta("stream", stream);
        }
    }
    if (const Node3D* hand = hand_node()) {
        player_->set_global_position(hand->get_global_position());
    }
    player_->set_volume_db(static_cast<float>(volume_db_));
    const Ref<AudioStreamPlayback> playing = player_->get_stream_playback();
    if (auto* playback = Object::cast_to<AudioStreamGeneratorPlayback>(playing.ptr())) {
        const auto room = static_cast<std::size_t>(std::max<int64_t>(0, playback->get_frames_available()));
        PackedVector2Array frames;
        frames.resize(static_cast<int64_t>(std::min(room, samples.size())));
        for (int64_t i = 0; i < frames.size(); ++i) {
            const real_t sample = samples[static_cast<std::size_t>(i)];
            frames[i] = Vector2(sample, sample);
        }
        playback->push_buffer(frames);
    }
}

void HapticVibrationSound::play() {
    ring_->drain([this](const SessionRecord& tick) {
        const bool touches = (tick.proxy_status & proxy_touching) != 0;
        const double depth = touches ? glm::distance(tick.hand, tick.proxy_position) : 0.0;
        feedback_.hear(tick.time, {tick.force, depth}, motors_, sound_);
    });
    const MotorLevels levels = feedback_.take_levels(motors_);
    drive_motors(vibration_ ? levels : MotorLevels{});
    push_sound();
    told_.tell(*this);
}

void HapticVibrationSound::fall_silent() {
    drive_motors({});
    if (player_ != nullptr) {
        player_->queue_free();
        player_ = nullptr;
    }
    feedback_.fall_silent();
}

void HapticVibrationSound::_notification(int what) {
    keep_roll(*this, what);
    if (is_edited()) {
        return;
    }
    if (what == NOTIFICATION_ENTER_TREE) {
        set_process_internal(true);
    } else if (what == NOTIFICATION_EXIT_TREE) {
        fall_silent();
        // The old one is the world's until its loop has let go.
        ring_ = std::make_shared<TickRing>(ring_capacity);
    } else if (what == NOTIFICATION_INTERNAL_PROCESS) {
        play();
    }
}

}  // namespace tactus
