// How evenly the loop ticks, counted without a lock: the loop adds, anybody reads at any time.
//
// Threads: add() belongs to one thread; everything const may be called by any. Bins are atomics with a single
// writer, so that counting is a plain load and store; a reader may see a tick that is counted in one figure
// and not yet in another.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/math/types.hpp"

namespace tactus {

// Counts of durations in bins of even relative width: 2^14 to an octave. Near 1000 µs a bin is 0.032 µs wide
// (0.064 µs from 1048.6 µs), below 16 µs one nanosecond. Range 0 … 34 s; what is longer is counted in the
// last bin.
class DurationHistogram {
public:
    DurationHistogram();

    void add(Nanoseconds duration);
    void clear();

    std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }
    Nanoseconds min() const;                                                  // exact; 0 when empty
    Nanoseconds max() const { return max_.load(std::memory_order_relaxed); }  // exact; 0 when empty
    double mean() const;                                                      // exact (unit: nanoseconds)

    // The duration that a share of `quantile` (0 … 1) does not exceed, to the width of a bin (unit:
    // nanoseconds).
    double quantile(double quantile) const;

    struct Step {
        double duration;  // (unit: nanoseconds)
        double share;     // of all durations, that do not exceed it: 0 … 1
    };
    // The cumulative distribution: one step for each bin that is not empty.
    std::vector<Step> cumulative() const;

private:
    static constexpr int sub_bits = 14;
    static constexpr int largest_bits = 35;
    static constexpr std::size_t bins = std::size_t{largest_bits - sub_bits + 1} << sub_bits;

    static std::size_t bin_of(Nanoseconds duration);
    static double upper_edge(std::size_t bin);  // the longest duration in it (unit: nanoseconds)

    std::unique_ptr<std::atomic<std::uint32_t>[]> counts_;
    std::atomic<std::uint64_t> count_{0};
    std::atomic<Nanoseconds> sum_{0};
    std::atomic<Nanoseconds> min_{INT64_MAX};
    std::atomic<Nanoseconds> max_{0};
};

// The figures that reports carry (unit: microseconds, but for the counts).
struct TickFigures {
    std::uint64_t ticks = 0;
    double mean_period_us = 0.0;
    double period_p10_us = 0.0;
    double period_p50_us = 0.0;
    double period_p90_us = 0.0;
    double period_p99_us = 0.0;
    double period_p999_us = 0.0;
    double period_max_us = 0.0;
    double lateness_p50_us = 0.0;  // of a tick's start after its deadline
    double lateness_p90_us = 0.0;
    double lateness_p99_us = 0.0;
    double lateness_max_us = 0.0;
    double compute_p50_us = 0.0;
    double compute_p90_us = 0.0;
    double compute_p99_us = 0.0;
    double compute_p999_us = 0.0;
    double compute_max_us = 0.0;
    std::uint64_t missed_deadlines = 0;  // ticks that ended after the next one was due
};

class TickStatistics {
public:
    // One tick. `due_next`: when the next one is due. The period is counted from the second tick on.
    void add(Nanoseconds scheduled, Nanoseconds start, Nanoseconds end, Nanoseconds due_next);

    // Any thread: the loop forgets everything at its next tick, e.g. when a warm-up is over.
    void request_clear() { clear_requested_.store(true, std::memory_order_release); }

    const DurationHistogram& periods() const { return periods_; }    // start to start
    const DurationHistogram& lateness() const { return lateness_; }  // start after deadline
    const DurationHistogram& computes() const { return computes_; }  // start to end
    std::uint64_t missed_deadlines() const { return missed_.load(std::memory_order_relaxed); }

    TickFigures figures() const;

private:
    void clear();

    DurationHistogram periods_;
    DurationHistogram lateness_;
    DurationHistogram computes_;
    std::atomic<std::uint64_t> missed_{0};
    std::atomic<bool> clear_requested_{false};
    Nanoseconds previous_start_ = no_tick_yet;

    static constexpr Nanoseconds no_tick_yet = INT64_MIN;
};

}  // namespace tactus
