// What every system says in the same words.
#include "platform/realtime_thread.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace tactus::realtime_thread_test {
namespace {

// In a thread of its own, so that the test's thread keeps its scheduling.
RealtimeReport granted(const RealtimeRequest& request) {
    RealtimeReport report;
    std::thread([&] {
        report = make_thread_realtime(request);
        release_realtime(report);
    }).join();
    return report;
}

TEST(RealtimeThread, WhatIsGrantedOrRefusedIsSaid) {
    const RealtimeReport report = granted({});
    EXPECT_EQ(report.text.find("Scheduling: ordinary") == std::string::npos, report.fifo) << report.text;
    EXPECT_EQ(report.text.find("Memory: not locked") == std::string::npos, report.memory_locked)
        << report.text;
    EXPECT_EQ(
        report.text.find("Processor: number " + std::to_string(report.cpu) + " only") == std::string::npos,
        report.cpu == any_processor)
        << report.text;
}

TEST(RealtimeThread, NothingAskedForIsNothingTaken) {
    RealtimeRequest request;
    request.fifo_priority = 0;
    request.lock_memory = false;
    request.cpu = any_processor;
    const RealtimeReport report = granted(request);
    EXPECT_FALSE(report.fifo);
    EXPECT_FALSE(report.memory_locked);
    EXPECT_EQ(report.cpu, any_processor);
    EXPECT_NE(report.text.find("as asked for"), std::string::npos);
}

// An ordinary thread on one processor would have to queue behind whatever runs there.
TEST(RealtimeThread, AnOrdinaryThreadIsNotBound) {
    RealtimeRequest request;
    request.fifo_priority = 0;
    request.cpu = 0;
    EXPECT_EQ(granted(request).cpu, any_processor);
}

TEST(RealtimeThread, AProcessorThatIsNotThereIsRefusedInWords) {
    for (const int cpu : {1023, 5000}) {
        RealtimeRequest request;
        request.cpu = cpu;
        const RealtimeReport report = granted(request);
        EXPECT_EQ(report.cpu, any_processor);
        EXPECT_NE(report.text.find("Processor: any; "), std::string::npos) << report.text;
    }
}

}  // namespace
}  // namespace tactus::realtime_thread_test
