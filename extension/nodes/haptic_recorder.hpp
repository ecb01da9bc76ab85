#pragma once

#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <memory>

#include "nodes/node_state.hpp"
#include "nodes/properties.hpp"
#include "world/recording.hpp"

namespace tactus {

// Writes down every tick of one proxy. The loop puts rows into a ring; the main thread writes them to the
// file.
class HapticRecorder : public godot::Node {
    GDCLASS(HapticRecorder, godot::Node)

public:
    HapticRecorder() = default;
    ~HapticRecorder() override;

    enum State { STATE_OFF, STATE_FAILED, STATE_WAITING, STATE_WORKING };

    TACTUS_PROPERTIES(HapticRecorder)

    State get_state() const;
    godot::String get_state_text() const;
    godot::PackedStringArray get_problems() const;
    bool start();
    void stop();
    bool is_recording() const { return recording_ != nullptr && recording_->is_open(); }
    int64_t get_rows() const { return recording_ != nullptr ? static_cast<int64_t>(recording_->rows()) : 0; }
    int64_t get_lost_rows() const {
        return recording_ != nullptr ? static_cast<int64_t>(recording_->lost()) : 0;
    }

    godot::String get_problem() const {
        return recording_ != nullptr ? to_godot(recording_->problem()) : not_started_;
    }
    godot::PackedStringArray _get_configuration_warnings() const override;

    // --- for the world that is recorded

    const godot::Node3D* hand_node() const;  // a ProxyPointer or a HapticTool; null: none
    const godot::Node* object_node() const;
    godot::String problem() const;  // empty where there is none
    void tell_state() { told_.tell(*this); }
    const std::shared_ptr<Recording>& recording() const { return recording_; }

protected:
    static void _bind_methods();
    void _notification(int what);

private:
    bool open();
    static void start_late();  // those whose file is set by now
    void close();
    bool has_file() const { return !(csv_path_.is_empty() && trace_path_.is_empty()); }

    godot::NodePath proxy_;
    godot::NodePath object_;
    godot::String csv_path_;
    godot::String trace_path_;
    double trace_seconds_ = 15.0;
    bool autostart_ = true;

    godot::String not_started_;             // why the last start opened no file
    std::shared_ptr<Recording> recording_;  // the last one, when it has ended; null: none yet
    ToldState<State> told_;
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::HapticRecorder::State);
