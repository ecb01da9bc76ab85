#include "realtime/tick_trace.hpp"

#include <algorithm>
#include <cinttypes>

#include "platform/clock.hpp"

namespace tactus {

const char* tick_stage_name(TickStage stage) {
    switch (stage) {
        case TickStage::take_commands:
            return "take commands";
        case TickStage::read_device:
            return "read device";
        case TickStage::receive_link:
            return "receive link";
        case TickStage::correct_model:
            return "correct model";
        case TickStage::move_proxy:
            return "move proxy";
        case TickStage::broad_phase:
            return "broad phase";
        case TickStage::narrow_phase:
            return "narrow phase";
        case TickStage::compute_force:
            return "compute force";
        case TickStage::write_device:
            return "write device";
        case TickStage::step_physics:
            return "step physics";
        case TickStage::send_link:
            return "send link";
        case TickStage::publish_snapshot:
            return "publish snapshot";
        case TickStage::append_record:
            return "append record";
        case TickStage::count:
            break;
    }
    return "unknown";
}

void TickTrace::begin_tick(Nanoseconds scheduled, Nanoseconds start) {
    current_.scheduled = scheduled;
    current_.is_stepped = false;
    current_.start = start;
    current_.mark_count = 0;
    current_.stages_lost = 0;
    open_stages_ = 0;
}

void TickTrace::begin_stepped_tick(Nanoseconds world_time, Nanoseconds start) {
    begin_tick(world_time, start);
    current_.is_stepped = true;
}

void TickTrace::end_tick(Nanoseconds end, TickStatus status) {
    current_.end = end;
    current_.status = status;
    records_.append(current_);
}

// A stage is noted only if there is room for its end too, and for the ends of all that is open.
bool TickTrace::begin_stage(TickStage stage) {
    if (current_.mark_count + open_stages_ + 2 > TickRecord::max_marks) {
        ++current_.stages_lost;
        return false;
    }
    mark(stage, true);
    ++open_stages_;
    return true;
}

void TickTrace::end_stage(TickStage stage) {
    mark(stage, false);
    --open_stages_;
}

void TickTrace::mark(TickStage stage, bool begins) {
    const Nanoseconds offset = std::clamp<Nanoseconds>(monotonic_now() - current_.start, 0, UINT32_MAX);
    current_.marks[current_.mark_count] = {static_cast<std::uint32_t>(offset), stage, begins};
    ++current_.mark_count;
}

void TickTrace::drain(std::vector<TickRecord>& into) {
    records_.drain([&into](const TickRecord& record) { into.push_back(record); });
}

namespace {

// Microseconds with three decimals from whole nanoseconds: exact, and the same in every locale.
void write_us(std::FILE* file, const char* key, Nanoseconds time) {
    const char* sign = time < 0 ? "-" : "";
    const Nanoseconds size = time < 0 ? -time : time;
    std::fprintf(file, "\"%s\":%s%" PRId64 ".%03" PRId64, key, sign, size / 1000, size % 1000);
}

void write_slice(std::FILE* file, const char* name, Nanoseconds begin, Nanoseconds duration) {
    std::fprintf(file, ",\n{\"name\":\"%s\",\"cat\":\"haptic\",\"ph\":\"X\",\"pid\":1,\"tid\":1,", name);
    write_us(file, "ts", begin);
    std::fputc(',', file);
    write_us(file, "dur", duration);
}

void write_stages(std::FILE* file, const TickRecord& tick, Nanoseconds tick_begin) {
    std::array<std::uint32_t, TickRecord::max_marks> begins{};  // of the stages that are open, innermost last
    std::size_t depth = 0;
    for (std::size_t i = 0; i < tick.mark_count; ++i) {
        const TickMark& mark = tick.marks[i];
        if (mark.begins) {
            begins[depth] = mark.offset;
            ++depth;
        } else {
            --depth;
            write_slice(file, tick_stage_name(mark.stage), tick_begin + begins[depth],
                        mark.offset - begins[depth]);
            std::fputc('}', file);
        }
    }
}

void write_tick(std::FILE* file, const TickRecord& tick, Nanoseconds origin) {
    write_slice(file, "tick", tick.start - origin, tick.end - tick.start);
    std::fprintf(file, ",\"args\":{\"status\":%" PRIu32 ",\"stages_lost\":%" PRIu32 ",", tick.status,
                 tick.stages_lost);
    write_us(file, "late_us", tick.is_stepped ? 0 : tick.start - tick.scheduled);
    std::fputs("}}", file);
    write_stages(file, tick, tick.start - origin);
}

// Quotes, backslashes and control characters would end the string early or spoil it.
std::string json_safe(std::string text) {
    std::erase_if(text, [](char c) { return c == '"' || c == '\\' || static_cast<unsigned char>(c) < 0x20; });
    return text;
}

}  // namespace

bool write_trace_events(std::FILE* file, std::span<const TickRecord> ticks, Nanoseconds origin,
                        const std::string& thread_name) {
    std::fprintf(file,
                 "[{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":1,\"args\":{\"name\":\"%s\"}}",
                 json_safe(thread_name).c_str());
    for (const TickRecord& tick : ticks) {
        write_tick(file, tick, origin);
    }
    std::fputs("\n]\n", file);
    return std::ferror(file) == 0;
}

}  // namespace tactus
