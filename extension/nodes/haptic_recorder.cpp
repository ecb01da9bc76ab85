#include "nodes/haptic_recorder.hpp"

#include <filesystem>
#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/classes/project_settings.hpp>

#include "nodes/body_reading.hpp"
#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/proxy_pointer.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "platform/file.hpp"
#include "session/record_csv.hpp"

namespace tactus {

using namespace godot;

namespace {

// Eight seconds at 1 kHz: longer than any pause between two frames that a program survives.
constexpr std::size_t ring_capacity = 8192;

}  // namespace

HapticRecorder::~HapticRecorder() {
    stop();
}

const ProxyPointer* HapticRecorder::proxy_node() const {
    return is_inside_tree() && !proxy_.is_empty() ? Object::cast_to<ProxyPointer>(get_node_or_null(proxy_))
                                                  : nullptr;
}

const Node* HapticRecorder::object_node() const {
    return is_inside_tree() && !object_.is_empty() ? get_node_or_null(object_) : nullptr;
}

String HapticRecorder::problem() const {
    if (proxy_node() == nullptr) {
        return proxy_.is_empty() ? String("it has no proxy: set 'proxy' to a ProxyPointer of the scene")
                                 : "its proxy '" + String(proxy_) +
                                       "' is not a ProxyPointer of the scene: set 'proxy' anew";
    }
    if (!object_.is_empty() && !is_solid_body(object_node())) {
        return "its object '" + String(object_) +
               "' is not a body of the scene: set 'object' anew, or leave it empty";
    }
    return String();
}

PackedStringArray HapticRecorder::_get_configuration_warnings() const {
    PackedStringArray warnings;
    if (is_inside_tree() && !problem().is_empty()) {
        warnings.push_back("This HapticRecorder cannot record all: " + problem() + ".");
    }
    // Without autostart a script starts it, and may set the paths just before.
    if (autostart_ && !has_file()) {
        warnings.push_back(
            "This HapticRecorder writes nothing: set 'csv_path', 'trace_path' or both, or switch 'autostart' "
            "off where a script sets them.");
    }
    return warnings;
}

void HapticRecorder::fail(const String& what) {
    UtilityFunctions::push_warning(name_of(*this), ": ", what, ".");
}

HapticRecorder::File HapticRecorder::open(const String& path) {
    if (path.is_empty()) {
        return nullptr;
    }
    const std::filesystem::path whole = from_godot(ProjectSettings::get_singleton()->globalize_path(path));
    std::error_code ignored;  // opening says whether there is a folder
    std::filesystem::create_directories(whole.parent_path(), ignored);
    File file(open_file(whole, "wb"));
    if (file == nullptr) {
        fail("'" + path + "' cannot be written: choose a folder that exists and may be written to");
    }
    return file;
}

bool HapticRecorder::start() {
    stop();
    rows_ = lost_ = 0;
    ticks_.clear();
    if (!has_file()) {
        fail("it has no file to write: set 'csv_path', 'trace_path' or both before it starts");
        return false;
    }
    csv_ = open(csv_path_);
    trace_file_ = open(trace_path_);
    if (csv_ == nullptr && trace_file_ == nullptr) {
        return false;
    }
    text_ = record_csv_header();
    ring_ = std::make_shared<RecorderRing<SessionRecord>>(ring_capacity);
    return true;
}

void HapticRecorder::stop() {
    if (ring_ == nullptr) {
        return;
    }
    HapticWorld::finish_recording(this);
    write_trace();
    ring_.reset();
    csv_.reset();
    trace_file_.reset();
}

void HapticRecorder::drain(Nanoseconds epoch) {
    if (ring_ == nullptr) {
        return;
    }
    ring_->drain([this, epoch](const SessionRecord& record) {
        append_record_csv(text_, record, epoch);
        ++rows_;
    });
    if (csv_ != nullptr && std::fwrite(text_.data(), 1, text_.size(), csv_.get()) != text_.size()) {
        fail("'" + csv_path_ + "' could not be written to its end: is the disk full?");
        csv_.reset();
    }
    text_.clear();
    if (const std::uint64_t lost = ring_->take_lost(); lost > 0) {
        lost_ += static_cast<int64_t>(lost);
        fail(String::num_uint64(lost) + " ticks were not recorded: the program stood still for too long");
    }
}

void HapticRecorder::drain_trace(TickTrace& trace) {
    if (trace_file_ == nullptr) {
        return;
    }
    trace.drain(ticks_);
    const auto since_start = [this](const TickRecord& tick) {
        return to_seconds(tick.scheduled - ticks_.front().scheduled);
    };
    while (!ticks_.empty() && since_start(ticks_.back()) > trace_seconds_) {
        ticks_.pop_back();
    }
}

void HapticRecorder::write_trace() {
    if (trace_file_ == nullptr) {
        return;
    }
    const Nanoseconds origin = ticks_.empty() ? 0 : ticks_.front().start;
    if (!write_trace_events(trace_file_.get(), ticks_, origin, "haptic loop")) {
        fail("'" + trace_path_ + "' could not be written to its end: is the disk full?");
    }
    ticks_.clear();
}

void HapticRecorder::_notification(int what) {
    if (Engine::get_singleton()->is_editor_hint()) {
        if (what == NOTIFICATION_ENTER_TREE) {
            watch_warnings(*this);
        }
        return;
    }
    if (what == NOTIFICATION_ENTER_TREE) {
        Roll<HapticRecorder>::enter(this);
        if (autostart_ && has_file()) {
            start();
        }
    } else if (what == NOTIFICATION_EXIT_TREE) {
        stop();
        Roll<HapticRecorder>::leave(this);
    }
}

}  // namespace tactus
