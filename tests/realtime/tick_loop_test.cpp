#include "realtime/tick_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "platform/clock.hpp"
#include "realtime/baseline_loop.hpp"
#include "realtime/thread_role.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::tick_loop_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;

// What one loop's ticks leave behind, written by the loop's thread and read after `done`.
struct Log {
    std::size_t wanted = 0;
    std::vector<Nanoseconds> scheduled{};
    bool in_haptic_role = true;
    std::size_t stall_at = SIZE_MAX;
    Nanoseconds stall = 0;
    std::atomic<bool> done{false};
};

TickStatus log_tick(void* context, Nanoseconds scheduled) {
    Log& log = *static_cast<Log*>(context);
    if (log.scheduled.size() == log.wanted) {
        return 0;
    }
    log.in_haptic_role = log.in_haptic_role && HapticRole::held();
    if (log.scheduled.size() == log.stall_at) {
        const Nanoseconds until = monotonic_now() + log.stall;
        while (monotonic_now() < until) {
        }
    }
    log.scheduled.push_back(scheduled);
    log.done = log.scheduled.size() == log.wanted;
    return 0;
}

void run_until_done(const TickLoopSettings& settings, Log& log, TickLoop& loop, TickTrace* trace = nullptr) {
    log.scheduled.reserve(log.wanted);
    ASSERT_EQ(loop.start(settings, &log_tick, &log, trace), "");
    while (!log.done) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    loop.stop();
}

TEST(TickLoop, ScheduledTimesRiseByExactlyOnePeriodWhateverTheMachineDoes) {
    TickLoopSettings settings;
    settings.rebase_after = 3600 * nanoseconds_per_second;
    Log log{.wanted = 200};
    TickLoop loop;
    run_until_done(settings, log, loop);
    for (std::size_t k = 1; k < log.scheduled.size(); ++k) {
        ASSERT_EQ(log.scheduled[k] - log.scheduled[k - 1], ms);
    }
}

