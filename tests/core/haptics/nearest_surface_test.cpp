#include "core/haptics/nearest_surface.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/slow_distance.hpp"
#include "shared/touch_rig.hpp"

namespace tactus {
namespace {

using shared::RandomValues;
using shared::TouchRig;

TEST(NearestSurface, DistanceAndDirectionOnAMeshAreThoseOfBruteForce) {
    RandomValues random(151);
    const TriangleMesh mesh = shared::soup(80, 1.0, 3);
    TouchRig rig(0.01);
    const Pose pose{Vec3(0.3, -0.2, 0.5), random.rotation()};
    const int body = rig.add(mesh, pose);
    for (int i = 0; i < 500; ++i) {
        const Vec3 p = random.in_ball(2.0);
        const Vec3 local = to_local(pose, p);
        const auto distance = static_cast<double>(shared::slow_distance(local, mesh));
        const NearestSurface found = nearest_surface(rig.scene, body, p, 10.0);
        ASSERT_NEAR(found.distance, distance, 1e-12);
        ASSERT_NEAR(glm::length(found.normal), 1.0, 1e-12);
        // Following the direction back leads onto the surface.
        const Vec3 foot = to_local(pose, p - found.normal * found.distance);
        ASSERT_LT(static_cast<double>(shared::slow_distance(foot, mesh)), 1e-9);
    }
}

TEST(NearestSurface, OfSeveralPartsTheNearestCounts) {
    const PlacedShape parts[] = {{SphereShape{0.5}, {Vec3(-1.0, 0.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0)}},
                                 {BoxShape{Vec3(0.5)}, {Vec3(1.0, 0.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0)}}};
    const TouchShapeResult shape = make_touch_shape(parts);
    ASSERT_TRUE(shape.shape);
    TouchScene scene(1, 2);
    const int body = scene.add(*shape.shape, {}, {}, 1);
    EXPECT_NEAR(nearest_surface(scene, body, {-1.0, 0.8, 0.0}, 10.0).distance, 0.3, 1e-12);
    const NearestSurface beside = nearest_surface(scene, body, {1.0, 0.9, 0.2}, 10.0);
    EXPECT_NEAR(beside.distance, 0.4, 1e-12);
    EXPECT_LT(glm::distance(beside.normal, Vec3(0.0, 1.0, 0.0)), 1e-12);
}

TEST(NearestSurface, BeyondWhatWasAskedForThereIsNothing) {
    TouchRig rig(0.01);
    const int body = rig.add(SphereShape{0.5});
    EXPECT_EQ(nearest_surface(rig.scene, body, {0.0, 3.0, 0.0}, 1.0).distance, 1.0);
}

TEST(NearestSurface, InsideASolidTheDistanceIsNegative) {
    TouchRig rig(0.01);
    const int body = rig.add(SphereShape{0.5});
    EXPECT_NEAR(nearest_surface(rig.scene, body, {0.0, 0.2, 0.0}, 1.0).distance, -0.3, 1e-12);
}

TEST(PassThrough, ABrokenSurfaceLetsTheProxyThroughAndHoldsAgainBehind) {
    for (const bool mesh : {true, false}) {
        TouchRig rig(0.02);
        const int body =
            mesh ? rig.add(shared::box(Vec3(0.5, 0.01, 0.5))) : rig.add(BoxShape{Vec3(0.5, 0.01, 0.5)});
        rig.draw({0.0, 0.1, 0.0}, {0.0, -0.02, 0.0}, 10);
        EXPECT_NEAR(rig.proxy.position().y, 0.03, 1e-8);
        ASSERT_TRUE(rig.proxy.pass_through(body));
        const Vec3 inside = rig.tick({0.0, -0.02, 0.0}).position;
        EXPECT_EQ(inside.y, -0.02);  // half way through: still passing
        rig.draw({0.0, -0.02, 0.0}, {0.0, -0.1, 0.0}, 5);
        EXPECT_NEAR(rig.proxy.position().y, -0.1, 1e-12);
        rig.draw({0.0, -0.1, 0.0}, {0.0, 0.05, 0.0}, 20);
        EXPECT_NEAR(rig.proxy.position().y, -0.03, 1e-8);  // from behind it is whole again
    }
}

TEST(PassThrough, OtherBodiesStayWhole) {
    TouchRig rig(0.02);
    const int skin = rig.add(BoxShape{Vec3(0.5, 0.01, 0.5)});
    rig.add(BoxShape{Vec3(0.5, 0.01, 0.5)}, {Vec3(0.0, -0.2, 0.0), Quat(1.0, 0.0, 0.0, 0.0)});
    rig.draw({0.0, 0.1, 0.0}, {0.0, -0.01, 0.0}, 10);
    ASSERT_TRUE(rig.proxy.pass_through(skin));
    rig.draw({0.0, -0.01, 0.0}, {0.0, -0.4, 0.0}, 10);
    EXPECT_NEAR(rig.proxy.position().y, -0.17, 1e-8);
}

}  // namespace
}  // namespace tactus
