#include "realtime/tick_trace.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <thread>

#include "platform/clock.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::tick_trace_test {
namespace {

// One tick with a stage inside a stage, recorded by the real clock.
void record_tick(TickTrace& trace, Nanoseconds scheduled) {
    trace.begin_tick(scheduled, monotonic_now());
    {
        const TraceScope outer(&trace, TickStage::move_proxy);
        const TraceScope inner(&trace, TickStage::narrow_phase);
    }
    const TraceScope last(&trace, TickStage::compute_force);
}

std::string written(std::span<const TickRecord> ticks, Nanoseconds origin, const std::string& name) {
    std::FILE* file = std::tmpfile();
    EXPECT_TRUE(write_trace_events(file, ticks, origin, name));
    std::string text(static_cast<std::size_t>(std::ftell(file)), '\0');
    std::rewind(file);
    EXPECT_EQ(std::fread(text.data(), 1, text.size(), file), text.size());
    std::fclose(file);
    return text;
}

TEST(TickTrace, KeepsTheTickAndItsStagesInOrder) {
    TickTrace trace(4);
    record_tick(trace, 5'000);
    trace.end_tick(monotonic_now(), 6);
    std::vector<TickRecord> ticks;
    trace.drain(ticks);
    ASSERT_EQ(ticks.size(), 1u);
    const TickRecord& tick = ticks[0];
    EXPECT_EQ(tick.scheduled, 5'000);
    EXPECT_EQ(tick.status, 6u);
    ASSERT_EQ(tick.mark_count, 6u);
    const TickStage order[] = {TickStage::move_proxy, TickStage::narrow_phase,  TickStage::narrow_phase,
                               TickStage::move_proxy, TickStage::compute_force, TickStage::compute_force};
    const bool begins[] = {true, true, false, false, true, false};
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(tick.marks[i].stage, order[i]);
        EXPECT_EQ(tick.marks[i].begins, begins[i]);
        EXPECT_LE(tick.start + tick.marks[i].offset, tick.end);
        EXPECT_TRUE(i == 0 || tick.marks[i].offset >= tick.marks[i - 1].offset);
    }
}

TEST(TickTrace, ATickWithTooManyStagesKeepsWholePairsAndCountsTheRest) {
    TickTrace trace(1);
    trace.begin_tick(0, monotonic_now());
    {
        const TraceScope outer(&trace, TickStage::move_proxy);
        for (std::size_t i = 0; i < TickRecord::max_marks; ++i) {
            const TraceScope inner(&trace, TickStage::narrow_phase);
        }
    }
    trace.end_tick(monotonic_now(), 0);
    std::vector<TickRecord> ticks;
    trace.drain(ticks);
    ASSERT_EQ(ticks.size(), 1u);
    constexpr std::size_t inner_kept = (TickRecord::max_marks - 2) / 2;
    EXPECT_EQ(ticks[0].mark_count, 2 + 2 * inner_kept);
    EXPECT_EQ(ticks[0].stages_lost, TickRecord::max_marks - inner_kept);
    EXPECT_EQ(ticks[0].marks[ticks[0].mark_count - 1].stage, TickStage::move_proxy);
    EXPECT_FALSE(ticks[0].marks[ticks[0].mark_count - 1].begins);
}

TEST(TickTrace, TicksThatFindNoRoomAreCounted) {
    TickTrace trace(2);
    for (int i = 0; i < 5; ++i) {
        trace.begin_tick(0, 0);
        trace.end_tick(1, 0);
    }
    EXPECT_EQ(trace.take_lost(), 3u);
}

TEST(TickTrace, ANullTraceRecordsNothing) {
    const TraceScope scope(nullptr, TickStage::move_proxy);
    SUCCEED();
}

TEST(TickTrace, RecordingNeitherAllocatesNorLocks) {
    TickTrace trace(4);
    testing::AuditScope audit;
    for (int i = 0; i < 6; ++i) {
        record_tick(trace, i);
        trace.end_tick(monotonic_now(), 0);
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.locks() + audit.system_calls(), 0u) << audit.describe();
}

TEST(TickTrace, EveryStageHasAName) {
    for (int i = 0; i < static_cast<int>(TickStage::count); ++i) {
        EXPECT_STRNE(tick_stage_name(static_cast<TickStage>(i)), "unknown");
    }
}

TEST(WriteTraceEvents, WritesNestedSlicesInMicroseconds) {
    TickRecord tick;
    tick.scheduled = 1'000'000;
    tick.start = 1'012'500;
    tick.end = 1'042'501;
    tick.mark_count = 4;
    tick.marks[0] = {1'000, TickStage::move_proxy, true};
    tick.marks[1] = {2'000, TickStage::broad_phase, true};
    tick.marks[2] = {2'250, TickStage::broad_phase, false};
    tick.marks[3] = {9'000, TickStage::move_proxy, false};
    const std::string text = written(std::span(&tick, 1), 1'000'000, "haptic \"1\"");
    const std::string expected =
        R"([{"name":"thread_name","ph":"M","pid":1,"tid":1,"args":{"name":"haptic 1"}},
{"name":"tick","cat":"haptic","ph":"X","pid":1,"tid":1,"ts":12.500,"dur":30.001,"args":{"status":0,"stages_lost":0,"late_us":12.500}},
{"name":"broad phase","cat":"haptic","ph":"X","pid":1,"tid":1,"ts":14.500,"dur":0.250},
{"name":"move proxy","cat":"haptic","ph":"X","pid":1,"tid":1,"ts":13.500,"dur":8.000}
]
)";
    EXPECT_EQ(text, expected);
}

// The world's time is not the machine's: their difference was the machine's uptime.
TEST(WriteTraceEvents, NoTickOfASteppedWorldIsLate) {
    TickTrace trace(4);
    trace.begin_stepped_tick(3'000'000, 87'000'000'000'000);
    trace.end_tick(87'000'000'020'000, 0);
    trace.begin_tick(87'000'001'000'000, 87'000'001'004'000);
    trace.end_tick(87'000'001'020'000, 0);
    std::vector<TickRecord> ticks;
    trace.drain(ticks);
    const std::string text = written(ticks, 87'000'000'000'000, "loop");
    EXPECT_NE(text.find("\"dur\":20.000,\"args\":{\"status\":0,\"stages_lost\":0,\"late_us\":0.000}"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("\"late_us\":4.000}"), std::string::npos) << text;
}

TEST(WriteTraceEvents, NoTicksAreAnArrayAllTheSame) {
    EXPECT_EQ(written({}, 0, "x"),
              "[{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":1,\"args\":{\"name\":\"x\"}}\n]\n");
}

TEST(WriteTraceEvents, ATimeBeforeTheOriginIsNegative) {
    TickRecord tick;
    tick.start = -1'500;
    tick.scheduled = -1'500;
    EXPECT_NE(written(std::span(&tick, 1), 0, "x").find("\"ts\":-1.500,\"dur\":1.500"), std::string::npos);
}

}  // namespace
}  // namespace tactus::tick_trace_test
