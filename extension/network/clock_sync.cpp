#include "network/clock_sync.hpp"

#include <algorithm>
#include <cmath>

namespace tactus {
namespace {

// No two working clocks part faster; what does has been set.
constexpr double fastest_drift = 1e-3;

// Of timestamps taken by a thread that shares its processor: a contradiction by less proves nothing.
constexpr Nanoseconds stamp_error = 20'000;

// Two points give a line, three a hint whether to believe it.
constexpr std::size_t least_points_for_drift = 3;

constexpr double smoothing = 1.0 / 16.0;  // as RFC 3550 does for jitter

Nanoseconds to_nanoseconds(double value) {
    return static_cast<Nanoseconds>(std::llround(value));
}

// The most that two clocks drift apart in that time.
Nanoseconds most_drift(Nanoseconds span) {
    return to_nanoseconds(fastest_drift * static_cast<double>(std::abs(span)));
}

}  // namespace

bool ClockSync::add(const ClockExchange& exchange) {
    if (exchange.t3 < exchange.t0 || exchange.t2 < exchange.t1 || exchange.delay() < 0) {
        ++figures_.refused;
        return false;
    }
    const Kept sample{exchange.t0 + (exchange.t3 - exchange.t0) / 2, exchange.offset(), exchange.delay()};
    if (count_ > 0 && contradicts(sample)) {
        start_anew();
        ++figures_.jumps;
    }
    keep(sample);
    fit_line();
    note_bounds(sample);
    note_delay(sample.delay);
    figures_.known = true;
    ++figures_.exchanges;
    figures_.drift = drift_;
    figures_.least_delay = best().delay;
    figures_ = figures_at(sample.here);
    return true;
}

ClockFigures ClockSync::figures_at(Nanoseconds here) const {
    ClockFigures now = figures_;
    if (now.known) {
        now.offset = offset_at(here);
        now.uncertainty = std::max(most_ - now.offset, now.offset - least_) + most_drift(here - last_);
    }
    return now;
}

// The true offset is within half its delay of what each exchange says, and drifts by a bounded amount since.
void ClockSync::note_bounds(const Kept& newest) {
    last_ = newest.here;
    least_ = newest.offset - newest.delay / 2;
    most_ = newest.offset + newest.delay / 2;
    for (std::size_t i = 0; i < count_; ++i) {
        const Nanoseconds room = kept_[i].delay / 2 + most_drift(last_ - kept_[i].here);
        least_ = std::max(least_, kept_[i].offset - room);
        most_ = std::min(most_, kept_[i].offset + room);
    }
}

void ClockSync::forget() {
    start_anew();
    figures_ = {};
}

void ClockSync::start_anew() {
    count_ = 0;
    drift_ = 0.0;
    anchor_ = {};
}

Nanoseconds ClockSync::near_time(Nanoseconds far) const {
    const Nanoseconds since_anchor = far - anchor_.offset - anchor_.here;  // on the far clock
    return anchor_.here + since_anchor -
           to_nanoseconds(static_cast<double>(since_anchor) * (drift_ / (1.0 + drift_)));
}

Nanoseconds ClockSync::offset_at(Nanoseconds here) const {
    return anchor_.offset + to_nanoseconds(drift_ * static_cast<double>(here - anchor_.here));
}

// The exchange says that the offset is within half its delay of its own figure, and the kept ones say the
// same of theirs. Where the two ranges do not meet, even with the clocks drifting apart meanwhile, a clock
// was set.
bool ClockSync::contradicts(const Kept& sample) const {
    const Kept& newest = kept_[newest_];
    if (sample.here < newest.here - stretch_) {
        return true;
    }
    const Nanoseconds drifted = most_drift(sample.here - anchor_.here);
    const Nanoseconds room = sample.delay / 2 + best().delay / 2 + drifted + stamp_error;
    return std::abs(sample.offset - offset_at(sample.here)) > room;
}

void ClockSync::keep(const Kept& sample) {
    if (count_ > 0 && sample.here - stretch_began_ < stretch_) {
        if (sample.delay <= kept_[newest_].delay) {
            kept_[newest_] = sample;
        }
        return;
    }
    newest_ = count_ == 0 ? 0 : (newest_ + 1) % max_kept;
    count_ = std::min(count_ + 1, max_kept);
    kept_[newest_] = sample;
    stretch_began_ = sample.here;
}

// The least delay there is; the newest of several.
const ClockSync::Kept& ClockSync::best() const {
    const Kept* found = &kept_[newest_];
    for (std::size_t back = 1; back < count_; ++back) {
        const Kept& kept = kept_[(newest_ + max_kept - back) % max_kept];
        found = kept.delay < found->delay ? &kept : found;
    }
    return *found;
}

// Weighted least squares of offset over time. An exchange that took longer than the best one by d may be
// wrong by d / 2, so it weighs 1 / d² as soon as d is above the error of the stamps themselves.
void ClockSync::fit_line() {
    const Kept& reference = best();
    anchor_ = reference;
    if (count_ < least_points_for_drift) {
        drift_ = 0.0;
        return;
    }
    double sum = 0.0, sum_t = 0.0, sum_o = 0.0, sum_tt = 0.0, sum_to = 0.0;
    for (std::size_t i = 0; i < count_; ++i) {
        const double error = static_cast<double>(kept_[i].delay - reference.delay + stamp_error);
        const double weight = 1.0 / (error * error);
        const double t = static_cast<double>(kept_[i].here - reference.here);
        const double o = static_cast<double>(kept_[i].offset - reference.offset);
        sum += weight;
        sum_t += weight * t;
        sum_o += weight * o;
        sum_tt += weight * t * t;
        sum_to += weight * t * o;
    }
    const double spread = sum * sum_tt - sum_t * sum_t;
    if (!(spread > 0.0)) {
        drift_ = 0.0;
        return;
    }
    drift_ = std::clamp((sum * sum_to - sum_t * sum_o) / spread, -fastest_drift, fastest_drift);
    anchor_.offset += to_nanoseconds((sum_o - drift_ * sum_t) / sum);
}

void ClockSync::note_delay(Nanoseconds delay) {
    const auto now = static_cast<double>(delay);
    if (!figures_.known) {
        figures_.mean_delay = now;
    } else {
        const double change = std::abs(now - static_cast<double>(figures_.latest_delay));
        figures_.jitter += smoothing * (change - figures_.jitter);
        figures_.mean_delay += smoothing * (now - figures_.mean_delay);
    }
    figures_.latest_delay = delay;
}

}  // namespace tactus
