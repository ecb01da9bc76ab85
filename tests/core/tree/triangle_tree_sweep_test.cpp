// Sweeps of the triangle tree, beside those of brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shared/slow_distance.hpp"
#include "shared/tree_samples.hpp"

namespace tactus::triangle_tree_sweep_test {
namespace {

using namespace shared;

Hit sweep(const TriangleTree& tree, const Vec3& start, const Vec3& motion, double radius, double slack,
          std::int64_t units = 1'000'000) {
    WorkBudget work(units);
    return tree.sweep({start, motion, radius, slack}, 1.0, work);
}

// Whatever a sweep may look at, its answer is on the safe side.
TEST(TriangleTree, ASweepThatMayNotLookFurtherEndsEarly) {
    RandomValues random(48);
    const TriangleMesh mesh = shared::icosphere(5, 1.0);
    const TriangleTree tree = TriangleTree::build(mesh);
    int cut = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec3 start = 3.0 * random.direction();
        const Vec3 motion = 2.0 * (random.in_ball(0.8) - start);
        const Hit whole = sweep(tree, start, motion, 0.05, 1e-12);
        const Hit part = sweep(tree, start, motion, 0.05, 1e-12, random.below(120));
        ASSERT_TRUE(whole.complete);
        ASSERT_LE(part.t, whole.t);
        ASSERT_GE(part.t, 0.0);
        ASSERT_TRUE(part.complete ? part.t == whole.t : !part.found);
        cut += part.t < whole.t;
    }
    EXPECT_GT(cut, 50);
}

// However little of it fits into a tick.
TEST(TriangleTree, ASweepInPiecesFindsWhatOneInOneGoDoes) {
    RandomValues random(44);
    int found = 0, pieces = 0;
    for (const TreeSample& sample : tree_samples()) {
        const TriangleTree tree = TriangleTree::build(sample.mesh);
        const Extent extent = extent_of(sample.mesh);
        for (int i = 0; i < 60; ++i) {
            const Vec3 start = extent.center + random.in_ball(2.0 * extent.radius);
            const double radius =
                (i % 2 ? 1.0 - 1e-9 : 0.3) * static_cast<double>(shared::slow_distance(start, sample.mesh));
            const SphereWay way{start, random.in_ball(2.0 * extent.radius), radius, 1e-9 * radius};
            WorkBudget enough(1'000'000);
            const double limit = random.between(0.1, 1.0);
            const Hit whole = tree.sweep(way, limit, enough);
            SweepProgress progress;
            progress.hit.t = limit;
            bool is_done = false;
            for (int tick = 0; tick < 10'000 && !is_done; ++tick) {
                WorkBudget little(random.between(1.0, 30.0));
                is_done = tree.sweep_on(way, progress, little);
                pieces += !is_done;
                ASSERT_GE(little.left(), -100) << sample.name << " " << i;
            }
            ASSERT_TRUE(is_done) << sample.name << " " << i;
            ASSERT_EQ(progress.hit.found, whole.found) << sample.name << " " << i;
            ASSERT_NEAR(progress.hit.t, whole.t, 1e-6) << sample.name << " " << i;
            found += whole.found;
        }
    }
    EXPECT_GT(found, 100);
    EXPECT_GT(pieces, 500);
}

TEST(TriangleTree, SweepFindsTheFirstTriangleOfBruteForce) {
    RandomValues random(43);
    for (const TreeSample& sample : tree_samples()) {
        const TriangleTree tree = TriangleTree::build(sample.mesh);
        const Extent extent = extent_of(sample.mesh);
        const double slack = 1e-12 * std::max(1.0, tree.magnitude());
        for (int i = 0; i < 25; ++i) {
            const double radius = extent.radius * random.magnitude(1e-3, 0.1);
            const Vec3 start = extent.center + random.in_ball(3.0 * extent.radius);
            if (shared::slow_distance(start, sample.mesh) <= 1.01 * radius) {
                continue;
            }
            const Vec3 motion =
                (extent.center + random.in_ball(extent.radius) - start) * random.between(0.2, 2.0);
            const auto expected = static_cast<double>(shared::slow_sweep(start, motion, radius, sample.mesh));
            const Hit hit = sweep(tree, start, motion, radius, slack);
            const double found = hit.t;
            const double tolerance = 4.0 * slack / glm::length(motion) + 1e-12;
            if (expected > 1.0 && !hit.found) {
                continue;
            }
            ASSERT_TRUE(hit.found) << sample.name << " " << i;
            ASSERT_LE(found, expected + tolerance) << sample.name << " " << i;
            const Vec3 end = start + motion * found;
            const auto gap = static_cast<double>(shared::slow_distance(end, sample.mesh)) - radius;
            // It is the triangle it names that stops the way.
            ASSERT_LE(static_cast<double>(shared::slow_distance(
                          end, shared::corners_of(sample.mesh, tree.triangle_at(hit.triangle)))) -
                          radius,
                      4.0 * slack)
                << sample.name << " " << i;
            ASSERT_GE(gap, -rounding(tree)) << sample.name << " " << i;
            ASSERT_LE(gap, 4.0 * slack) << sample.name << " " << i;
        }
    }
}

// A sphere that is larger by a hair than the least distance on its way is stopped, however it passes.
TEST(TriangleTree, ASweepMissesNoGraze) {
    RandomValues random(49);
    int grazes = 0;
    for (const TreeSample& sample : tree_samples()) {
        const TriangleTree tree = TriangleTree::build(sample.mesh);
        const Extent extent = extent_of(sample.mesh);
        for (int i = 0; i < 400; ++i) {
            const Vec3 start = extent.center + random.in_ball(2.0 * extent.radius);
            const Vec3 motion = random.in_ball(extent.radius * random.magnitude(1e-2, 1.0));
            const auto distance = [&](double t) {
                return tree.nearest(start + motion * t, 10.0 * extent.radius).distance;
            };
            double at = 0.0;
            for (double step = 0.5; step > 1e-9; step *= 0.5) {
                for (const double t : {std::max(0.0, at - step), std::min(1.0, at + step)}) {
                    at = distance(t) < distance(at) ? t : at;
                }
            }
            const double radius = distance(at) * (1.0 + random.magnitude(1e-9, 1e-2));
            if (distance(0.0) <= radius || distance(1.0) <= radius || radius < 1e-3 * extent.radius) {
                continue;
            }
            ++grazes;
            const Hit hit = sweep(tree, start, motion, radius, 1e-12 * std::max(1.0, tree.magnitude()));
            ASSERT_TRUE(hit.found) << sample.name << " " << i;
            ASSERT_LE(hit.t, at) << sample.name << " " << i;
        }
    }
    EXPECT_GT(grazes, 100);
}

// Tangents at both ends would let it come as near as the radius in between.
TEST(TriangleTree, ASweepThatPassesACrowdByLooksAtItOnce) {
    RandomValues random(50);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 5'000; ++i) {
        const Vec3 at = 1e-3 * Vec3(random.between(-1.0, 1.0), 0.0, random.between(-1.0, 1.0));
        for (int k = 0; k < 3; ++k) {
            mesh.vertices.push_back(at + random.in_ball(1e-5));
        }
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const TriangleTree tree = TriangleTree::build(mesh);
    WorkBudget work(1'000'000);
    const Hit hit = tree.sweep({{-0.02, 0.2004, 0.003}, {0.04, 0.0, 0.0}, 0.2, 1e-9}, 1.0, work);
    EXPECT_TRUE(hit.is_free());
    EXPECT_LE(1'000'000 - work.left(), 100);
}

TEST(TriangleTree, SweepAlongAnAxisMissesNothing) {
    const TriangleTree tree = TriangleTree::build(shared::box(Vec3(1.0)));
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            Vec3 start(0.3, 0.2, 0.1);
            Vec3 motion(0.0);
            start[axis] = 5.0 * side;
            motion[axis] = -10.0 * side;
            EXPECT_NEAR(sweep(tree, start, motion, 0.1, 1e-12).t, 0.39, 1e-12);
        }
    }
}

