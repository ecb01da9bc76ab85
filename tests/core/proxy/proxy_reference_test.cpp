// The proxy against exact descent (shared/reference_descent.hpp), and exact descent against places known in
// closed form.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <numbers>

#include "core/proxy/proxy.hpp"
#include "shared/hand_paths.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/reference_descent.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::proxy_reference_test {
namespace {

using shared::RandomValues;
using shared::ReferenceDescent;
using shared::ReferencePlace;
using shared::SlowVec3;
using shared::TouchRig;

constexpr double radius = 0.05;

double off(const ReferencePlace& place, const Vec3& expected) {
    return static_cast<double>(glm::distance(place.position, SlowVec3(expected)));
}

TEST(ReferenceDescent, SettlesInAGrooveFromAnywhereAboveIt) {
    for (const double degrees : {20.0, 60.0, 90.0, 150.0}) {
        const double half = 0.5 * degrees * std::numbers::pi / 180.0;
        const TriangleMesh mesh = shared::groove(2.0 * half, 10.0);
        ReferenceDescent reference(mesh, radius);
        const double height = radius / std::sin(half);
        const ReferencePlace place = reference.settle({0.01, height + 0.15, 0.1}, {0.0, height - 0.04, 0.3});
        EXPECT_TRUE(place.settled);
        EXPECT_LT(off(place, {0.0, height, 0.3}), 1e-12) << degrees;
    }
}

TEST(ReferenceDescent, SettlesOnAnEdgeWhereItsCylinderFacesTheHand) {
    const TriangleMesh mesh = shared::box(Vec3(0.5));
    ReferenceDescent reference(mesh, radius);
    const Vec3 axis(0.5, 0.5, 0.1);
    const Vec3 hand = axis + Vec3(0.02, 0.005, 0.0);
    const ReferencePlace place = reference.settle(axis + Vec3(0.03, 0.06, -0.02), hand);
    EXPECT_TRUE(place.settled);
    EXPECT_LT(off(place, axis + radius * glm::normalize(hand - axis)), 1e-12);
}

TEST(ReferenceDescent, SettlesOnACornerWhereItsSphereFacesTheHand) {
    const TriangleMesh mesh = shared::box(Vec3(0.5));
    ReferenceDescent reference(mesh, radius);
    const Vec3 corner(0.5);
    const Vec3 hand = corner + Vec3(0.02, 0.005, 0.01);
    const ReferencePlace place = reference.settle(corner + Vec3(0.06), hand);
    EXPECT_TRUE(place.settled);
    EXPECT_LT(off(place, corner + radius * glm::normalize(hand - corner)), 1e-12);
}

TEST(ReferenceDescent, RollsOffAnEdgeThatTheHandIsBehind) {
    const TriangleMesh mesh = shared::box(Vec3(0.5));
    ReferenceDescent reference(mesh, radius);
    // The hand is inside, nearer to the top: on the edge the Lagrangian bends downwards, the way leads onto
    // the top.
    const Vec3 start = Vec3(0.5, 0.5, 0.0) + radius * 1.0001 * glm::normalize(Vec3(1.0, 1.5, 0.0));
    const ReferencePlace place = reference.settle(start, {0.35, 0.45, 0.0});
    EXPECT_TRUE(place.settled);
    EXPECT_LT(off(place, {0.35, 0.55, 0.0}), 1e-12);
}

TEST(ReferenceDescent, TheGridLeavesNoTriangleOut) {
    // More triangles than are looked at one by one, so that the grid is in use.
    const TriangleMesh fine = shared::icosphere(4, 1.0);
    ASSERT_GT(fine.triangles.size(), 4'000u);
    ReferenceDescent reference(fine, radius);
    RandomValues random(131);
    for (int i = 0; i < 30; ++i) {
        const Vec3 direction = random.direction();
        const ReferencePlace place = reference.settle(1.1 * direction, 0.95 * direction);
        EXPECT_TRUE(place.settled);
        EXPECT_NEAR(static_cast<double>(shared::slow_distance(Vec3(place.position), fine)), radius, 1e-14);
    }
}

// Errors of the proxy over a way of the hand: every contact tick, or every n-th.
struct Errors {
    double most = 0.0;
    int touching = 0, unfinished = 0;
};

Errors errors_over(const TriangleMesh& mesh, double r, const std::vector<Vec3>& way, int every) {
    TouchRig rig(r);
    rig.add(mesh);
    ReferenceDescent reference(mesh, r);
    Errors errors;
    for (std::size_t i = 0; i < way.size(); ++i) {
        const ProxyTick tick = rig.tick(way[i]);
        errors.unfinished += (tick.status & proxy_unfinished) != 0;
        if (!(tick.status & proxy_touching) || errors.touching++ % every != 0) {
            continue;
        }
        errors.most = std::max(errors.most, off(reference.settle(tick.position, way[i]), tick.position));
    }
    return errors;
}

TEST(ProxyReference, OnSpheresOfFacetsItIsAtTheConstrainedMinimum) {
    for (const int level : {1, 2, 4}) {
        for (const double r : {0.05, 0.01}) {
            const Errors errors =
                errors_over(shared::icosphere(level, 1.0), r, shared::around_sphere(r, 6'000), 10);
            EXPECT_GT(errors.touching, 1'000);
            EXPECT_EQ(errors.unfinished, 0);
            EXPECT_LT(errors.most, 1e-7) << "level " << level << ", radius " << r;
        }
    }
}

TEST(ProxyReference, OnABoxItIsAtTheConstrainedMinimum) {
    const Vec3 half(0.5, 0.7, 0.6);
    for (const double r : {0.05, 0.01}) {
        const Errors errors = errors_over(shared::box(half), r, shared::around_box(half, r, 10'000), 10);
        EXPECT_GT(errors.touching, 1'000);
        EXPECT_LT(errors.most, 1e-7);
    }
}

TEST(ProxyReference, OnATerrainItIsNeverStuck) {
    constexpr int cells = 96;
    constexpr double size = 0.96;
    const TriangleMesh mesh = shared::terrain(cells, size, 0.04);
    for (const double r : {0.05, 0.01}) {
        const Errors errors = errors_over(mesh, r, shared::over_terrain(mesh, cells, size, r, 8'000), 10);
        EXPECT_GT(errors.touching, 3'000);
        EXPECT_EQ(errors.unfinished, 0);
        EXPECT_LT(errors.most, 1e-5);
    }
}

}  // namespace
}  // namespace tactus::proxy_reference_test
