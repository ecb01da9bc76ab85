#include "world/rotation.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tactus::rotation_test {
namespace {

TEST(Turns, AreAllWithinARoundAndNoMoreThanThereIsTimeFor) {
    constexpr Turns turns{.frames_a_round = 100, .min = 4, .max = 32};
    EXPECT_EQ(turns.in_a_frame(0), 0u);
    EXPECT_EQ(turns.in_a_frame(3), 3u);
    EXPECT_EQ(turns.in_a_frame(50), 4u);
    EXPECT_EQ(turns.in_a_frame(1000), 10u);
    EXPECT_EQ(turns.in_a_frame(100'000), 32u);
}

TEST(Rotation, EachHasItsTurnOnceARound) {
    constexpr Turns turns{.frames_a_round = 5, .min = 1, .max = 100};
    const std::vector<std::size_t> items{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    std::vector<int> looks(10, 0);
    Rotation rotation;
    for (int frame = 0; frame < 5; ++frame) {
        rotation.take(turns, items, [&looks](std::size_t item) { ++looks[item]; });
    }
    EXPECT_EQ(looks, std::vector<int>(10, 1));
}

TEST(Rotation, GoesOnWhereItemsHaveGone) {
    constexpr Turns turns{.frames_a_round = 1, .min = 1, .max = 3};
    Rotation rotation;
    std::vector<int> seen;
    const auto look = [&seen](int item) { seen.push_back(item); };
    rotation.take(turns, std::vector<int>{1, 2, 3, 4, 5, 6}, look);
    seen.clear();
    rotation.take(turns, std::vector<int>{1, 2}, look);
    EXPECT_EQ(seen.size(), 2u);
    rotation.take(turns, std::vector<int>{}, look);
    EXPECT_EQ(seen.size(), 2u);
}

}  // namespace
}  // namespace tactus::rotation_test
