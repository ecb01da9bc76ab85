#include "world/recording.hpp"

#include <filesystem>
#include <set>
#include <utility>

#include "session/record_csv.hpp"

namespace tactus {

namespace {

// Eight seconds at 1 kHz: longer than any pause between two frames that a program survives.
constexpr std::size_t ring_capacity = 8192;

std::string cut_short(const std::string& path) {
    return "'" + path + "' could not be written to its end: is the disk full?";
}

// The files of all recordings that are open: two would write over each other.
std::set<std::string>& paths_in_use() {
    static std::set<std::string> paths;
    return paths;
}

// The same for the same file, however its path is written.
std::string name_of_file(const std::string& path) {
    std::error_code ignored;
    const std::u8string given(path.begin(), path.end());
    const std::filesystem::path whole = std::filesystem::weakly_canonical(given, ignored);
    const std::u8string name = ignored ? given : whole.u8string();
    return {name.begin(), name.end()};
}

}  // namespace

std::unique_ptr<Recording> Recording::open(const RecordingFiles& files, const Say& say) {
    std::unique_ptr<Recording> recording(new Recording(files, say));
    return recording->csv_ != nullptr || recording->trace_ != nullptr ? std::move(recording) : nullptr;
}

Recording::Recording(const RecordingFiles& files, const Say& say)
    : files_(files), say_(say), ring_(std::make_shared<Ring>(ring_capacity)), text_(record_csv_header()) {
    csv_ = create(files.csv);
    trace_ = create(files.trace);
}

OpenFile Recording::create(const std::string& path) {
    if (path.empty()) {
        return nullptr;
    }
    make_folder_of(path);
    if (!paths_in_use().insert(name_of_file(path)).second) {
        complain("'" + path + "' is being written by another recording: choose another path");
        return nullptr;
    }
    OpenFile file(open_file(path, "wb"));
    if (file == nullptr) {
        paths_in_use().erase(name_of_file(path));
        complain("'" + path + "' cannot be written: choose a folder that exists and may be written to");
    }
    return file;
}

// What the system still holds is written now, or never.
void Recording::close_file(OpenFile& file, const std::string& path) {
    if (file == nullptr) {
        return;
    }
    if (std::fclose(file.release()) != 0) {
        complain(cut_short(path));
    }
    paths_in_use().erase(name_of_file(path));
}

void Recording::complain(const std::string& what) {
    problem_ = problem_.empty() ? what : problem_;
    say_(what);
}

void Recording::close() {
    if (!std::exchange(is_open_, false)) {
        return;
    }
    const Nanoseconds origin = ticks_.empty() ? 0 : ticks_.front().start;
    if (trace_ != nullptr && !write_trace_events(trace_.get(), ticks_, origin, "haptic loop")) {
        complain(cut_short(files_.trace));
    }
    close_file(csv_, files_.csv);
    close_file(trace_, files_.trace);
}

void Recording::drain(Nanoseconds epoch) {
    ring_->drain([this, epoch](const SessionRecord& record) {
        append_record_csv(text_, record, epoch);
        ++rows_;
    });
    if (csv_ != nullptr && std::fwrite(text_.data(), 1, text_.size(), csv_.get()) != text_.size()) {
        complain(cut_short(files_.csv));
        close_file(csv_, files_.csv);
    }
    text_.clear();
    if (const std::uint64_t lost = ring_->take_lost(); lost > 0) {
        lost_ += lost;
        complain(std::to_string(lost) + " ticks were not recorded: the program stood still for too long");
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
