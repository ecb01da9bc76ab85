#include "sensing/watch/lasting_thread.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace tactus::lasting_thread_test {
namespace {

std::thread::id thread_of_one() {
    std::thread::id id;
    LastingThread thread([&] { id = std::this_thread::get_id(); });
    thread.join();
    return id;
}

TEST(LastingThread, IsKeptForTheNextWhoNeedsIt) {
    const std::thread::id first = thread_of_one();
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(thread_of_one(), first);
    }
}

TEST(LastingThread, ThoseAtOnceAreSeveral) {
    std::atomic<bool> ends{false};
    std::thread::id one, other;
    const auto until_the_end = [&](std::thread::id& id) {
        return [&ends, &id] {
            id = std::this_thread::get_id();
            ends.wait(false);
        };
    };
    LastingThread first(until_the_end(one)), second(until_the_end(other));
    ends = true;
    ends.notify_all();
    first.join();
    second.join();
    EXPECT_NE(one, other);
}

}  // namespace
}  // namespace tactus::lasting_thread_test
