#pragma once

#include <cstdio>
#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/variant/node_path.hpp>
#include <memory>
#include <string>
#include <vector>

#include "nodes/properties.hpp"
#include "realtime/recorder_ring.hpp"
#include "realtime/tick_trace.hpp"
#include "session/session_types.hpp"

namespace tactus {

class ProxyPointer;

// Writes down every tick of one proxy. The loop puts rows into a ring; the main thread writes them to the
// file.
class HapticRecorder : public godot::Node {
    GDCLASS(HapticRecorder, godot::Node)

public:
    HapticRecorder() = default;
    ~HapticRecorder() override;

    TACTUS_PROPERTIES(HapticRecorder)

    bool start();
    void stop();
    bool is_recording() const { return ring_ != nullptr; }
    int64_t get_rows() const { return rows_; }
    int64_t get_lost_rows() const { return lost_; }

    godot::PackedStringArray _get_configuration_warnings() const override;

    // --- for the world that is recorded

    bool wants_trace() const { return !trace_path_.is_empty(); }
    const ProxyPointer* proxy_node() const;
    const godot::Node* object_node() const;
    godot::String problem() const;  // empty where there is none
    std::shared_ptr<RecorderRing<SessionRecord>> ring() const { return ring_; }
    // `epoch`: the zero of the session's clock, on the clock whose microseconds the file shows.
    void drain(Nanoseconds epoch);
    void drain_trace(TickTrace& trace);

protected:
    static void _bind_methods();
    void _notification(int what);

private:
    struct FileCloser {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    using File = std::unique_ptr<std::FILE, FileCloser>;

    bool has_file() const { return !(csv_path_.is_empty() && trace_path_.is_empty()); }
    File open(const godot::String& path);
    void write_trace();
    void fail(const godot::String& what);

    godot::NodePath proxy_;
    godot::NodePath object_;
    godot::String csv_path_;
    godot::String trace_path_;
    double trace_seconds_ = 15.0;
    bool autostart_ = true;

    std::shared_ptr<RecorderRing<SessionRecord>> ring_;  // null while nothing is recorded
    File csv_;
    File trace_file_;
    std::string text_;
    std::vector<TickRecord> ticks_;
    int64_t rows_ = 0;
    int64_t lost_ = 0;
};

}  // namespace tactus
