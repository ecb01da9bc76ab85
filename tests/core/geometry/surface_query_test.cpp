#include "core/geometry/surface_query.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/slow_distance.hpp"

namespace tactus::surface_query_test {

namespace {

constexpr Vec3 half{0.5, 0.25, 0.1};

Pose somewhere() {
    return {{1.0, 2.0, 3.0}, glm::angleAxis(0.7, glm::normalize(Vec3(1.0, 2.0, -1.0)))};
}

TriangleMesh box_mesh() {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.vertices.push_back(
            {(i & 1 ? 1.0 : -1.0) * half.x, (i & 2 ? 1.0 : -1.0) * half.y, (i & 4 ? 1.0 : -1.0) * half.z});
    }
    mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return mesh;
}

std::vector<TouchShape> boxes() {
    const PlacedShape solid{BoxShape{half}, Pose{}};
    const PlacedShape mesh{MeshShape{std::make_shared<const TriangleMesh>(box_mesh()), 0.0}, Pose{}};
    return {*make_touch_shape(std::span(&solid, 1)).shape, *make_touch_shape(std::span(&mesh, 1)).shape};
}

// Of a point outside an axis-aligned box.
double distance_to_box(const Vec3& point) {
    return glm::length(glm::max(glm::abs(point) - half, Vec3(0.0)));
}

TEST(SurfaceQuery, TheNearestPointOfASolidAndOfItsMeshIsTheBoxs) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-1.5, 1.5);
    for (const TouchShape& shape : boxes()) {
        for (int i = 0; i < 1000; ++i) {
            const Vec3 in_body(place(random), place(random), place(random));
            const double expected = distance_to_box(in_body);
            if (expected == 0.0) {
                continue;
            }
            const Vec3 point = to_parent(somewhere(), in_body);
            const SurfaceHit found = nearest_surface(shape, somewhere(), point, 10.0);
            ASSERT_TRUE(found.hit);
            EXPECT_NEAR(found.distance, expected, 1e-9);
            EXPECT_NEAR(glm::length(found.point + found.distance * found.normal - point), 0.0, 1e-9);
            EXPECT_NEAR(glm::length(found.normal), 1.0, 1e-9);
        }
    }
}

TEST(SurfaceQuery, DistanceAndDirectionOnAMeshAreThoseOfBruteForce) {
    shared::RandomValues random(151);
    const TriangleMesh mesh = shared::soup(80, 1.0, 3);
    const PlacedShape placed{MeshShape{std::make_shared<const TriangleMesh>(mesh)}, {}};
    const TouchShapeResult made = make_touch_shape({&placed, 1});
    const Pose pose{Vec3(0.3, -0.2, 0.5), random.rotation()};
    for (int i = 0; i < 500; ++i) {
        const Vec3 p = random.in_ball(2.0);
        const auto distance = static_cast<double>(shared::slow_distance(to_local(pose, p), mesh));
        const SurfaceHit found = nearest_surface(*made.shape, pose, p, 10.0);
        ASSERT_NEAR(found.distance, distance, 1e-12);
        ASSERT_NEAR(glm::length(found.normal), 1.0, 1e-12);
        // Following the direction back leads onto the surface.
        const Vec3 foot = to_local(pose, p - found.normal * found.distance);
        ASSERT_LT(static_cast<double>(shared::slow_distance(foot, mesh)), 1e-9);
    }
}

TEST(SurfaceQuery, OfSeveralPartsTheNearestCounts) {
    const PlacedShape parts[] = {{SphereShape{0.5}, {Vec3(-1.0, 0.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0)}},
                                 {BoxShape{Vec3(0.5)}, {Vec3(1.0, 0.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0)}}};
    const TouchShapeResult made = make_touch_shape(parts);
    ASSERT_TRUE(made.shape);
    EXPECT_NEAR(nearest_surface(*made.shape, {}, {-1.0, 0.8, 0.0}, 10.0).distance, 0.3, 1e-12);
    const SurfaceHit beside = nearest_surface(*made.shape, {}, {1.0, 0.9, 0.2}, 10.0);
    EXPECT_NEAR(beside.distance, 0.4, 1e-12);
    EXPECT_LT(glm::distance(beside.normal, Vec3(0.0, 1.0, 0.0)), 1e-12);
}

TEST(SurfaceQuery, ASearchThatEndsEarlySaysSo) {
    const PlacedShape placed{MeshShape{std::make_shared<const TriangleMesh>(shared::soup(500, 1.0, 3))}, {}};
    const TouchShapeResult made = make_touch_shape({&placed, 1});
    WorkBudget little(1);
    EXPECT_FALSE(nearest_surface(*made.shape, {}, {0.1, 0.2, 0.0}, 10.0, little).complete);
    EXPECT_TRUE(nearest_surface(*made.shape, {}, {0.1, 0.2, 0.0}, 10.0).complete);
}

TEST(SurfaceQuery, WhatIsFartherThanAskedForIsNotFound) {
    for (const TouchShape& shape : boxes()) {
        EXPECT_FALSE(nearest_surface(shape, Pose{}, {2.5, 0.0, 0.0}, 1.9).hit);
        EXPECT_TRUE(nearest_surface(shape, Pose{}, {2.5, 0.0, 0.0}, 2.1).hit);
    }
}

TEST(SurfaceQuery, ASolidHasAnInsideAndAMeshHasNone) {
    const std::vector<TouchShape> both = boxes();
    EXPECT_NEAR(nearest_surface(both[0], Pose{}, {0.0, 0.0, 0.05}, 1.0).distance, -0.05, 1e-12);
    EXPECT_NEAR(nearest_surface(both[1], Pose{}, {0.0, 0.0, 0.05}, 1.0).distance, 0.05, 1e-12);
}

TEST(SurfaceQuery, ARayThatPassesTheBallOfAPartNeedsNoMoreQuestions) {
    for (const TouchShape& shape : boxes()) {
        EXPECT_TRUE(may_meet_ray(shape, Pose{}, {0.0, 5.0, 0.0}, {0.0, -1.0, 0.0}, 10.0));
        EXPECT_FALSE(may_meet_ray(shape, Pose{}, {0.0, 5.0, 0.0}, {0.0, -1.0, 0.0}, 3.0));
        EXPECT_FALSE(may_meet_ray(shape, Pose{}, {2.0, 5.0, 0.0}, {0.0, -1.0, 0.0}, 10.0));
    }
}

}  // namespace

}  // namespace tactus::surface_query_test
