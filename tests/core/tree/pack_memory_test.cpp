// What is remembered answers as the tree it was taken from, however long ago it was looked at.
#include "core/tree/pack_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "shared/meshes.hpp"
#include "shared/random_values.hpp"

namespace tactus::pack_memory_test {
namespace {

using shared::RandomValues;

constexpr double radius = 0.05;
constexpr double slack = 1e-10;
constexpr double longest = 0.02;  // of a step
constexpr double margin = 0.05;   // around the sphere, when it is gathered anew

double distance_to_pack(const TriangleTree& tree, std::uint32_t pack, const Vec3& point) {
    return std::sqrt(smallest(tree.offset_from_pack(pack, splat(point)).squared));
}

// A sphere that wanders over a mesh, its memory and its odometer.
struct Wanderer {
    TriangleTree tree;
    RandomValues random;
    Vec3 center;  // of the sphere
    double odometer = 0.0;
    PackMemory memory;
    WorkBudget work{std::numeric_limits<std::int64_t>::max()};

    Wanderer(const TriangleMesh& mesh, const Vec3& start, std::uint64_t seed)
        : tree(TriangleTree::build(mesh)), random(seed), center(start) {}

    void remember(double length) {
        if (memory.covered_around(center) < radius + slack + length) {
            const double ahead = random.between(0.0, 0.5 * margin);
            memory.gather(tree, center + random.direction() * ahead, radius + length + margin + ahead, ahead,
                          odometer, work);
        }
    }
    // Mostly along the surface, at times straight at it or away.
    Vec3 motion() {
        const Vec3 down = -glm::normalize(center);
        const Vec3 any = random.direction();
        const Vec3 aside = any - down * glm::dot(any, down);
        const Vec3 way = random.below(4) == 0 ? any + down : aside + random.between(-0.15, 0.15) * down;
        return way * random.magnitude(1e-6, longest);
    }
    SphereWay next_way() {
        const Vec3 next = motion();
        remember(glm::length(next));
        return {center, next, radius, slack};
    }
    void go(const Vec3& way) {
        center += way;
        odometer += glm::length(way);
    }
};

std::vector<TriangleMesh> meshes() {
    return {shared::icosphere(2, 1.0), shared::icosphere(6, 1.0), shared::soup(3'000, 1.0, 7)};
}

TEST(PackMemory, ASweepEndsWhereThatOfTheTreeDoes) {
    int stops = 0, seen = 0;
    for (const TriangleMesh& mesh : meshes()) {
        Wanderer sphere(mesh, Vec3(0.3, 1.2, 0.2), 5);
        for (int step = 0; step < 40'000; ++step) {
            const SphereWay way = sphere.next_way();
            const double limit =
                std::min(1.0, sphere.memory.covered_share(sphere.center, way.motion, radius + slack));
            const Hit known = sphere.memory.sweep(sphere.tree, way, limit, sphere.odometer, sphere.work);
            const Hit hit = sphere.tree.sweep(way, limit, sphere.work);
            ASSERT_TRUE(known.complete && hit.complete) << step;
            const double length = glm::length(way.motion);
            ASSERT_NEAR(known.t * length, hit.t * length, 2.0 * slack) << step;
            ++seen;
            stops += hit.found;
            sphere.go(way.motion * known.t);
        }
    }
    EXPECT_GT(stops, seen / 20);
    EXPECT_LT(stops, seen - seen / 20);
}

TEST(PackMemory, WhatIsNotVisitedIsFartherThanSaid) {
    int left_out = 0;
    for (const TriangleMesh& mesh : meshes()) {
        Wanderer sphere(mesh, Vec3(0.3, 1.2, 0.2), 9);
        for (int step = 0; step < 1'000; ++step) {
            const SphereWay way = sphere.next_way();
            sphere.go(way.motion * sphere.tree.sweep(way, 1.0, sphere.work).t);
            sphere.remember(0.0);
            const double limit = radius + sphere.random.magnitude(1e-8, 1e-2);
            std::vector<bool> visited(sphere.tree.pack_count());
            const double others =
                std::min(sphere.memory.covered_around(sphere.center),
                         sphere.memory.visit_near(
                             sphere.tree, sphere.center, limit, sphere.odometer, sphere.work,
                             [&](std::uint32_t pack, const LanesVec3&, const Lanes& distances, unsigned) {
                                 visited[pack] = true;
                                 const Lanes squared =
                                     sphere.tree.offset_from_pack(pack, splat(sphere.center)).squared;
                                 for (int k = 0; k < lane_count; ++k) {
                                     const double exact = std::sqrt(squared[k]);
                                     EXPECT_LE(distances[k], exact + 1e-14);
                                     EXPECT_TRUE(distances[k] > limit || distances[k] > exact - 1e-14);
                                 }
                                 EXPECT_NEAR(smallest(distances), std::sqrt(smallest(squared)), 1e-14);
                             }));
            EXPECT_GT(others, std::min(limit, sphere.memory.covered_around(sphere.center)) - 1e-12) << step;
            for (std::uint32_t pack = 0; pack < visited.size(); ++pack) {
                if (!visited[pack]) {
                    ++left_out;
                    ASSERT_GT(distance_to_pack(sphere.tree, pack, sphere.center), others - 1e-12) << step;
                }
            }
        }
    }
    EXPECT_GT(left_out, 0);
}

}  // namespace
}  // namespace tactus::pack_memory_test
