#include "sensing/recording/playback.hpp"

#include <gtest/gtest.h>

namespace tactus::playback_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;
constexpr std::optional<std::size_t> none;

TEST(Playback, ShowsEachImageWhenItsTimeHasCome) {
    Playback played({1000, 34'000, 67'000}, {.repeats = false});
    EXPECT_EQ(played.next(500 * ms), 0u);
    EXPECT_EQ(played.due(), 533 * ms);
    EXPECT_EQ(played.next(532 * ms), none);
    EXPECT_EQ(played.next(533 * ms), 1u);
    EXPECT_EQ(played.next(566 * ms), 2u);
    EXPECT_TRUE(played.has_ended());
    EXPECT_EQ(played.next(600 * ms), none);
}

TEST(Playback, DropsWhatIsOverByNow) {
    Playback played({0, 10'000, 20'000, 30'000, 40'000}, {.repeats = false});
    EXPECT_EQ(played.next(0), 0u);
    EXPECT_EQ(played.next(34 * ms), 3u);
    EXPECT_EQ(played.next(40 * ms), 4u);
}

TEST(Playback, BeginsAgain) {
    Playback played({50'000, 60'000}, {.repeats = true});
    EXPECT_EQ(played.next(0), 0u);
    EXPECT_EQ(played.next(10 * ms), 1u);
    EXPECT_FALSE(played.has_ended());
    EXPECT_EQ(played.next(12 * ms), none);
    EXPECT_EQ(played.next(44 * ms), 0u);
    EXPECT_EQ(played.next(54 * ms), 1u);
}

TEST(Playback, AsFastAsReadShowsEach) {
    Playback played({5, 1'000'000, 2'000'000}, {.repeats = false, .as_fast_as_read = true});
    EXPECT_EQ(played.next(0), 0u);
    EXPECT_EQ(played.next(0), 1u);
    EXPECT_EQ(played.next(0), 2u);
    EXPECT_EQ(played.next(0), none);
}

// A clock that was set anew, one that stands still, one that leaps.
TEST(Playback, TimesOfAnyKindComeToAnEnd) {
    Playback back({9'000'000, 8'000'000, 8'033'000}, {.repeats = false});
    EXPECT_EQ(back.next(0), 0u);
    EXPECT_EQ(back.next(34 * ms), 1u);
    EXPECT_EQ(back.next(67 * ms), 2u);
    Playback still({7, 7, 7}, {.repeats = true});
    EXPECT_TRUE(still.next(0));
    EXPECT_TRUE(still.next(900 * ms));
    Playback leaps({0, ~std::uint64_t{0}, 5}, {.repeats = false});
    EXPECT_EQ(leaps.next(0), 0u);
    EXPECT_EQ(leaps.next(999 * ms), none);
    EXPECT_EQ(leaps.next(1000 * ms), 1u);
}

TEST(Playback, GoesOnWhereItWasLeft) {
    Playback played({0, 10'000, 20'000, 30'000}, {.repeats = false});
    EXPECT_EQ(played.next(0), 0u);
    EXPECT_EQ(played.next(3600 * 1000 * ms), 1u);
    EXPECT_EQ(played.next(3600 * 1000 * ms + 10 * ms), 2u);
}

}  // namespace
}  // namespace tactus::playback_test
