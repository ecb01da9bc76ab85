#include "core/haptics/nearest_body.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "shared/meshes.hpp"

namespace tactus::nearest_body_test {
namespace {

constexpr double within = 0.05;

std::shared_ptr<const TouchShape> touchable(const TriangleMesh& mesh) {
    const std::vector<PlacedShape> shapes = {{MeshShape{std::make_shared<const TriangleMesh>(mesh)}, Pose{}}};
    return make_touch_shape(shapes).shape;
}

WorkBudget unlimited() {
    return WorkBudget(std::numeric_limits<std::int64_t>::max());
}

// Many bodies whose balls all hold the origin, and whose surfaces are all about as near to it.
struct Crowd {
    explicit Crowd(int count) {
        for (int i = 0; i < count; ++i) {
            const double away = 0.02 + 1e-5 * ((i * 37) % count);
            add({0.0, away, 0.0});
        }
    }
    int add(const Vec3& nearest) { return scene.add(*shape, {nearest + Vec3(0.0, 0.2, 0.0)}, {}, 1); }

    std::shared_ptr<const TouchShape> shape = touchable(shared::icosphere(4, 0.2));
    TouchScene scene{400, 400};
};

TEST(NearestBody, IsTheNearestOfAll) {
    Crowd crowd(50);
    const int nearest = crowd.add({0.0, 0.01, 0.0});
    NearestBody look;
    WorkBudget work = unlimited();
    const NearestBody::Found found = look.look(crowd.scene, Vec3(0.0), within, -1, work);
    EXPECT_TRUE(found.asked_all);
    EXPECT_EQ(found.body, nearest);
    EXPECT_NEAR(found.surface.distance, 0.01, 1e-3);
    EXPECT_LT(found.surface.normal.y, -0.99);
}

TEST(NearestBody, NoneIsAsNearAsThat) {
    Crowd crowd(3);
    crowd.scene.remove(1);
    NearestBody look;
    WorkBudget work = unlimited();
    const NearestBody::Found found = look.look(crowd.scene, {0.0, -1.0, 0.0}, within, 1, work);
    EXPECT_TRUE(found.asked_all);
    EXPECT_EQ(found.body, -1);
}

// 200 bodies in reach cost no more than one tick has; each has its turn within a few.
TEST(NearestBody, BoundedWorkFindsItAmongTwoHundredWithinAFewTicks) {
    constexpr std::int64_t units = 500;
    Crowd crowd(200);
    const int nearest = crowd.add({0.0, 0.01, 0.0});
    NearestBody look;
    int first = -1, ticks = 0;
    for (; first != nearest && ticks < 100; ++ticks) {
        // What is kept back is not touched: nobody goes on when the work is gone.
        WorkBudget work(units);
        const NearestBody::Found found = look.look(crowd.scene, Vec3(0.0), within, first, work);
        EXPECT_FALSE(found.asked_all);
        EXPECT_TRUE(work.is_gone());
        work.spend(-units);
        EXPECT_FALSE(work.is_gone()) << "twice as much was done as was given";
        first = found.body;
        EXPECT_GE(first, 0);
    }
    EXPECT_LT(ticks, 100);
    // Once it is known it is asked first, and stays.
    for (int i = 0; i < 20; ++i) {
        WorkBudget work(units);
        EXPECT_EQ(look.look(crowd.scene, Vec3(0.0), within, nearest, work).body, nearest);
    }
}

TEST(NearestBody, WhatIsFarCostsNextToNothing) {
    Crowd crowd(1);
    for (int i = 0; i < 300; ++i) {
        crowd.add({0.0, 5.0, 0.0});
    }
    NearestBody look;
    WorkBudget work(2000);
    const NearestBody::Found found = look.look(crowd.scene, Vec3(0.0), within, -1, work);
    EXPECT_TRUE(found.asked_all);
    EXPECT_EQ(found.body, 0);
}

}  // namespace
}  // namespace tactus::nearest_body_test
