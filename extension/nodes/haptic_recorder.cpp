#include "nodes/haptic_recorder.hpp"

#include <godot_cpp/classes/node3d.hpp>

#include "nodes/body_reading.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/proxy_pointer.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/tree_walk.hpp"
#include "nodes/whole_path.hpp"

namespace tactus {

using namespace godot;

HapticRecorder::~HapticRecorder() {
    stop();
}

const ProxyPointer* HapticRecorder::proxy_node() const {
    return node_at<ProxyPointer>(*this, proxy_);
}

const Node* HapticRecorder::object_node() const {
    return node_at<Node>(*this, object_);
}

String HapticRecorder::problem() const {
    if (proxy_.is_empty()) {
        return "it has no proxy: set 'proxy' to a ProxyPointer of the scene";
    }
    if (proxy_node() == nullptr) {
        return wrong_path("proxy", proxy_, "a ProxyPointer");
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

bool HapticRecorder::start() {
    stop();
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

void HapticRecorder::stop() {
    if (is_recording()) {
        HapticWorld::finish_recording(*this);
        recording_->close();
    }
}

void HapticRecorder::_notification(int what) {
    keep_roll(*this, what);
    if (what == NOTIFICATION_ENTER_TREE && autostart_ && has_file() && !is_edited()) {
        start();
    } else if (what == NOTIFICATION_EXIT_TREE) {
        stop();
    }
}

}  // namespace tactus
