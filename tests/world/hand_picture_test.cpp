#include "world/hand_picture.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace tactus::hand_picture_test {
namespace {

TEST(HandPicture, BeforeItRunsOnlyTheProxyIsSeen) {
    const HandPicture picture = hand_picture({.proxy = Vec3(1, 2, 3), .hand = Vec3(9.0), .radius = 0.02});
    EXPECT_TRUE(picture.proxy.is_visible);
    EXPECT_EQ(picture.proxy.center, Vec3(1, 2, 3));
    EXPECT_DOUBLE_EQ(picture.proxy.axes[0].x, 0.02);
    EXPECT_FALSE(picture.hand.is_visible);
    EXPECT_FALSE(picture.line.is_visible);
}

TEST(HandPicture, TheLineReachesFromTheProxyToTheHand) {
    for (const Vec3& way : {Vec3(0, -0.1, 0), Vec3(0.1, 0, 0), Vec3(0.03, 0.02, -0.05)}) {
        const Vec3 proxy(1, 2, 3);
        const HandPicture picture =
            hand_picture({.proxy = proxy, .hand = proxy + way, .radius = 0.01, .is_running = true});
        ASSERT_TRUE(picture.line.is_visible);
        EXPECT_LT(glm::length(picture.line.center + 0.5 * picture.line.axes[1] - (proxy + way)), 1e-15);
        EXPECT_LT(glm::length(picture.line.center - 0.5 * picture.line.axes[1] - proxy), 1e-15);
        EXPECT_NEAR(glm::dot(picture.line.axes[0], picture.line.axes[1]), 0.0, 1e-15);
        EXPECT_GT(glm::determinant(picture.line.axes), 0.0);
    }
}

TEST(HandPicture, WithoutAWayBetweenThemThereIsNoLine) {
    const HandPicture picture = hand_picture({.radius = 0.01, .is_running = true});
    EXPECT_TRUE(picture.hand.is_visible);
    EXPECT_FALSE(picture.line.is_visible);
}

TEST(HandPicture, AHandInsideABodyIsSeenAlone) {
    const HandPicture picture =
        hand_picture({.hand = Vec3(1.0), .radius = 0.01, .is_running = true, .is_present = false});
    EXPECT_FALSE(picture.proxy.is_visible);
    EXPECT_TRUE(picture.hand.is_visible);
    EXPECT_FALSE(picture.line.is_visible);
}

}  // namespace
}  // namespace tactus::hand_picture_test