TEST(TriangleTree, SweepWithinAFaceOfABoxIsSeenAsContactNotLost) {
    const TriangleTree tree = TriangleTree::build(shared::box(Vec3(1.0)));
    // The centre glides in the very plane that bounds the box in the tree, towards an edge.
    EXPECT_NEAR(sweep(tree, {-3.0, 1.0, 0.0}, {4.0, 0.0, 0.0}, 0.1, 1e-12).t, 1.9 / 4.0, 1e-12);
}

// A ball in a hole's mouth touches ten thousand triangles. Which one stops it where it goes sideways is not
// looked for among those beside it and behind it.
TEST(TriangleTree, OfThousandsThatTouchTheOneInTheWayIsFoundFirst) {
    constexpr int count = 5'000;
    constexpr double wide = 0.1, radius = 0.12;
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        for (const double size : {wide, 2.0 * wide}) {
            mesh.vertices.push_back({size * std::cos(angle), 0.0, size * std::sin(angle)});
        }
        const auto a = static_cast<std::uint32_t>(2 * i), b = (a + 2) % (2 * count);
        mesh.triangles.push_back({a, a + 1, b});
        mesh.triangles.push_back({b, a + 1, b + 1});
    }
    const TriangleTree tree = TriangleTree::build(mesh);
    const Vec3 start(0.0, std::sqrt(radius * radius - wide * wide), 0.0);
    for (int i = 0; i < 20; ++i) {
        const double angle = 0.31 * i;
        WorkBudget work(1'000'000);
        const Vec3 motion = 0.01 * Vec3(std::cos(angle), 0.0, std::sin(angle));
        const Hit hit = tree.sweep({start, motion, radius, 1e-6}, 1.0, work);
        ASSERT_TRUE(hit.found && hit.complete);
        EXPECT_EQ(hit.t, 0.0);
        EXPECT_LE(1'000'000 - work.left(), 2'000) << "angle " << angle;
    }
}

}  // namespace
}  // namespace tactus::triangle_tree_sweep_test
