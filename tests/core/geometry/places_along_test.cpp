#include "core/geometry/places_along.hpp"

#include <gtest/gtest.h>

namespace tactus::places_along_test {
namespace {

TEST(PlacesAlong, WhatIsNearerThanThatToTheOneBeforeIsLeftOut) {
    const std::vector<Vec3> kept =
        apart({{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.4, 0.0, 0.0}, {0.8, 0.0, 0.0}, {1.2, 0.0, 0.0}}, 0.5);
    EXPECT_EQ(kept, (std::vector<Vec3>{{0.0, 0.0, 0.0}, {0.8, 0.0, 0.0}}));
    EXPECT_TRUE(apart({}, 0.5).empty());
}

}  // namespace
}  // namespace tactus::places_along_test
