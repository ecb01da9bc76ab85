#include "core/teleop/stealth.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace tactus::stealth_test {
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

TEST(Stealth, AnOffsetFadesToNothing) {
    const Vec3 offset(0.003, 0.0, 0.004);
    EXPECT_NEAR(glm::length(faded(offset, 0.001)), 0.004, 1e-15);
    EXPECT_EQ(faded(offset, 0.005), Vec3(0.0));
}

TEST(DriftRate, ComesToTheRateOfManySmallCorrections) {
    const StealthSettings settings;
    DriftRate drift;
    // 20 mN every 5 ms are 4 N/s.
    for (int tick = 0; tick < 2000; ++tick) {
        drift.pass(settings, 0.001);
        if (tick % 5 == 0) {
            drift.carried(0.02);
        }
    }
    EXPECT_NEAR(drift.rate(settings), 4.0, 0.4);
}

TEST(DriftRate, OneLargeCorrectionIsNoDrift) {
    const StealthSettings settings;
    DriftRate drift;
    drift.carried(2.0);
    EXPECT_EQ(drift.rate(settings), 0.0);
    drift.carried(0.05);
    EXPECT_NEAR(drift.rate(settings), 0.05 / settings.window, 1e-12);
    drift.pass(settings, 5.0 * settings.window);
    EXPECT_LT(drift.rate(settings), 0.01 * 0.05 / settings.window);
}

}  // namespace
}  // namespace tactus::stealth_test
