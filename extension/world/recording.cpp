#include "world/recording.hpp"

#include <utility>

#include "session/record_csv.hpp"

namespace tactus {

namespace {

// Eight seconds at 1 kHz: longer than any pause between two frames that a program survives.
constexpr std::size_t ring_capacity = 8192;

std::string cut_short(const std::string& path) {
    return "'" + path + "' could not be written to its end: is the disk full?";
}

}  // namespace

std::unique_ptr<Recording> Recording::open(const RecordingFiles& files, const Say& say) {
    std::unique_ptr<Recording> recording(new Recording(files, say));
    return recording->csv_ != nullptr || recording->trace_ != nullptr ? std::move(recording) : nullptr;
}

Recording::Recording(const RecordingFiles& files, const Say& say)
    : files_(files),
      say_(say),
      ring_(std::make_shared<Ring>(ring_capacity)),
      csv_(create(files.csv)),
      trace_(create(files.trace)),
      text_(record_csv_header()) {}

OpenFile Recording::create(const std::string& path) const {
    if (path.empty()) {
        return nullptr;
    }
    make_folder_of(path);
    OpenFile file(open_file(path, "wb"));
    if (file == nullptr) {
        say_("'" + path + "' cannot be written: choose a folder that exists and may be written to");
    }
    return file;
}

void Recording::close() {
    if (!std::exchange(is_open_, false)) {
        return;
    }
    const Nanoseconds origin = ticks_.empty() ? 0 : ticks_.front().start;
    if (trace_ != nullptr && !write_trace_events(trace_.get(), ticks_, origin, "haptic loop")) {
        say_(cut_short(files_.trace));
    }
    csv_.reset();
    trace_.reset();
}

void Recording::drain(Nanoseconds epoch) {
    ring_->drain([this, epoch](const SessionRecord& record) {
        append_record_csv(text_, record, epoch);
        ++rows_;
    });
    if (csv_ != nullptr && std::fwrite(text_.data(), 1, text_.size(), csv_.get()) != text_.size()) {
        say_(cut_short(files_.csv));
        csv_.reset();
    }
    text_.clear();
    if (const std::uint64_t lost = ring_->take_lost(); lost > 0) {
        lost_ += lost;
        say_(std::to_string(lost) + " ticks were not recorded: the program stood still for too long");
    }
}

void Recording::drain(TickTrace& trace) {
    if (trace_ == nullptr) {
        return;
    }
    trace.drain(ticks_);
    const auto since_start = [this](const TickRecord& tick) {
        return to_seconds(tick.scheduled - ticks_.front().scheduled);
    };
    while (!ticks_.empty() && since_start(ticks_.back()) > files_.trace_seconds) {
        ticks_.pop_back();
    }
}

}  // namespace tactus
