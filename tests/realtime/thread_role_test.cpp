#include "realtime/thread_role.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace tactus::thread_role_test {
namespace {

TEST(HapticRole, IsHeldForABlockAndNests) {
    EXPECT_FALSE(HapticRole::held());
    {
        const HapticRole outer;
        {
            const HapticRole inner;
        }
        EXPECT_TRUE(HapticRole::held());
    }
    EXPECT_FALSE(HapticRole::held());
}

TEST(HapticRole, BelongsToOneThread) {
    const HapticRole role;
    bool held_elsewhere = true;
    std::thread([&] { held_elsewhere = HapticRole::held(); }).join();
    EXPECT_FALSE(held_elsewhere);
}

#ifndef NDEBUG
TEST(HapticRoleDeathTest, TheAssertStopsAnyOtherThread) {
    EXPECT_DEATH(TACTUS_ASSERT_HAPTIC_THREAD(), "only the haptic thread");
    EXPECT_DEATH(
        {
            const HapticRole role;
            TACTUS_ASSERT_NOT_HAPTIC_THREAD();
        },
        "may not call this");
}
#endif

}  // namespace
}  // namespace tactus::thread_role_test
