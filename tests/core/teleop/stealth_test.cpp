#include "core/teleop/stealth.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace tactus {
namespace {

TEST(Stealth, SmallForcesHaveALeastNoticeableChange) {
    const StealthSettings settings;
    EXPECT_EQ(just_noticeable(settings, 0.0), settings.least_noticeable);
    EXPECT_DOUBLE_EQ(just_noticeable(settings, 10.0), 10.0 * settings.weber);
}

TEST(Stealth, FadingOverOneWindowStaysBelowTheShare) {
    const StealthSettings settings;
    EXPECT_NEAR(unnoticed_change(settings, 2.0, settings.window),
                settings.share * just_noticeable(settings, 2.0), 1e-15);
}

TEST(Stealth, ABridgeGivesBackTheForceFeltBefore) {
    const Vec3 modelled(1.0, 2.0, -0.5), before(1.4, 1.0, 0.2);
    const Vec3 felt = bridge(modelled, before, true).felt(modelled);
    EXPECT_NEAR(glm::length(felt - before), 0.0, 1e-14);
}

TEST(Stealth, KeepingTheMagnitudeLeavesTheDirection) {
    const Vec3 modelled(0.0, 2.0, 0.0), before(1.0, 0.0, 0.0);
    const Vec3 felt = bridge(modelled, before, false).felt(modelled);
    EXPECT_NEAR(glm::length(felt), 1.0, 1e-14);
    EXPECT_NEAR(felt.y, 1.0, 1e-14);
}

TEST(Stealth, NothingIsMadeOfNoForce) {
    EXPECT_TRUE(bridge(Vec3(0.0), {0.0, 1.0, 0.0}, true).is_none());
    EXPECT_TRUE(bridge({0.0, 1.0, 0.0}, Vec3(0.0), true).is_none());
}

TEST(Stealth, OppositeForcesAreNotTurned) {
    const ForceBridge half = bridge({0.0, 1.0, 0.0}, {0.0, -1.0, 0.0}, true);
    EXPECT_EQ(half.turn, Quat(1.0, 0.0, 0.0, 0.0));
}

TEST(Stealth, AFadingBridgeNeverChangesTheForceByMore) {
    const Vec3 modelled(0.3, 3.0, -1.0);
    ForceBridge bridging = bridge(modelled, {1.5, 2.0, 0.5}, true);
    constexpr double change = 0.01;
    int ticks = 0;
    while (!bridging.is_none()) {
        const ForceBridge next = faded(bridging, glm::length(modelled), change);
        ASSERT_LE(glm::length(next.felt(modelled) - bridging.felt(modelled)), change * (1.0 + 1e-9));
        bridging = next;
        ASSERT_LT(++ticks, 10'000);
    }
    EXPECT_EQ(bridging.felt(modelled), modelled);
}

TEST(Stealth, AnOffsetFadesToNothing) {
    const Vec3 offset(0.003, 0.0, 0.004);
    EXPECT_NEAR(glm::length(faded(offset, 0.001)), 0.004, 1e-15);
    EXPECT_EQ(faded(offset, 0.005), Vec3(0.0));
}

TEST(DriftRate, ComesToTheRateOfManySmallCorrections) {
    const StealthSettings settings;
    DriftRate drift;
    // 20 um every 5 ms are 4 mm/s.
    for (int tick = 0; tick < 2000; ++tick) {
        drift.pass(settings, 0.001);
        if (tick % 5 == 0) {
            drift.carried(settings, 20e-6, 1e-3);
        }
    }
    EXPECT_NEAR(drift.rate(), 0.004, 0.0004);
}

TEST(DriftRate, OneLargeCorrectionCountsNoMoreThanASmallOne) {
    const StealthSettings settings;
    DriftRate drift;
    drift.carried(settings, 0.05, 1e-4);
    EXPECT_DOUBLE_EQ(drift.rate(), 1e-4 / settings.window);
}

}  // namespace
}  // namespace tactus
