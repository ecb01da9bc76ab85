#include "core/teleop/drag_estimate.hpp"

#include <gtest/gtest.h>

namespace tactus {
namespace {

// A model whose body slows down by 1 m/s2 too little, corrected every 5 ms.
TEST(DragEstimate, LearnsWhatIsMissing) {
    const DragSettings settings;
    DragEstimate drag;
    for (int i = 0; i < 500; ++i) {
        const Vec3 truth(0.2, 0.0, 0.0);
        const double wrong = 1.0 + drag.acceleration(settings, truth).x;
        drag.learn(settings, truth, truth + Vec3(wrong * 0.005, 0.0, 0.0), 0.005);
    }
    EXPECT_NEAR(drag.value(), 1.0, 1e-6);
    EXPECT_NEAR(drag.acceleration(settings, {0.0, 0.0, -0.3}).z, 1.0, 1e-6);
}

TEST(DragEstimate, LearnsNothingFromWhatHardlyMoves) {
    const DragSettings settings;
    DragEstimate drag;
    drag.learn(settings, {0.001, 0.0, 0.0}, {0.5, 0.0, 0.0}, 0.005);
    EXPECT_EQ(drag.value(), 0.0);
    EXPECT_EQ(drag.acceleration(settings, {1.0, 0.0, 0.0}), Vec3(0.0));
}

TEST(DragEstimate, FadesOutTowardsRest) {
    const DragSettings settings;
    DragEstimate drag;
    drag.learn(settings, {0.2, 0.0, 0.0}, {0.3, 0.0, 0.0}, 0.005);
    EXPECT_LT(drag.acceleration(settings, {0.001, 0.0, 0.0}).x, 0.0);
    EXPECT_GT(drag.acceleration(settings, {0.001, 0.0, 0.0}).x, -0.1 * drag.value());
    EXPECT_EQ(drag.acceleration(settings, Vec3(0.0)), Vec3(0.0));
}

TEST(DragEstimate, StaysWithinItsLimit) {
    const DragSettings settings;
    DragEstimate drag;
    drag.learn(settings, {0.2, 0.0, 0.0}, {1000.0, 0.0, 0.0}, 0.001);
    EXPECT_EQ(drag.value(), settings.largest);
}

}  // namespace
}  // namespace tactus
