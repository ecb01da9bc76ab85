#include "realtime/tick_statistics.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus {

namespace {

constexpr auto relaxed = std::memory_order_relaxed;

// For a value with one writer: no locked instruction.
template <typename T>
void raise(std::atomic<T>& value, T by) {
    value.store(value.load(relaxed) + by, relaxed);
}

double to_us(double nanoseconds) {
    return nanoseconds * 1e-3;
}

}  // namespace

DurationHistogram::DurationHistogram() : counts_(std::make_unique<std::atomic<std::uint32_t>[]>(bins)) {}

// A duration below 2^14 ns is its own bin. Above, with 2^m <= d < 2^(m+1), the leading 15 bits of d name the
// bin.
std::size_t DurationHistogram::bin_of(Nanoseconds duration) {
    const auto d = static_cast<std::uint64_t>(std::max<Nanoseconds>(duration, 0));
    const int octave = std::max(static_cast<int>(std::bit_width(d)) - 1 - sub_bits, 0);
    const std::size_t bin =
        (static_cast<std::size_t>(octave) << sub_bits) + static_cast<std::size_t>(d >> octave);
    return std::min(bin, bins - 1);
}

double DurationHistogram::upper_edge(std::size_t bin) {
    constexpr std::size_t per_octave = std::size_t{1} << sub_bits;
    if (bin < per_octave) {
        return static_cast<double>(bin);
    }
    const std::size_t octave = bin / per_octave - 1;
    const std::size_t leading = bin % per_octave + per_octave;
    return static_cast<double>(((leading + 1) << octave) - 1);
}

void DurationHistogram::add(Nanoseconds duration) {
    raise(counts_[bin_of(duration)], 1u);
    raise(sum_, duration);
    min_.store(std::min(min_.load(relaxed), duration), relaxed);
    max_.store(std::max(max_.load(relaxed), duration), relaxed);
    raise(count_, std::uint64_t{1});
}

// Only where something was counted: the loop does this between two ticks.
void DurationHistogram::clear() {
    if (count() == 0) {
        return;
    }
    const std::size_t last = bin_of(max_.load(relaxed));
    for (std::size_t bin = bin_of(min_.load(relaxed)); bin <= last; ++bin) {
        counts_[bin].store(0, relaxed);
    }
    count_.store(0, relaxed);
    sum_.store(0, relaxed);
    min_.store(INT64_MAX, relaxed);
    max_.store(0, relaxed);
}

Nanoseconds DurationHistogram::min() const {
    return count() == 0 ? 0 : min_.load(relaxed);
}

double DurationHistogram::mean() const {
    const std::uint64_t n = count();
    return n == 0 ? 0.0 : static_cast<double>(sum_.load(relaxed)) / static_cast<double>(n);
}

double DurationHistogram::quantile(double quantile) const {
    const double wanted = std::max(1.0, std::ceil(quantile * static_cast<double>(count())));
    std::uint64_t seen = 0;
    for (std::size_t bin = 0; bin < bins; ++bin) {
        seen += counts_[bin].load(relaxed);
        if (static_cast<double>(seen) >= wanted) {
            return std::min(upper_edge(bin), static_cast<double>(max()));
        }
    }
    return static_cast<double>(max());
}

std::vector<DurationHistogram::Step> DurationHistogram::cumulative() const {
    std::vector<Step> steps;
    const auto total = static_cast<double>(count());
    std::uint64_t seen = 0;
    for (std::size_t bin = 0; bin < bins; ++bin) {
        const std::uint32_t here = counts_[bin].load(relaxed);
        if (here > 0) {
            seen += here;
            steps.push_back({std::min(upper_edge(bin), static_cast<double>(max())),
                             std::min(static_cast<double>(seen) / total, 1.0)});
        }
    }
    return steps;
}

void TickStatistics::add(Nanoseconds scheduled, Nanoseconds start, Nanoseconds end, Nanoseconds due_next) {
    if (clear_requested_.load(relaxed) && clear_requested_.exchange(false, std::memory_order_acquire)) {
        clear();
    }
    if (previous_start_ != no_tick_yet) {
        periods_.add(start - previous_start_);
    }
    previous_start_ = start;
    lateness_.add(start - scheduled);
    computes_.add(end - start);
    if (end > due_next) {
        raise(missed_, std::uint64_t{1});
    }
}

void TickStatistics::clear() {
    periods_.clear();
    lateness_.clear();
    computes_.clear();
    missed_.store(0, relaxed);
    previous_start_ = no_tick_yet;
}

TickFigures TickStatistics::figures() const {
    TickFigures figures;
    figures.ticks = computes_.count();
    figures.mean_period_us = to_us(periods_.mean());
    figures.period_p10_us = to_us(periods_.quantile(0.1));
    figures.period_p50_us = to_us(periods_.quantile(0.5));
    figures.period_p90_us = to_us(periods_.quantile(0.9));
    figures.period_p99_us = to_us(periods_.quantile(0.99));
    figures.period_p999_us = to_us(periods_.quantile(0.999));
    figures.period_max_us = to_us(static_cast<double>(periods_.max()));
    figures.lateness_p50_us = to_us(lateness_.quantile(0.5));
    figures.lateness_p90_us = to_us(lateness_.quantile(0.9));
    figures.lateness_p99_us = to_us(lateness_.quantile(0.99));
    figures.lateness_max_us = to_us(static_cast<double>(lateness_.max()));
    figures.compute_p50_us = to_us(computes_.quantile(0.5));
    figures.compute_p90_us = to_us(computes_.quantile(0.9));
    figures.compute_p99_us = to_us(computes_.quantile(0.99));
    figures.compute_p999_us = to_us(computes_.quantile(0.999));
    figures.compute_max_us = to_us(static_cast<double>(computes_.max()));
    figures.missed_deadlines = missed_deadlines();
    return figures;
}

}  // namespace tactus
