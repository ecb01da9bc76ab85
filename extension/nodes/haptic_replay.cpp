#include "nodes/haptic_replay.hpp"

#include <godot_cpp/core/error_macros.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

#include "nodes/whole_path.hpp"

namespace tactus {

using namespace godot;

namespace {

constexpr double max_seconds = 1e6;

}  // namespace

bool HapticReplay::open(const String& inputs_path, const String& csv_path) {
    is_over_ = false;
    std::string error;
    player_ = InputPlayer::open(whole_path(inputs_path), whole_path(csv_path), error);
    if (player_ == nullptr) {
        UtilityFunctions::push_error("HapticReplay: ", to_godot(error), ".");
    }
    return player_ != nullptr;
}

InputReplay::Report HapticReplay::report() const {
    if (player_ == nullptr) {
        return {};
    }
    InputReplay::Report found = player_->report();
    found.problem = found.problem.empty() ? player_->rows_problem() : found.problem;
    return found;
}

// A recording stands still where the world did: it is the number of ticks that counts.
int64_t HapticReplay::play(double seconds) {
    ERR_FAIL_COND_V_MSG(!(seconds >= 0.0 && seconds <= max_seconds), 0,
                        "The time to play must be between 0 and 1,000,000 s.");
    if (is_over()) {
        return 0;
    }
    const std::uint64_t before = report().ticks;
    const Nanoseconds end = player_->now() + from_seconds(seconds);
    while (!is_over_ && player_->now() < end) {
        is_over_ = !player_->play(1);
    }
    return static_cast<int64_t>(report().ticks - before);
}

}  // namespace tactus
