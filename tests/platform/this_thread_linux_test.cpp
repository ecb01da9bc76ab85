#include "platform/this_thread.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <thread>

namespace tactus::this_thread_linux_test {
namespace {

int processors() {
    cpu_set_t allowed;
    sched_getaffinity(0, sizeof(allowed), &allowed);
    return CPU_COUNT(&allowed);
}

TEST(ThisThreadOnLinux, LeavesOneProcessorOfSeveralAndTakesItBack) {
    const int all = processors();
    std::thread([all] {
        for (int round = 0; round < 2; ++round) {
            keep_off_last_processor(true);
            EXPECT_EQ(processors(), all > 1 ? all - 1 : 1);
            keep_off_last_processor(true);
            EXPECT_EQ(processors(), all > 1 ? all - 1 : 1);
            keep_off_last_processor(false);
            EXPECT_EQ(processors(), all);
        }
    }).join();
    EXPECT_EQ(processors(), all);
}

}  // namespace
}  // namespace tactus::this_thread_linux_test
