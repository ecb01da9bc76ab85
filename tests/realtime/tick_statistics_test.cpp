#include "realtime/tick_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/realtime_audit.hpp"

namespace tactus::tick_statistics_test {
namespace {

constexpr Nanoseconds us = 1'000;
constexpr Nanoseconds ms = 1'000'000;

TEST(DurationHistogram, EmptyIsAllZero) {
    const DurationHistogram histogram;
    EXPECT_EQ(histogram.count(), 0u);
    EXPECT_EQ(histogram.min(), 0);
    EXPECT_EQ(histogram.max(), 0);
    EXPECT_EQ(histogram.mean(), 0.0);
    EXPECT_EQ(histogram.quantile(0.5), 0.0);
    EXPECT_TRUE(histogram.cumulative().empty());
}

TEST(DurationHistogram, MinMaxAndMeanAreExact) {
    DurationHistogram histogram;
    histogram.add(999'937);
    histogram.add(1'000'063);
    histogram.add(1'000'001);
    EXPECT_EQ(histogram.min(), 999'937);
    EXPECT_EQ(histogram.max(), 1'000'063);
    EXPECT_DOUBLE_EQ(histogram.mean(), 3'000'001.0 / 3.0);
}

TEST(DurationHistogram, AQuantileIsWithinATenthOfAMicrosecondNearOneMillisecond) {
    for (Nanoseconds duration = 900 * us; duration <= 1200 * us; duration += 9'973) {
        DurationHistogram histogram;
        histogram.add(duration);
        histogram.add(10 * ms);  // so that the maximum does not give the answer away
        const double median = histogram.quantile(0.5);
        EXPECT_GE(median, static_cast<double>(duration));
        EXPECT_LE(median, static_cast<double>(duration) + 100.0);
    }
}

TEST(DurationHistogram, QuantilesAgreeWithSortingToTheWidthOfABin) {
    std::mt19937 random(7);
    std::lognormal_distribution<double> spread(std::log(1e6), 1.0);
    DurationHistogram histogram;
    std::vector<Nanoseconds> all;
    for (int i = 0; i < 5000; ++i) {
        all.push_back(static_cast<Nanoseconds>(spread(random)));
        histogram.add(all.back());
    }
    std::sort(all.begin(), all.end());
    for (const double q : {0.001, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0}) {
        const auto rank = static_cast<std::size_t>(std::ceil(q * 5000.0)) - 1;
        const auto exact = static_cast<double>(all[rank]);
        EXPECT_GE(histogram.quantile(q), exact);
        EXPECT_LE(histogram.quantile(q), exact * (1.0 + 1.0 / 16384.0) + 1.0);
    }
}

TEST(DurationHistogram, EndsOfTheRangeAreHeld) {
    DurationHistogram histogram;
    histogram.add(0);
    histogram.add(-5);
    histogram.add(100 * nanoseconds_per_second);
    EXPECT_EQ(histogram.count(), 3u);
    EXPECT_EQ(histogram.quantile(0.6), 0.0);
    EXPECT_EQ(histogram.max(), 100 * nanoseconds_per_second);
}

TEST(DurationHistogram, TheCumulativeDistributionRisesToOne) {
    DurationHistogram histogram;
    histogram.add(1 * ms);
    histogram.add(1 * ms);
    histogram.add(2 * ms);
    histogram.add(4 * ms);
    const auto steps = histogram.cumulative();
    ASSERT_EQ(steps.size(), 3u);
    EXPECT_DOUBLE_EQ(steps[0].share, 0.5);
    EXPECT_DOUBLE_EQ(steps[1].share, 0.75);
    EXPECT_DOUBLE_EQ(steps[2].share, 1.0);
    EXPECT_DOUBLE_EQ(steps[2].duration, 4e6);
}

TEST(DurationHistogram, ClearForgets) {
    DurationHistogram histogram;
    histogram.add(1 * ms);
    histogram.add(30 * ms);
    histogram.clear();
    EXPECT_EQ(histogram.count(), 0u);
    histogram.add(2 * ms);
    EXPECT_EQ(histogram.cumulative().size(), 1u);
    EXPECT_EQ(histogram.max(), 2 * ms);
}

TEST(TickStatistics, APeriodRunsFromStartToStart) {
    TickStatistics statistics;
    statistics.add(0, 10 * us, 60 * us, 1 * ms);
    EXPECT_EQ(statistics.periods().count(), 0u);
    statistics.add(1 * ms, 1 * ms + 30 * us, 1 * ms + 50 * us, 2 * ms);
    EXPECT_EQ(statistics.periods().count(), 1u);
    EXPECT_EQ(statistics.periods().max(), 1020 * us);
    EXPECT_EQ(statistics.computes().max(), 50 * us);
    EXPECT_EQ(statistics.lateness().max(), 30 * us);
}

TEST(TickStatistics, ADeadlineIsMissedByEndingAfterTheNextIsDue) {
    TickStatistics statistics;
    statistics.add(0, 0, 1 * ms, 1 * ms);
    EXPECT_EQ(statistics.missed_deadlines(), 0u);
    statistics.add(1 * ms, 1 * ms, 2 * ms + 1, 2 * ms);
    EXPECT_EQ(statistics.missed_deadlines(), 1u);
}

TEST(TickStatistics, TheMeanPeriodIsExactOverALateTick) {
    TickStatistics statistics;
    const Nanoseconds starts[] = {
        0, 1 * ms, 5 * ms, 5 * ms + 40 * us, 5 * ms + 80 * us, 5 * ms + 120 * us, 6 * ms};
    for (Nanoseconds k = 0; k < 7; ++k) {
        statistics.add(k * ms, starts[k], starts[k] + 30 * us, (k + 1) * ms);
    }
    EXPECT_DOUBLE_EQ(statistics.figures().mean_period_us, 1000.0);
}

TEST(TickStatistics, AClearTakesEffectAtTheNextTickAndCountsNoPeriodAcrossIt) {
    TickStatistics statistics;
    statistics.add(0, 0, 10, ms);
    statistics.add(ms, ms, ms + 10, 2 * ms);
    statistics.request_clear();
    EXPECT_EQ(statistics.periods().count(), 1u);
    statistics.add(50 * ms, 50 * ms, 50 * ms + 10, 51 * ms);
    EXPECT_EQ(statistics.periods().count(), 0u);
    EXPECT_EQ(statistics.figures().ticks, 1u);
}

TEST(TickStatistics, CountingNeitherAllocatesNorLocks) {
    TickStatistics statistics;
    testing::AuditScope audit;
    for (Nanoseconds k = 0; k < 100; ++k) {
        statistics.add(k * ms, k * ms + 20 * us, k * ms + 70 * us, (k + 1) * ms);
    }
    statistics.request_clear();
    statistics.add(100 * ms, 100 * ms, 100 * ms, 101 * ms);
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.locks() + audit.system_calls(), 0u) << audit.describe();
}

}  // namespace
}  // namespace tactus::tick_statistics_test
