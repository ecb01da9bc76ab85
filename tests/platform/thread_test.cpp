#include "platform/thread.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace tactus::thread_test {
namespace {

TEST(Thread, RunsElsewhereAndIsWaitedFor) {
    Thread thread;
    for (int round = 0; round < 3; ++round) {
        std::thread::id id;
        ASSERT_EQ(
            thread.start(
                "tactus-test",
                [](void* seen) { *static_cast<std::thread::id*>(seen) = std::this_thread::get_id(); }, &id),
            "");
        thread.join();
        EXPECT_NE(id, std::thread::id());
        EXPECT_NE(id, std::this_thread::get_id());
    }
}

TEST(Thread, JoiningNoneDoesNothing) {
    Thread thread;
    thread.join();
    SUCCEED();
}

}  // namespace
}  // namespace tactus::thread_test
