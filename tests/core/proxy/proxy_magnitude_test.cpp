// Tolerances follow what is near the proxy: huge solids, far samples, meshes far away.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "shared/meshes.hpp"
#include "shared/poses.hpp"
#include "shared/random_values.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::proxy_magnitude_test {
namespace {

using shared::at;
using shared::TouchRig;

constexpr double radius = 0.05;

class ProxyOnAPlanet : public ::testing::TestWithParam<double> {};

TEST_P(ProxyOnAPlanet, RestsStillAndSlides) {
    const double planet = GetParam();
    TouchRig rig(radius);
    rig.add(SphereShape{planet}, at({0.0, -planet, 0.0}));
    rig.draw({0.0, 0.5, 0.0}, {0.0, 0.02, 0.0}, 50);
    Vec3 rest = rig.tick({0.0, 0.02, 0.0}).position;
    EXPECT_NEAR(rest.y, radius, 1e-13 * planet + 1e-8);
    for (int i = 0; i < 200; ++i) {
        const Vec3 place = rig.tick({0.0, 0.02, 0.0}).position;
        ASSERT_EQ(place, rest) << i;
    }
    const Vec3 slid = rig.draw({0.0, 0.02, 0.0}, {0.1, 0.02, 0.0}, 100).position;
    const Vec3 hand(0.1, 0.02 + planet, 0.0);
    EXPECT_NEAR(slid.x, (hand * ((planet + radius) / glm::length(hand))).x, 1e-13 * planet + 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Sizes, ProxyOnAPlanet, ::testing::Values(1.0, 1e3, 6.4e6, 1e9));

TEST(ProxyMagnitude, OneFarSampleIsForgotten) {
    TouchRig rig(radius);
    rig.add(BoxShape{Vec3(1.0, 0.1, 1.0)}, at({0.0, -0.1, 0.0}));
    rig.tick({0.0, 0.3, 0.0});
    rig.tick({0.0, 1e8, 0.0});
    rig.draw({0.0, 0.3, 0.0}, {0.0, 0.02, 0.0}, 100);
    EXPECT_GT(rig.proxy.position().y - radius, 1e-7);  // coarse at first
    for (int i = 0; i < 1'200; ++i) {
        rig.tick({1e-4 * (i % 10), 0.02, 0.0});
    }
    EXPECT_NEAR(rig.proxy.position().y, radius, 2e-9);
}

// A step of hundreds of radii strays from the face by more than the half skin at which a sweep stops.
TEST(ProxyMagnitude, LongStepsFarFromTheOriginAreFinished) {
    constexpr double small = 0.002;
    shared::RandomValues random(77);
    for (int i = 0; i < 300; ++i) {
        const Pose pose{1e4 * random.direction(), random.rotation()};
        TriangleMesh mesh = shared::box(Vec3(1.5));
        for (Vec3& v : mesh.vertices) {
            v = to_parent(pose, v);
        }
        TouchRig rig(small);
        rig.add(mesh);
        const auto above = [&](double x, double z, double height) {
            return to_parent(pose, {x, 1.5 + small + height, z});
        };
        rig.tick(above(0.0, 0.0, 0.01));
        rig.tick(above(0.0, 0.0, -small));
        for (int tick = 0; tick < 4; ++tick) {
            const Vec3 hand = above(random.between(-1.0, 1.0), random.between(-1.0, 1.0),
                                    -small * random.magnitude(0.1, 100.0));
            ASSERT_EQ(rig.tick(hand).status & proxy_unfinished, 0u) << i;
        }
    }
}

TEST(ProxyMagnitude, AMeshFarAwayDoesNotBlurWhatIsNear) {
    TouchRig rig(radius);
    TriangleMesh far = shared::box(Vec3(1.0));
    for (Vec3& v : far.vertices) {
        v.x += 1e8;
    }
    rig.add(far);
    rig.add(BoxShape{Vec3(1.0, 0.1, 1.0)}, at({0.0, -0.1, 0.0}));
    rig.draw({0.0, 0.3, 0.0}, {0.0, 0.02, 0.0}, 100);
    EXPECT_NEAR(rig.proxy.position().y, radius, 2e-9);
}

}  // namespace
}  // namespace tactus::proxy_magnitude_test
