#include "platform/held_by_threads.hpp"

#include <gtest/gtest.h>

namespace tactus::held_by_threads_test {
namespace {

std::string granted(bool) {
    return {};
}

TEST(HeldByThreads, TheLastGivesItBack) {
    HeldByThreads memory;
    int given_back = 0;
    const auto give_back = [&given_back] { ++given_back; };
    EXPECT_EQ(memory.hold(granted), "");
    EXPECT_EQ(memory.hold(granted), "");
    memory.let_go(give_back);
    EXPECT_EQ(given_back, 0);
    memory.let_go(give_back);
    EXPECT_EQ(given_back, 1);
}

TEST(HeldByThreads, WhoWasRefusedHoldsNothing) {
    HeldByThreads memory;
    int given_back = 0;
    EXPECT_EQ(memory.hold([](bool) { return std::string("no room"); }), "no room");
    EXPECT_EQ(memory.hold(granted), "");
    memory.let_go([&given_back] { ++given_back; });
    EXPECT_EQ(given_back, 1);
}

TEST(HeldByThreads, TheFirstIsToldSo) {
    HeldByThreads memory;
    const auto is_first = [&memory] {
        bool first = false;
        memory.hold([&first](bool told) {
            first = told;
            return std::string();
        });
        return first;
    };
    EXPECT_TRUE(is_first());
    EXPECT_FALSE(is_first());
    memory.let_go([] {});
    memory.let_go([] {});
    EXPECT_TRUE(is_first());
}

}  // namespace
}  // namespace tactus::held_by_threads_test
