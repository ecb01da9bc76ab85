#include "sensing/image/camera_clock.hpp"

#include <gtest/gtest.h>

#include "shared/random_values.hpp"

namespace tactus::camera_clock_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;
constexpr Nanoseconds image = 33 * ms;

// Images that take 20 ms at least, and up to 30 ms more.
struct Late {
    Nanoseconds next() {
        taken += image;
        const auto stamp = static_cast<std::uint64_t>((taken - ahead) / 1000);
        const Nanoseconds arrived = taken + 20 * ms + static_cast<Nanoseconds>(chance.between(0.0, 30e6));
        return clock.taken_at(stamp, arrived) - taken;
    }

    CameraClock clock;
    shared::RandomValues chance{1};
    Nanoseconds taken = 5'000'000'000, ahead = 0;
};

TEST(CameraClock, KnowsWhenAnImageWasTakenButForTheShortestWay) {
    for (const Nanoseconds ahead : {Nanoseconds{0}, 4'000'000'000, -700'000'000'000}) {
        Late late;
        late.ahead = ahead;
        for (int i = 0; i < 30; ++i) {
            late.next();
        }
        for (int i = 0; i < 300; ++i) {
            EXPECT_NEAR(static_cast<double>(late.next()), 20e6, 3e6);
        }
    }
}

TEST(CameraClock, FollowsOneThatDrifts) {
    Late late;
    for (int i = 0; i < 3000; ++i) {
        late.ahead += image / 20'000;  // 50 millionths
        const Nanoseconds off = late.next();
        if (i > 30) {
            EXPECT_NEAR(static_cast<double>(off), 20e6, 3e6) << i;
        }
    }
}

TEST(CameraClock, OneThatIsSetAnewIsFollowedAtOnce) {
    Late late;
    for (int i = 0; i < 100; ++i) {
        late.next();
    }
    late.ahead = late.taken;  // it counts from zero
    EXPECT_NEAR(static_cast<double>(late.next()), 35e6, 16e6);
}

// A recording of less than a second that repeats: each time its stamps go back by 0.4 s.
TEST(CameraClock, StampsThatGoBackAreAnotherClocks) {
    CameraClock clock;
    Nanoseconds now = 7 * nanoseconds_per_second;
    for (int i = 0; i < 60; ++i, now += image) {
        const auto stamp = static_cast<std::uint64_t>(5'000'000 + 33'000 * (i % 12));
        EXPECT_NEAR(static_cast<double>(clock.taken_at(stamp, now) - now), 0.0, 1e6 * (i % 12)) << i;
    }
}

TEST(CameraClock, AClockThatStandsStillTellsNothing) {
    CameraClock clock;
    for (int i = 0; i < 60; ++i) {
        const Nanoseconds now = 7 * nanoseconds_per_second + i * image;
        EXPECT_EQ(clock.taken_at(42, now), now) << i;
    }
}

TEST(CameraClock, AnyStampIsATime) {
    CameraClock clock;
    for (const std::uint64_t stamp :
         {~std::uint64_t{0}, std::uint64_t{0}, std::uint64_t{1} << 63, ~std::uint64_t{0}}) {
        EXPECT_LE(clock.taken_at(stamp, image), image);
        EXPECT_GT(time_of_stamp(stamp), -1);
    }
}

TEST(CameraClock, NothingIsTakenAfterItHasArrived) {
    CameraClock clock;
    EXPECT_EQ(clock.taken_at(1'000'000, 2 * nanoseconds_per_second), 2 * nanoseconds_per_second);
    EXPECT_LE(clock.taken_at(1'033'000, 2 * nanoseconds_per_second), 2 * nanoseconds_per_second);
}

}  // namespace
}  // namespace tactus::camera_clock_test
