#include "sensing/recording/playback.hpp"

#include <algorithm>
#include <utility>

namespace tactus {

namespace {

// Between two images, whatever their times say. Who has not asked for longer than the largest goes on from
// where he was (unit: nanoseconds).
constexpr std::uint64_t least_gap = 1'000'000, largest_gap = 1'000'000'000;

// Where the times do not tell: of a camera of 30 Hz (unit: microseconds).
constexpr std::uint64_t usual_gap_us = 33'333;

}  // namespace

Playback::Playback(std::vector<std::uint64_t> times, const Choice& choice)
    : times_(std::move(times)), choice_(choice) {}

Nanoseconds Playback::gap(std::size_t before, std::size_t after) const {
    const bool is_told = before < after && times_[before] < times_[after];
    const std::uint64_t us = is_told ? times_[after] - times_[before] : usual_gap_us;
    return static_cast<Nanoseconds>(
        std::clamp(std::min(us, largest_gap / 1000) * 1000, least_gap, largest_gap));
}

void Playback::go_on() {
    const std::size_t before = next_++;
    if (next_ == times_.size() && choice_.repeats) {
        next_ = 0;
    }
    if (!has_ended()) {
        due_ += gap(before, next_);
    }
}

std::optional<std::size_t> Playback::next(Nanoseconds now) {
    if (has_ended()) {
        return std::nullopt;
    }
    if (!std::exchange(has_begun_, true) || now - due_ > static_cast<Nanoseconds>(largest_gap)) {
        due_ = now;
    }
    if (choice_.as_fast_as_read) {
        due_ = now;
    }
    if (now < due_) {
        return std::nullopt;
    }
    std::size_t shown = next_;
    go_on();
    while (!choice_.as_fast_as_read && !has_ended() && due_ <= now) {
        shown = next_;
        go_on();
    }
    return shown;
}

}  // namespace tactus
