#include "core/tree/triangle_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <thread>

#include "shared/slow_distance.hpp"
#include "shared/tree_samples.hpp"

namespace tactus::triangle_tree_test {
namespace {

using namespace shared;

constexpr std::int64_t plenty = 1'000'000;

// No slot that is empty is mistaken for a pack where the distance is beyond single precision.
TEST(TriangleTree, FromBeyondAllFloatsOnlyPacksAreFound) {
    const TriangleTree tree = TriangleTree::build(shared::soup(20, 1.0, 5));
    for (const double far : {1e17, 1e19, 1e20, 1e39, 1e55, 1e300}) {
        std::array<FoundPack, 64> found;
        WorkBudget work(1'000'000);
        const FoundPacks packs = tree.packs_around({-far, 0.1 * far, 0.0}, 10.0 * far, work, found);
        for (std::size_t i = 0; i < packs.count; ++i) {
            EXPECT_LT(found[i].pack, tree.pack_count()) << far;
        }
    }
}

TEST(TriangleTree, NearestDistanceIsThatOfBruteForce) {
    RandomValues random(41);
    for (const TreeSample& sample : tree_samples()) {
        const TriangleTree tree = TriangleTree::build(sample.mesh);
        const Extent extent = extent_of(sample.mesh);
        for (int i = 0; i < 200; ++i) {
            const Vec3 p = extent.center + random.in_ball(2.0 * extent.radius);
            const auto expected = static_cast<double>(shared::slow_distance(p, sample.mesh));
            ASSERT_NEAR(tree.nearest(p, 1e30).distance, expected, rounding(tree)) << sample.name;
        }
    }
}

TEST(TriangleTree, FindsEveryPackWithinReach) {
    RandomValues random(42);
    std::vector<FoundPack> found(4096);
    WorkBudget work(plenty);
    for (const TreeSample& sample : tree_samples()) {
        const TriangleTree tree = TriangleTree::build(sample.mesh);
        const Extent extent = extent_of(sample.mesh);
        for (int i = 0; i < 100; ++i) {
            const Vec3 p = extent.center + random.in_ball(1.5 * extent.radius);
            const double reach = extent.radius * random.magnitude(1e-3, 1.0);
            const FoundPacks result = tree.packs_around(p, reach, work, found);
            ASSERT_GE(result.radius, reach * (1.0 - 1e-6));
            const Vec3 elsewhere = p + random.in_ball(reach);
            std::set<std::uint32_t> ids;
            for (std::size_t k = 0; k < result.count; ++k) {
                const Vec3 normal(found[k].normal[0], found[k].normal[1], found[k].normal[2]);
                const double height = found[k].distance + glm::dot(normal, elsewhere - p);
                const auto lanes = tree.triangle_ids(found[k].pack);
                for (const std::uint32_t id : lanes) {
                    const auto corners = shared::corners_of(sample.mesh, id);
                    ASSERT_GE(shared::slow_distance(p, corners), found[k].distance - rounding(tree));
                    ASSERT_GE(shared::slow_distance(elsewhere, corners),
                              height - rounding(tree) - 1e-6 * reach);
                }
                ids.insert(lanes.begin(), lanes.end());
            }
            for (std::size_t t = 0; t < sample.mesh.triangles.size(); ++t) {
                if (shared::slow_distance(p, shared::corners_of(sample.mesh, t)) < reach - rounding(tree)) {
                    ASSERT_TRUE(ids.contains(static_cast<std::uint32_t>(t)))
                        << sample.name << ", triangle " << t;
                }
            }
        }
    }
}

// Heights that fade out beyond what single precision holds as normal numbers: extents whose inverse is
// infinite.
TriangleMesh fading_heights(int cells, double size) {
    TriangleMesh mesh = shared::terrain(cells, size, 0.0);
    for (Vec3& v : mesh.vertices) {
        v.y = static_cast<float>(v.x * std::exp(-v.x * v.x - v.z * v.z));
    }
    return mesh;
}

TEST(TriangleTree, ExtentsBelowNormalNumbersAreNoTrouble) {
    RandomValues random(49);
    for (const double size : {19.0, 20.0, 24.0, 60.0}) {
        const TriangleMesh mesh = fading_heights(80, size);
        const TriangleTree tree = TriangleTree::build(mesh);
        for (int i = 0; i < 50; ++i) {
            const Vec3 p(random.between(-0.5, 0.5) * size, random.unit(), random.between(-0.5, 0.5) * size);
            ASSERT_NEAR(tree.nearest(p, 1e30).distance, static_cast<double>(shared::slow_distance(p, mesh)),
                        1e-13 * size);
        }
    }
    TriangleMesh tiny = shared::icosphere(3, 1.0);
    for (Vec3& v : tiny.vertices) {
        v *= 1e-42;
    }
    tiny.vertices.push_back(Vec3(1.0));
    tiny.triangles.push_back({0, 1, 642});
    EXPECT_NEAR(TriangleTree::build(tiny).nearest(Vec3(0.0, 1.0, 0.0), 1e30).distance, std::sqrt(2.0 / 3.0),
                1e-12);
}

TEST(TriangleTree, AVertexThatNoTriangleUsesCostsNoPrecision) {
    TriangleMesh mesh = shared::icosphere(3, 1.0);
    mesh.vertices.push_back(Vec3(1e9, -1e9, 1e9));
    const TriangleTree tree = TriangleTree::build(mesh);
    EXPECT_LT(glm::length(tree.center()), 1e-12);
    EXPECT_LT(tree.radius(), 1.3);
}

// What does not fit, or is not looked at, lies beyond the radius that is said.
TEST(TriangleTree, SaysHowFarThePacksThatFitReach) {
    RandomValues random(47);
    for (const TreeSample& sample : tree_samples()) {
        const TriangleTree tree = TriangleTree::build(sample.mesh);
        const Extent extent = extent_of(sample.mesh);
        for (int i = 0; i < 50; ++i) {
            const Vec3 p = extent.center + random.in_ball(1.5 * extent.radius);
            std::vector<FoundPack> room(static_cast<std::size_t>(1 + random.below(12)));
            WorkBudget work(random.flip() ? plenty : 30);
            const FoundPacks result = tree.packs_around(p, extent.radius, work, room);
            std::set<std::uint32_t> ids;
            for (std::size_t k = 0; k < result.count; ++k) {
                const auto lanes = tree.triangle_ids(room[k].pack);
                ids.insert(lanes.begin(), lanes.end());
            }
            for (std::size_t t = 0; t < sample.mesh.triangles.size(); ++t) {
                const bool is_found = ids.contains(static_cast<std::uint32_t>(t));
                ASSERT_TRUE(is_found || shared::slow_distance(p, shared::corners_of(sample.mesh, t)) >=
                                            result.radius - rounding(tree))
                    << sample.name << ", triangle " << t;
            }
        }
    }
}

// Of a fine surface only what is about as near as the nearest, whichever way it faces: not all that boxes
// around its pieces protrude to.
TEST(TriangleTree, BesideATouchFewPacksAreFound) {
    constexpr double radius = 0.05;
    RandomValues random(48);
    const TriangleTree tree = TriangleTree::build(shared::icosphere(6, 1.0));
    std::vector<FoundPack> found(4096);
    for (int i = 0; i < 100; ++i) {
        WorkBudget work(plenty);
        const Vec3 center = (1.0 + radius) * random.direction();
        const FoundPacks packs = tree.packs_around(center, radius * (1.0 + 1e-3), work, found);
        EXPECT_LE(packs.count, 8u);  // it touches one, and reaches an edge of 0.018 in the next ones
    }
}

TEST(TriangleTree, LeastDistanceIsALowerBoundAndAtLeastHalf) {
    RandomValues random(44);
    for (const TreeSample& sample : tree_samples()) {
        const TriangleTree tree = TriangleTree::build(sample.mesh);
        const Extent extent = extent_of(sample.mesh);
        for (int i = 0; i < 200; ++i) {
            const Vec3 p = extent.center + random.in_ball(3.0 * extent.radius);
            const double nearest = tree.nearest(p, 1e30).distance;
            WorkBudget work(plenty);
            const double least = tree.least_distance(p, work);
            ASSERT_LE(least, nearest) << sample.name;
            ASSERT_GE(least, 0.5 * nearest - rounding(tree)) << sample.name;
        }
    }
}

// From the middle of a ball the nearest of all triangles is hard to find; one that is near enough is not.
TEST(TriangleTree, OneThatIsNearEnoughEndsTheSearch) {
    const TriangleTree tree = TriangleTree::build(shared::icosphere(6, 1.0));
    const auto ask = [&](double enough) {
        WorkBudget work(500);
        return tree.nearest(Vec3(0.0), 1.1, work, enough);
    };
    EXPECT_FALSE(ask(0.0).complete);
    const NearestTriangle found = ask(1.1);
    EXPECT_TRUE(found.complete);
    EXPECT_LT(found.distance, 1.1);
    EXPECT_TRUE(ask(0.9).distance > 0.9 && !ask(0.9).complete);  // none is that near, and it is not known
}

// Nor is one that is nearly the nearest.
TEST(TriangleTree, OneThatIsNearlyTheNearestEndsTheSearch) {
    const TriangleTree tree = TriangleTree::build(shared::icosphere(6, 1.0));
    RandomValues random(51);
    for (int i = 0; i < 50; ++i) {
        const Vec3 point = random.in_ball(1e-4);
        const double nearest = tree.nearest(point, 1.1).distance;
        WorkBudget work(5'000);
        const NearestTriangle found = tree.nearly_nearest(point, 1.1, 0.99, work);
        ASSERT_TRUE(found.complete);
        ASSERT_GE(found.distance, nearest);
        ASSERT_LE(found.distance, nearest / 0.99);
        ASSERT_EQ(found.distance,
                  std::sqrt(smallest(tree.offset_from_pack(found.pack, splat(point)).squared)));
    }
}

// Among a thousand boxes some are farther than asked for by no more than their bound may err.
TEST(TriangleTree, WhatHasBeenLookedAtWholeIsComplete) {
    const TriangleTree tree = TriangleTree::build(shared::icosphere(4, 1.0));
    RandomValues random(52);
    for (int i = 0; i < 200; ++i) {
        const Vec3 point = random.in_ball(1e-4);
        const double far = random.between(0.995, 1.0005);
        WorkBudget work(plenty);
        const NearestTriangle found = tree.nearest(point, far, work);
        ASSERT_TRUE(found.complete) << i;
        double limit = far;
        ASSERT_GE(tree.visit_near(point, limit, work, [](std::uint32_t) {}), far) << i;
    }
}

TEST(TriangleTree, TheRunnerDoesNotChangeTheTree) {
    const ParallelRunner threads = [](std::size_t count, const std::function<void(std::size_t)>& task) {
        std::atomic<std::size_t> next{0};
        const auto work = [&] {
            for (std::size_t i = next++; i < count; i = next++) {
                task(i);
            }
        };
        std::thread other(work);
        work();
        other.join();
    };
    const TriangleMesh mesh = shared::terrain(300, 10.0, 1.0);  // large enough to be split among threads
    const TriangleTree serial = TriangleTree::build(mesh);
    const TriangleTree parallel = TriangleTree::build(mesh, threads);
    ASSERT_EQ(serial.bytes(), parallel.bytes());
    RandomValues random(44);
    std::vector<FoundPack> first(4096), second(4096);
    for (int i = 0; i < 500; ++i) {
        const Vec3 p(random.between(-5.0, 5.0), random.between(-1.0, 1.0), random.between(-5.0, 5.0));
        WorkBudget work(plenty);
        const FoundPacks a = serial.packs_around(p, 0.3, work, first);
        const FoundPacks b = parallel.packs_around(p, 0.3, work, second);
        ASSERT_EQ(a.count, b.count);
        ASSERT_EQ(serial.nearest(p, 1.0).distance, parallel.nearest(p, 1.0).distance);
        for (std::size_t k = 0; k < a.count; ++k) {
            ASSERT_EQ(first[k].pack, second[k].pack);
            ASSERT_TRUE(std::ranges::equal(serial.triangle_ids(first[k].pack),
                                           parallel.triangle_ids(second[k].pack)));
        }
    }
}

TEST(TriangleTree, RefitAnswersForTheMovedTriangles) {
    RandomValues random(45);
    TriangleMesh mesh = shared::icosphere(3, 1.0);
    TriangleTree tree = TriangleTree::build(mesh);
    for (Vec3& v : mesh.vertices) {
        v = Vec3(2.0 * v.x, v.y + 0.3 * std::sin(5.0 * v.x), v.z) + Vec3(3.0, 0.0, 0.0);
    }
    tree.refit(mesh);
    for (int i = 0; i < 200; ++i) {
        const Vec3 p = Vec3(3.0, 0.0, 0.0) + random.in_ball(4.0);
        ASSERT_NEAR(tree.nearest(p, 1e30).distance, static_cast<double>(shared::slow_distance(p, mesh)),
                    1e-13);
    }
}

// Again and again, from single precision on, whatever its turned boxes were before.
TEST(TriangleTree, ATreeThatFollowsAnswersForTheMovedTriangles) {
    RandomValues random(46);
    TriangleMesh mesh = shared::terrain(12, 2.0, 0.0);
    TriangleTree tree = TriangleTree::build(mesh);
    for (int turn = 1; turn <= 3; ++turn) {
        for (Vec3& v : mesh.vertices) {
            v += Vec3(0.1 * std::sin(3.0 * v.z), 0.2 * std::sin(4.0 * v.x + turn), 0.1);
        }
        tree.follow(mesh);
        for (int i = 0; i < 100; ++i) {
            const Vec3 p = random.in_ball(2.0);
            ASSERT_NEAR(tree.nearest(p, 1e30).distance, static_cast<double>(shared::slow_distance(p, mesh)),
                        1e-13);
        }
        for (const Vec3& v : mesh.vertices) {
            ASSERT_LE(glm::length(v - tree.center()), tree.radius() * (1.0 + 1e-15));
        }
    }
}

TEST(TriangleTree, BallHoldsEveryTriangleAlsoAfterRefit) {
    TriangleMesh mesh = shared::soup(300, 1.0, 9);
    TriangleTree tree = TriangleTree::build(mesh);
    const auto expect_held = [&] {
        for (const Vec3& v : mesh.vertices) {
            ASSERT_LE(glm::length(v - tree.center()), tree.radius() * (1.0 + 1e-15));
        }
    };
    expect_held();
    for (Vec3& v : mesh.vertices) {
        v = 3.0 * v + Vec3(1.0, 2.0, 3.0);
    }
    tree.refit(mesh);
    expect_held();
}

TEST(TriangleTree, TakesLittleMemoryMostOfAllForMeshesInSinglePrecision) {
    const TriangleMesh terrain = shared::terrain(128, 10.0, 1.0);
    const auto bytes_each = [](const TriangleMesh& mesh) {
        const TriangleTree tree = TriangleTree::build(mesh);
        EXPECT_EQ(tree.triangle_count(), mesh.triangles.size());
        return static_cast<double>(tree.bytes()) / static_cast<double>(mesh.triangles.size());
    };
    EXPECT_LE(bytes_each(terrain), 100.0);
    EXPECT_LE(bytes_each(shared::in_single_precision(terrain)), 64.0);
    EXPECT_LE(bytes_each(shared::in_single_precision(shared::icosphere(5, 1.0))), 64.0);
}

// One corner far away that is not in single precision: the same triangles, kept in double.
TEST(TriangleTree, SinglePrecisionKeepsEveryBit) {
    RandomValues random(50);
    TriangleMesh mesh = shared::in_single_precision(shared::terrain(40, 10.0, 1.0));
    const TriangleTree single = TriangleTree::build(mesh);
    mesh.vertices.push_back(Vec3(0.1, 40.0, 0.3));
    mesh.triangles.push_back({0, 1, static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
    const TriangleTree exact = TriangleTree::build(mesh);
    EXPECT_GT(exact.bytes(), single.bytes() * 4 / 3);
    for (int i = 0; i < 300; ++i) {
        const Vec3 p(random.between(-4.0, 5.0), random.between(-1.0, 1.0), random.between(-4.0, 5.0));
        ASSERT_EQ(single.nearest(p, 1.0).distance, exact.nearest(p, 1.0).distance);
    }
    for (Vec3& v : mesh.vertices) {
        v.y += 1e-9;
    }
    TriangleMesh part = mesh;
    part.triangles.pop_back();
    TriangleTree moved = TriangleTree::build(shared::in_single_precision(part));
    moved.refit(part);
    for (int i = 0; i < 100; ++i) {
        const Vec3 p(random.between(-4.0, 5.0), random.between(-1.0, 1.0), random.between(-4.0, 5.0));
        const double slow = static_cast<double>(shared::slow_distance(p, part));
        ASSERT_NEAR(moved.nearest(p, 1.0).distance, std::min(slow, 1.0), 1e-14);
    }
}

// Every triangle stands in one pack, and the same one again only where a pack is filled up.
TEST(TriangleTree, HoldsEveryTriangleOfLargeMeshes) {
    for (const TriangleMesh& mesh :
         {shared::terrain(260, 10.0, 1.0), fading_heights(140, 60.0), shared::soup(20'000, 1.0, 3)}) {
        const TriangleTree tree = TriangleTree::build(mesh);
        std::vector<int> seen(mesh.triangles.size());
        for (std::uint32_t pack = 0; pack < tree.pack_count(); ++pack) {
            const auto ids = tree.triangle_ids(pack);
            for (std::size_t i = 0; i < ids.size(); ++i) {
                seen[ids[i]] += i == 0 || ids[i] != ids[i - 1];
            }
        }
        EXPECT_EQ(std::ranges::count(seen, 1), static_cast<std::ptrdiff_t>(seen.size()));
    }
}

}  // namespace
}  // namespace tactus::triangle_tree_test
