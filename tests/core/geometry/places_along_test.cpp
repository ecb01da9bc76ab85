#include "core/geometry/places_along.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace tactus::places_along_test {
namespace {

TEST(PlacesAlong, WhatIsNearerThanThatToTheOneBeforeIsLeftOut) {
    const std::vector<Vec3> kept =
        apart({{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.4, 0.0, 0.0}, {0.8, 0.0, 0.0}, {1.2, 0.0, 0.0}}, 0.5);
    EXPECT_EQ(kept, (std::vector<Vec3>{{0.0, 0.0, 0.0}, {0.8, 0.0, 0.0}}));
    EXPECT_TRUE(apart({}, 0.5).empty());
}

TEST(PlacesAlong, EvenPlacesAreAsFarFromEachOtherWhateverThePiecesAre) {
    const std::vector<Vec3> even = evenly_along({{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {3.0, 0.0, 0.0}}, 7);
    ASSERT_EQ(even.size(), 7u);
    for (std::size_t i = 0; i < even.size(); ++i) {
        EXPECT_NEAR(even[i].x, 0.5 * static_cast<double>(i), 1e-12);
    }
}

TEST(PlacesAlong, AWayRoundACornerIsMeasuredAlongIt) {
    const std::vector<Vec3> even = evenly_along({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}}, 5);
    ASSERT_EQ(even.size(), 5u);
    EXPECT_NEAR(glm::distance(even[1], Vec3(0.5, 0.0, 0.0)), 0.0, 1e-12);
    EXPECT_NEAR(glm::distance(even[3], Vec3(1.0, 0.5, 0.0)), 0.0, 1e-12);
    EXPECT_EQ(even.back(), Vec3(1.0, 1.0, 0.0));
}

TEST(PlacesAlong, OnePlaceIsNoWay) {
    EXPECT_EQ(evenly_along({{1.0, 2.0, 3.0}}, 16), (std::vector<Vec3>{{1.0, 2.0, 3.0}}));
    EXPECT_TRUE(evenly_along({}, 16).empty());
}

}  // namespace
}  // namespace tactus::places_along_test
