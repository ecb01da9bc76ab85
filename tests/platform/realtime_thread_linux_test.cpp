#include "platform/realtime_thread.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

#include <thread>

namespace tactus::realtime_thread_linux_test {
namespace {

// In a thread of its own, so that the test's thread keeps its scheduling.
template <typename Check>
void with_granted(const RealtimeRequest& request, Check&& check) {
    std::thread([&] {
        const RealtimeReport report = make_thread_realtime(request);
        check(report);
        release_realtime(report);
    }).join();
}

TEST(RealtimeThreadOnLinux, TheReportSaysWhatIsInForce) {
    with_granted({}, [](const RealtimeReport& report) {
        int policy = 0;
        sched_param parameters{};
        pthread_getschedparam(pthread_self(), &policy, &parameters);
        EXPECT_EQ(policy, report.fifo ? SCHED_FIFO : SCHED_OTHER);
        EXPECT_EQ(parameters.sched_priority, report.fifo_priority);
        EXPECT_NE(report.text.find(report.fifo ? "SCHED_FIFO, priority" : "was refused"), std::string::npos);
        EXPECT_NE(report.text.find(report.memory_locked ? "Memory: locked" : "Memory: not locked"),
                  std::string::npos);
    });
}

TEST(RealtimeThreadOnLinux, AnImpossiblePriorityIsRefusedInWords) {
    RealtimeRequest request;
    request.fifo_priority = 1000;
    with_granted(request, [](const RealtimeReport& report) {
        EXPECT_FALSE(report.fifo);
        EXPECT_NE(report.text.find("SCHED_FIFO 1000 was refused"), std::string::npos);
    });
}

TEST(RealtimeThreadOnLinux, BindsToTheProcessorAskedForOnceItComesFirstThere) {
    RealtimeRequest request;
    request.cpu = sched_getcpu();
    with_granted(request, [&](const RealtimeReport& report) {
        if (!report.fifo) {
            EXPECT_EQ(report.cpu, any_processor);
            return;
        }
        EXPECT_EQ(report.cpu, request.cpu);
        EXPECT_EQ(sched_getcpu(), request.cpu);
    });
}

TEST(RealtimeThreadOnLinux, WhereIdlingIsRefusedNothingIsChanged) {
    std::thread([] {
        EXPECT_FALSE(become_idle_on(max_processors - 1));
        int policy = 0;
        sched_param parameters{};
        pthread_getschedparam(pthread_self(), &policy, &parameters);
        EXPECT_EQ(policy, SCHED_OTHER);
    }).join();
}

}  // namespace
}  // namespace tactus::realtime_thread_linux_test
