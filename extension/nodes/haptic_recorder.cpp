#include "nodes/haptic_recorder.hpp"

#include <godot_cpp/variant/callable_method_pointer.hpp>

#include <godot_cpp/classes/node3d.hpp>

#include "nodes/body_reading.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/proxy_choice.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/tree_walk.hpp"
#include "nodes/whole_path.hpp"

namespace tactus {

using namespace godot;

HapticRecorder::~HapticRecorder() {
    close();
}

const Node3D* HapticRecorder::hand_node() const {
    const auto* named = node_at<Node3D>(*this, proxy_);
    return is_hand(named) ? named : nullptr;
}

const Node* HapticRecorder::object_node() const {
    return node_at<Node>(*this, object_);
}

String HapticRecorder::problem() const {
    if (proxy_.is_empty()) {
        return "it has no proxy: set 'proxy' to a ProxyPointer or a HapticTool of the scene";
    }
    if (hand_node() == nullptr) {
        return wrong_path("proxy", proxy_, "a ProxyPointer or a HapticTool");
    }
    return object_.is_empty() || is_solid_body(object_node())
               ? String()
               : wrong_path("object", object_, "a body") + ", or leave it empty";
}

PackedStringArray HapticRecorder::_get_configuration_warnings() const {
    PackedStringArray warnings;
    if (is_inside_tree()) {
        warn(warnings, "This HapticRecorder records nothing", problem_without_world(*this));
        warn(warnings, "This HapticRecorder cannot record all", problem());
    }
    // Without autostart a script starts it, and may set the paths just before.
    if (autostart_ && !has_file()) {
        warn(warnings, "This HapticRecorder writes nothing",
             "set 'csv_path', 'trace_path' or both, or switch 'autostart' off where a script sets them");
    }
    return warnings;
}

PackedStringArray HapticRecorder::get_problems() const {
    PackedStringArray problems = _get_configuration_warnings();
    if (const String last = get_problem(); !last.is_empty()) {
        problems.push_back(last);
    }
    return problems;
}

HapticRecorder::State HapticRecorder::get_state() const {
    if (!get_problem().is_empty()) {
        return STATE_FAILED;
    }
    return state_of<State>(is_recording() && !problem().is_empty(), is_recording() && get_rows() > 0,
                           is_recording());
}

String HapticRecorder::get_state_text() const {
    if (const String last = get_problem(); !last.is_empty()) {
        return last;
    }
    switch (get_state()) {
        case STATE_OFF:
            return recording_ == nullptr ? String("off")
                                         : "ended, with " + String::num_int64(get_rows()) + " rows";
        case STATE_FAILED:
            return problem();
        case STATE_WAITING:
            return HapticWorld::of(this) == nullptr ? "no HapticWorld is running above this node"
                                                    : "waits for a tick of its proxy";
        case STATE_WORKING:
            return "recording";
    }
    return String();
}

bool HapticRecorder::start() {
    const bool has_begun = open();
    tell_state();
    return has_begun;
}

bool HapticRecorder::open() {
    close();
    recording_.reset();
    not_started_ = String();
    const auto say = [this](const std::string& what) {
        not_started_ = to_godot(what);
        UtilityFunctions::push_warning(name_of(*this), ": ", to_godot(what), ".");
    };
    if (!has_file()) {
        say("it has no file to write: set 'csv_path', 'trace_path' or both before it starts");
        return false;
    }
    recording_ = Recording::open({whole_path(csv_path_), whole_path(trace_path_), trace_seconds_}, say);
    return recording_ != nullptr;
}

void HapticRecorder::start_late() {
    for (HapticRecorder* const recorder : Roll<HapticRecorder>::all()) {
        const bool is_new = recorder->recording_ == nullptr && recorder->not_started_.is_empty();
        if (is_new && recorder->autostart_ && recorder->has_file()) {
            recorder->start();
        }
    }
}

void HapticRecorder::stop() {
    close();
    tell_state();
}

void HapticRecorder::close() {
    if (is_recording()) {
        HapticWorld::finish_recording(*this);
        recording_->close();
    }
}

void HapticRecorder::_notification(int what) {
    keep_roll(*this, what);
    if (what == NOTIFICATION_ENTER_TREE && autostart_ && !is_edited()) {
        if (has_file()) {
            start();
        } else {  // a script may set it in the same frame
            callable_mp_static(&HapticRecorder::start_late).call_deferred();
        }
    } else if (what == NOTIFICATION_EXIT_TREE) {
        stop();
    }
}

}  // namespace tactus
