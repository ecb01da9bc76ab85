// A surface that breaks under the hand.
#include <gtest/gtest.h>

#include "shared/meshes.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::pass_through_test {
namespace {

using shared::TouchRig;

// Where the top of a body broke, 1 cm above its middle.
BrokenAt at_the_top(double half_height = 0.01) {
    return {{0.0, half_height, 0.0}, {0.0, 1.0, 0.0}, 3.0};
}

TEST(PassThrough, ABrokenSurfaceIsOpenUntilTheProxyComesOutAsItWentIn) {
    for (const bool mesh : {true, false}) {
        TouchRig rig(0.02);
        const int body =
            mesh ? rig.add(shared::box(Vec3(0.5, 0.01, 0.5))) : rig.add(BoxShape{Vec3(0.5, 0.01, 0.5)});
        rig.draw({0.0, 0.1, 0.0}, {0.0, -0.02, 0.0}, 10);
        EXPECT_NEAR(rig.proxy.position().y, 0.03, 1e-8);
        ASSERT_TRUE(rig.proxy.pass_through(body, at_the_top()));
        const Vec3 inside = rig.tick({0.0, -0.02, 0.0}).position;
        EXPECT_EQ(inside.y, -0.02);  // half way through: still passing
        rig.draw({0.0, -0.02, 0.0}, {0.0, -0.1, 0.0}, 5);
        EXPECT_NEAR(rig.proxy.position().y, -0.1, 1e-12);
        rig.draw({0.0, -0.1, 0.0}, {0.0, 0.0, 0.0}, 20);
        EXPECT_NEAR(rig.proxy.position().y, 0.0, 1e-12);  // its shaft is through it: open from behind
        EXPECT_EQ(rig.proxy.passed_bodies().size(), 1u);
        rig.draw({0.0, 0.0, 0.0}, {0.0, 0.1, 0.0}, 20);
        EXPECT_EQ(rig.proxy.passed_bodies().size(), 0u);
        rig.draw({0.0, 0.1, 0.0}, {0.0, -0.02, 0.0}, 20);
        EXPECT_NEAR(rig.proxy.position().y, 0.03, 1e-8);  // and whole again
    }
}

// A hand that draws back without having gone in.
TEST(PassThrough, ASurfaceThatWasNotEnteredIsWholeAgain) {
    TouchRig rig(0.02);
    const int body = rig.add(BoxShape{Vec3(0.5, 0.01, 0.5)});
    rig.draw({0.0, 0.1, 0.0}, {0.0, 0.02, 0.0}, 10);
    ASSERT_TRUE(rig.proxy.pass_through(body, at_the_top()));
    rig.draw({0.0, 0.02, 0.0}, {0.0, 0.1, 0.0}, 10);
    rig.draw({0.0, 0.1, 0.0}, {0.0, 0.0, 0.0}, 10);
    EXPECT_NEAR(rig.proxy.position().y, 0.03, 1e-8);
}

TEST(PassThrough, OtherBodiesStayWhole) {
    TouchRig rig(0.02);
    const int skin = rig.add(BoxShape{Vec3(0.5, 0.01, 0.5)});
    rig.add(BoxShape{Vec3(0.5, 0.01, 0.5)}, {Vec3(0.0, -0.2, 0.0), Quat(1.0, 0.0, 0.0, 0.0)});
    rig.draw({0.0, 0.1, 0.0}, {0.0, -0.01, 0.0}, 10);
    ASSERT_TRUE(rig.proxy.pass_through(skin, at_the_top()));
    rig.draw({0.0, -0.01, 0.0}, {0.0, -0.4, 0.0}, 10);
    EXPECT_NEAR(rig.proxy.position().y, -0.17, 1e-8);
}

}  // namespace
}  // namespace tactus::pass_through_test
