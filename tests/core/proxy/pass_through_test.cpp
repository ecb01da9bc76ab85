// A surface that breaks under the hand.
#include <gtest/gtest.h>

#include "shared/meshes.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::pass_through_test {
namespace {

using shared::TouchRig;

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
}  // namespace tactus::pass_through_test
