// A sphere on the rim of a bore of thousands of facets: more of them touch it than a tick can look at.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/tree/closest_point_on_triangle.hpp"
#include "core/tree/triangle_tree.hpp"
#include "shared/meshes.hpp"

namespace tactus::triangle_tree_rim_test {
namespace {

constexpr double wide = 0.1, height = 0.2, radius = 0.11;
constexpr double gap = 8e-4 * radius;

// The centre of a sphere so far above the rim.
Vec3 above_rim(double above) {
    return {0.0, height + std::sqrt((radius + above) * (radius + above) - wide * wide), 0.0};
}

SphereWay way_of(const Vec3& motion) {
    return {above_rim(gap), motion, radius, 1e-9 * radius};
}

// The walls end at the rim: no box of theirs reaches farther up, so boxes alone tell nearly all of the way
// that is free.
TEST(TriangleTreeRim, HowFarItMayGoIsToldByAFewHundredBoxes) {
    const TriangleTree tree = TriangleTree::build(shared::bore(8'000, wide, height));
    const auto free_way = [&](const Vec3& motion, std::int64_t units) {
        WorkBudget work(units);
        return tree.sweep(way_of(motion), 1.0, work).t * glm::length(motion);
    };
    const double down = above_rim(gap).y - above_rim(0.0).y;
    EXPECT_GT(free_way({0.0, -0.01, 0.0}, 1'000), 0.8 * down);
    for (const Vec3 motion : {Vec3(0.01, -0.004, 0.0), Vec3(0.01, 0.0, 0.0), Vec3(0.0, 0.012, 0.01)}) {
        EXPECT_GT(free_way(motion, 1'000), 0.8 * free_way(motion, 1'000'000));
    }
}

TEST(TriangleTreeRim, ASweepThatEndsEarlySaysWhatWouldStopItLater) {
    const TriangleTree tree = TriangleTree::build(shared::bore(8'000, wide, height));
    const SphereWay way = way_of({0.01, -0.004, 0.0});
    int named = 0;
    for (std::int64_t units = 100; units < 4'000; units += 100) {
        WorkBudget work(units);
        const Hit hit = tree.sweep(way, 1.0, work);
        ASSERT_FALSE(hit.complete || hit.found) << units << " units";
        if (hit.triangle == Hit::no_triangle) {
            continue;
        }
        ++named;
        const TriangleCorners t = tree.corners(hit.triangle);
        const auto distance_at = [&](double share) {
            const Vec3 place = way.start + way.motion * share;
            return glm::distance(place, closest_point_on_triangle(place, t.a, t.b, t.c).point);
        };
        EXPECT_GE(distance_at(hit.t), radius) << units << " units";
        EXPECT_LT(distance_at(1.0), radius) << units << " units";
    }
    EXPECT_GT(named, 10);
}

// The boxes of thousands are as near as that of the nearest: it is not looked for among all of them.
TEST(TriangleTreeRim, OneThatIsAboutAsNearAsAnyIsFoundByTheFirstBranches) {
    for (const int count : {8'000, 100'000}) {
        const TriangleTree tree = TriangleTree::build(shared::bore(count, wide, height));
        WorkBudget work(750);
        const NearestTriangle found = tree.nearly_nearest(above_rim(gap), 2.0 * radius, 1.0 - 1e-4, work);
        EXPECT_LT(found.distance, radius + 1.1 * gap) << count << " facets";
    }
}

}  // namespace
}  // namespace tactus::triangle_tree_rim_test
