#include "platform/atomic_wait.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace tactus::atomic_wait_test {
namespace {

// Each waits for the other's count; a wake that is lost leaves both waiting for good.
TEST(AtomicWait, NoWakeIsLost) {
    constexpr std::int64_t rounds = 20'000;
    std::atomic<std::int64_t> asked{0}, answered{0};
    std::thread other([&] {
        for (std::int64_t i = 0; i < rounds; ++i) {
            wait_while(asked, i);
            answered.store(i + 1);
            wake_all(answered);
        }
    });
    for (std::int64_t i = 0; i < rounds; ++i) {
        asked.store(i + 1);
        wake_all(asked);
        wait_while(answered, i);
    }
    other.join();
    EXPECT_EQ(answered, rounds);
}

TEST(AtomicWait, AllWhoWaitAreWoken) {
    std::atomic<bool> goes_on{false};
    std::atomic<int> gone_on{0};
    std::thread waiting[4];
    for (std::thread& thread : waiting) {
        thread = std::thread([&] {
            wait_while(goes_on, false);
            ++gone_on;
        });
    }
    goes_on = true;
    wake_all(goes_on);
    for (std::thread& thread : waiting) {
        thread.join();
    }
    EXPECT_EQ(gone_on, 4);
}

TEST(AtomicWait, WhatHasChangedAlreadyIsNotWaitedFor) {
    const std::atomic<std::int64_t> value{2};
    wait_while(value, 1);
    EXPECT_EQ(value, 2);
}

}  // namespace
}  // namespace tactus::atomic_wait_test
