// What each tick spent its time on: begin and end of its stages, drained off the loop and written as
// trace-event JSON.
//
// Threads: begin_tick(), end_tick() and TraceScope belong to the haptic thread; drain() and take_lost() to
// one other. A mark is one reading of the clock (about 25 ns). A session holds a pointer to a TickTrace: null
// where nobody records.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "core/math/types.hpp"
#include "realtime/recorder_ring.hpp"
#include "realtime/tick_status.hpp"

namespace tactus {

// The steps of one tick, in the order in which a session takes them; they may nest.
enum class TickStage : std::uint8_t {
    take_commands,
    read_device,
    receive_link,
    correct_model,
    move_proxy,
    broad_phase,
    narrow_phase,
    compute_force,
    write_device,
    step_physics,
    send_link,
    publish_snapshot,
    append_record,
    count
};

const char* tick_stage_name(TickStage stage);

struct TickMark {
    std::uint32_t offset = 0;  // since the tick's start (unit: nanoseconds)
    TickStage stage = TickStage::count;
    bool begins = false;  // false: the stage ends
};

struct TickRecord {
    static constexpr std::size_t max_marks = 64;

    Nanoseconds scheduled = 0;
    bool is_stepped = false;  // `scheduled` is no time of the clock that `start` and `end` are of
    Nanoseconds start = 0;
    Nanoseconds end = 0;
    TickStatus status = 0;
    std::uint32_t mark_count = 0;
    std::uint32_t stages_lost = 0;            // for which `marks` had no room
    std::array<TickMark, max_marks> marks{};  // in the order of time; stages nest properly
};

class TickTrace {
public:
    // Room for `capacity` ticks between two drains.
    explicit TickTrace(std::size_t capacity) : records_(capacity) {}

    // `scheduled` and `start` by the same clock.
    void begin_tick(Nanoseconds scheduled, Nanoseconds start);
    // Of a world whose time passes when it is told to: `world_time` is no time of a clock, and no tick is
    // late.
    void begin_stepped_tick(Nanoseconds world_time, Nanoseconds start);
    void end_tick(Nanoseconds end, TickStatus status);

    // Appends what has been recorded since the last call.
    void drain(std::vector<TickRecord>& into);
    std::uint64_t take_lost() { return records_.take_lost(); }

private:
    friend class TraceScope;

    bool begin_stage(TickStage stage);
    void end_stage(TickStage stage);
    void mark(TickStage stage, bool begins);

    RecorderRing<TickRecord> records_;
    TickRecord current_;
    std::uint32_t open_stages_ = 0;
};

// One stage, from construction to the end of the block. Does nothing with a null trace.
class TraceScope {
public:
    TraceScope(TickTrace* trace, TickStage stage)
        : trace_(trace != nullptr && trace->begin_stage(stage) ? trace : nullptr), stage_(stage) {}
    ~TraceScope() {
        if (trace_ != nullptr) {
            trace_->end_stage(stage_);
        }
    }
    TraceScope(const TraceScope&) = delete;
    TraceScope& operator=(const TraceScope&) = delete;

private:
    TickTrace* trace_;
    TickStage stage_;
};

// Chrome's trace-event array: one "X" slice for each tick and, inside it, for each stage; ts and dur in
// microseconds since `origin`. Opens in Perfetto. False when the file could not be written.
bool write_trace_events(std::FILE* file, std::span<const TickRecord> ticks, Nanoseconds origin,
                        const std::string& thread_name);

}  // namespace tactus