TEST(TickLoop, DeadlinesLieOnTheGridOfThePeriodPlusThePhase) {
    TickLoopSettings settings;
    settings.phase = 250'000;
    Log log{.wanted = 3};
    TickLoop loop;
    run_until_done(settings, log, loop);
    EXPECT_EQ(log.scheduled[0] % ms, 250'000);
}

TEST(TickLoop, NoTickIsSkippedByAStall) {
    TickLoopSettings settings;
    settings.rebase_after = 3600 * nanoseconds_per_second;
    Log log{.wanted = 60, .stall_at = 10, .stall = 20 * ms};
    TickLoop loop;
    run_until_done(settings, log, loop);
    EXPECT_EQ(log.scheduled.back() - log.scheduled.front(), 59 * ms);
    EXPECT_NE(loop.take_status() & tick_late, 0u);
    EXPECT_EQ(loop.time_lost(), 0);
    EXPECT_GE(loop.statistics().missed_deadlines(), 1u);
}

TEST(TickLoop, AStallTooLongToCatchUpMovesTheScheduleAndIsReported) {
    TickLoopSettings settings;
    settings.rebase_after = 10 * ms;
    Log log{.wanted = 20, .stall_at = 10, .stall = 30 * ms};
    TickLoop loop;
    run_until_done(settings, log, loop);
    EXPECT_GT(log.scheduled[11] - log.scheduled[10], 10 * ms);
    EXPECT_NE(loop.take_status() & tick_rebased, 0u);
    EXPECT_GT(loop.time_lost(), 10 * ms);
}

TEST(TickLoop, TheTickRunsInTheHapticRole) {
    Log log{.wanted = 5};
    TickLoop loop;
    run_until_done({}, log, loop);
    EXPECT_TRUE(log.in_haptic_role);
    EXPECT_FALSE(HapticRole::held());
}

TickStatus report_own_bits(void* context, Nanoseconds) {
    auto& count = *static_cast<std::atomic<int>*>(context);
    return 1u << std::min(count.fetch_add(1), 2);
}

TEST(TickLoop, StatusBitsAddUpUntilTheyAreTaken) {
    std::atomic<int> count{0};
    TickLoop loop;
    ASSERT_EQ(loop.start({}, &report_own_bits, &count), "");
    while (loop.ticks() < 3) {
        std::this_thread::yield();
    }
    loop.stop();
    constexpr TickStatus own_bits = (1u << 24) - 1;
    EXPECT_EQ(loop.take_status() & own_bits, 7u);
    EXPECT_EQ(loop.take_status(), 0u);
}

TEST(TickLoop, StopsAndStartsAgainWithFreshFigures) {
    TickLoop loop;
    for (int round = 0; round < 3; ++round) {
        Log log{.wanted = 4};
        run_until_done({}, log, loop);
        EXPECT_FALSE(loop.running());
        EXPECT_GE(loop.ticks(), 4u);
        EXPECT_EQ(loop.statistics().computes().count(), loop.ticks());
        EXPECT_EQ(loop.statistics().periods().count(), loop.ticks() - 1);
    }
}

TEST(TickLoop, StoppingTwiceOrUnstartedDoesNothing) {
    TickLoop loop;
    loop.stop();
    Log log{.wanted = 1};
    run_until_done({}, log, loop);
    loop.stop();
    EXPECT_FALSE(loop.running());
}

TEST(TickLoop, TheDestructorStopsARunningLoop) {
    Log log{.wanted = 2};
    log.scheduled.reserve(2);
    {
        TickLoop loop;
        ASSERT_EQ(loop.start({}, &log_tick, &log), "");
    }
    SUCCEED();
}

TEST(TickLoop, RefusesToStartTwiceOrWithoutAPeriodAndSaysSo) {
    TickLoop loop;
    Log log;
    TickLoopSettings settings;
    settings.period = 0;
    EXPECT_NE(loop.start(settings, &log_tick, &log), "");
    EXPECT_FALSE(loop.running());
    ASSERT_EQ(loop.start({}, &log_tick, &log), "");
    EXPECT_NE(loop.start({}, &log_tick, &log), "");
    loop.stop();
}

TEST(TickLoop, SaysWhatTheSystemGranted) {
    TickLoop loop;
    Log log{.wanted = 1};
    run_until_done({}, log, loop);
    EXPECT_NE(loop.realtime_report().text.find("Scheduling:"), std::string::npos);
    EXPECT_NE(loop.realtime_report().text.find("Memory:"), std::string::npos);
}

TEST(TickLoop, TracesEachTick) {
    TickTrace trace(64);
    Log log{.wanted = 5};
    TickLoop loop;
    run_until_done({}, log, loop, &trace);
    std::vector<TickRecord> ticks;
    trace.drain(ticks);
    ASSERT_GE(ticks.size(), 5u);
    for (std::size_t k = 0; k < 5; ++k) {
        EXPECT_EQ(ticks[k].scheduled, log.scheduled[k]);
        EXPECT_GE(ticks[k].start, ticks[k].scheduled);
        EXPECT_GE(ticks[k].end, ticks[k].start);
    }
}

// The scope opens in one tick and closes in a later one: between them lies the loop itself, with its
// counting, its trace and its sleep.
struct LoopAudit {
    std::unique_ptr<testing::AuditScope> scope{};
    std::atomic<int> ticks{0};
};

TickStatus audit_tick(void* context, Nanoseconds) {
    auto& audit = *static_cast<LoopAudit*>(context);
    const int tick = audit.ticks;
    if (tick == 5) {
        audit.scope = std::make_unique<testing::AuditScope>();
    }
    if (tick == 105) {
        audit.scope->finish();
    }
    audit.ticks = tick + 1;
    return 1;
}

TEST(TickLoop, TheLoopItselfOnlySleeps) {
    for (const Nanoseconds spin_limit : {0, 50'000}) {
        TickLoopSettings settings;
        settings.sleep.spin_limit = spin_limit;
        LoopAudit audit;
        TickTrace trace(16);
        const testing::LockAudit locks;
        TickLoop loop;
        ASSERT_EQ(loop.start(settings, &audit_tick, &audit, &trace), "");
        while (audit.ticks < 106) {
            loop.take_status();
            std::this_thread::yield();
        }
        loop.stop();
        EXPECT_EQ(audit.scope->allocations(), 0u) << audit.scope->describe();
        EXPECT_EQ(audit.scope->frees(), 0u);
        EXPECT_EQ(audit.scope->locks(), 0u);
        EXPECT_EQ(audit.scope->waits(), 0u);
        for (const long number : audit.scope->system_call_numbers()) {
            EXPECT_TRUE(testing::AuditScope::is_sleep(number)) << number;
        }
        EXPECT_TRUE(locks.shared_locks().empty());
    }
}

TEST(BaselineLoop, TicksBesideTheMeasuredLoopAndCountsItsOwn) {
    TickLoopSettings settings;
    BaselineLoop baseline;
    ASSERT_EQ(baseline.start(settings), "");
    Log log{.wanted = 50};
    TickLoop loop;
    run_until_done(settings, log, loop);
    baseline.stop();
    EXPECT_GE(baseline.statistics().periods().count(), 1u);
}

}  // namespace
}  // namespace tactus::tick_loop_test
