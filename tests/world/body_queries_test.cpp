#include "world/body_queries.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::body_queries_test {
namespace {

struct Row {
    std::shared_ptr<const TouchShape> ball =
        make_touch_shape(std::vector<PlacedShape>{{SphereShape{0.5}, {}}}).shape;
    // Balls of 1 m at x = 0, 3, 6.
    std::vector<QueriedBody> bodies = {{ball.get(), Pose{Vec3(0.0)}, 7},
                                       {ball.get(), Pose{Vec3(3.0, 0.0, 0.0)}, 8},
                                       {ball.get(), Pose{Vec3(6.0, 0.0, 0.0)}, 9}};
};

TEST(BodyQueries, TheNearestOfAll) {
    const Row row;
    const BodyPoint found = nearest_of(row.bodies, Vec3(2.0, 0.0, 0.0), 10.0);
    EXPECT_TRUE(found.at.hit);
    EXPECT_EQ(found.index, 8u);
    EXPECT_NEAR(found.at.distance, 0.5, 1e-12);
    EXPECT_FALSE(nearest_of(row.bodies, Vec3(2.0, 0.0, 0.0), 0.4).at.hit);
}

TEST(BodyQueries, TheFirstOnAWay) {
    const Row row;
    const BodyPoint found = first_on_way(row.bodies, Vec3(10.0, 0.1, 0.0), Vec3(-10.0, 0.1, 0.0));
    EXPECT_TRUE(found.at.hit);
    EXPECT_EQ(found.index, 9u);
    EXPECT_NEAR(found.at.distance, 4.0 - std::sqrt(0.25 - 0.01), 1e-5);
    EXPECT_FALSE(first_on_way(row.bodies, Vec3(10.0, 0.6, 0.0), Vec3(-10.0, 0.6, 0.0)).at.hit) << "it passes";
    EXPECT_FALSE(first_on_way(row.bodies, Vec3(10.0, 0.0, 0.0), Vec3(7.0, 0.0, 0.0)).at.hit)
        << "it ends before";
}

TEST(BodyQueries, AWayOfNoLengthMeetsWhatIsThere) {
    const Row row;
    EXPECT_FALSE(first_on_way(row.bodies, Vec3(1.5, 0.0, 0.0), Vec3(1.5, 0.0, 0.0)).at.hit);
    EXPECT_TRUE(first_on_way(row.bodies, Vec3(0.2, 0.0, 0.0), Vec3(0.2, 0.0, 0.0)).at.hit);
}

TEST(BodyQueries, AllThatABallMeets) {
    const Row row;
    EXPECT_EQ(within(row.bodies, Vec3(1.5, 0.0, 0.0), 1.1), (std::vector<std::size_t>{7, 8}));
    EXPECT_TRUE(within(row.bodies, Vec3(1.5, 0.0, 0.0), 0.9).empty());
}

}  // namespace
}  // namespace tactus::body_queries_test
