#include "sensing/recording/recorded_frames.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>

#include "platform/clock.hpp"

namespace tactus {

namespace {

constexpr Nanoseconds millisecond = 1'000'000;

}  // namespace

bool is_recording_path(const std::string& uri) {
    return uri.ends_with(".oni") || uri.ends_with(".ONI");
}

std::string RecordedFrames::open(const std::string& path, const Playback::Choice& choice) {
    name_ = "the recording '" + path + "'";
    const auto refused = [this](const std::string& why) {
        return name_ + " cannot be played: " + why + "; name another one";
    };
    errno = 0;
    file_.open(path, std::ios::binary);
    std::error_code ignored;
    if (!file_ || std::filesystem::is_directory(path, ignored)) {
        return refused(errno != 0 ? std::strerror(errno) : "it cannot be read");
    }
    if (const std::string wrong = read_oni(file_, recording_); !wrong.empty()) {
        return refused(wrong);
    }
    std::vector<std::uint64_t> times;
    for (const OniFrame& frame : recording_.frames) {
        times.push_back(frame.time_us);
    }
    playback_.emplace(std::move(times), choice);
    return "";
}

FrameSource::Reading RecordedFrames::read(DepthImage& image, int wait_ms) {
    if (!playback_) {
        return Reading::lost;
    }
    const Nanoseconds until = monotonic_now() + wait_ms * millisecond;
    std::optional<std::size_t> number = playback_->next(monotonic_now());
    while (!number && !playback_->has_ended() && monotonic_now() < until) {
        const Nanoseconds wait = std::min(until, playback_->due()) - monotonic_now();
        std::this_thread::sleep_for(std::chrono::nanoseconds(std::max<Nanoseconds>(wait, 0)));
        number = playback_->next(monotonic_now());
    }
    if (!number) {
        return playback_->has_ended() ? Reading::ended : Reading::nothing;
    }
    if (read_oni_frame(file_, recording_, *number, memory_, image)) {
        return Reading::frame;
    }
    trouble_ = name_ + " is damaged at image " + std::to_string(*number + 1) + ": name another one";
    return Reading::damaged;
}

}  // namespace tactus
