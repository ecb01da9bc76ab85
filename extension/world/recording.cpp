#include "world/recording.hpp"

#include <utility>

#include "session/record_csv.hpp"

namespace tactus {

namespace {

// Eight seconds at 1 kHz: longer than any pause between two frames that a program survives.
constexpr std::size_t ring_capacity = 8192;

}  // namespace

std::unique_ptr<Recording> Recording::open(const RecordingFiles& files, const Say& say) {
    std::unique_ptr<Recording> recording(new Recording(files, say));
    return recording->csv_ || recording->trace_ ? std::move(recording) : nullptr;
}

Recording::Recording(const RecordingFiles& files, const Say& say)
    : trace_seconds_(files.trace_seconds),
      say_(say),
      ring_(std::make_shared<Ring>(ring_capacity)),
      text_(record_csv_header()) {
    if (!files.csv.empty()) {
        complain(csv_.open(files.csv));
    }
    if (!files.trace.empty()) {
        complain(trace_.open(files.trace));
    }
}

void Recording::complain(const std::string& what) {
    if (!what.empty()) {
        problem_ = problem_.empty() ? what : problem_;
        say_(what);
    }
}

void Recording::close() {
    if (!std::exchange(is_open_, false)) {
        return;
    }
    const Nanoseconds origin = ticks_.empty() ? 0 : ticks_.front().start;
    if (trace_ && !write_trace_events(trace_.get(), ticks_, origin, "haptic loop")) {
        complain(trace_.cut_short());
    }
    complain(csv_.close());
    complain(trace_.close());
}

void Recording::drain(Nanoseconds epoch) {
    ring_->drain([this, epoch](const SessionRecord& record) {
        append_record_csv(text_, record, epoch);
        ++rows_;
    });
    if (csv_ && std::fwrite(text_.data(), 1, text_.size(), csv_.get()) != text_.size()) {
        complain(csv_.cut_short());
        csv_.close();
    }
    text_.clear();
    if (const std::uint64_t lost = ring_->take_lost(); lost > 0) {
        lost_ += lost;
        complain(std::to_string(lost) + " ticks were not recorded: the program stood still for too long");
    }
}

void Recording::drain(TickTrace& trace) {
    if (!trace_) {
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

}  // namespace tactus
