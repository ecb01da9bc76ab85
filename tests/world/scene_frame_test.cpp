#include "world/scene_frame.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace tactus::scene_frame_test {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double endless = std::numeric_limits<double>::infinity();

Mat3 turn(double angle, const Vec3& axis) {
    return glm::mat3_cast(glm::angleAxis(angle, glm::normalize(axis)));
}

Mat3 scale(double x, double y, double z) {
    return Mat3(Vec3(x, 0, 0), Vec3(0, y, 0), Vec3(0, 0, z));
}

// What an engine of single precision keeps.
Mat3 rounded(const Mat3& axes) {
    return Mat3(glm::mat3(axes));
}

void expect_same(const Mat3& a, const Mat3& b) {
    for (int column = 0; column < 3; ++column) {
        EXPECT_NEAR(glm::distance(a[column], b[column]), 0.0, 1e-12) << "column " << column;
    }
}

TEST(SceneFrame, IsAPoseAndAScaling) {
    const Mat3 turned = turn(2.5, {1, -2, 3});
    for (const Mat3& scaling :
         {Mat3(1.0), scale(2, 0.5, 3), Mat3(Vec3(1, 0, 0), Vec3(0.3, 1, 0), Vec3(0, 0.2, 1))}) {
        const SceneFrame frame{turned * scaling, {1, 2, 3}};
        EXPECT_EQ(pose_of(frame).position, Vec3(1, 2, 3));
        expect_same(glm::mat3_cast(pose_of(frame).rotation) * scaling_of(frame), frame.axes);
        expect_same(scaling_of(frame), scaling);
    }
}

TEST(SceneFrame, AMirroredOneIsTurnedAndItsScalingMirrors) {
    const SceneFrame frame{turn(0.7, {0, 1, 1}) * scale(-2, 1, 1), {}};
    const Pose pose = pose_of(frame);
    EXPECT_NEAR(glm::determinant(glm::mat3_cast(pose.rotation)), 1.0, 1e-12);
    EXPECT_LT(glm::determinant(scaling_of(frame)), 0.0);
    expect_same(glm::mat3_cast(pose.rotation) * scaling_of(frame), frame.axes);
}

TEST(SceneFrame, RoundingIsNoScaling) {
    const SceneFrame frame{rounded(turn(1.1, {3, 1, 2})), {}};
    EXPECT_EQ(scaling_of(frame), Mat3(1.0)) << "to the bit";
    EXPECT_NE(scaling_of({1.0001 * frame.axes}), Mat3(1.0));
}

TEST(SceneFrame, AScalingThatTurnsStaysTheSame) {
    const Mat3 scaling = scale(2, 3, 500);
    const Mat3 before = scaling_of({rounded(scaling)});
    for (double angle = 0.1; angle < 6.0; angle += 0.1) {
        const Mat3 now = scaling_of({rounded(turn(angle, {1, 1, 2}) * scaling)});
        EXPECT_TRUE(same_scaling(before, now)) << angle;
    }
    EXPECT_FALSE(same_scaling(before, scale(2, 3, 501)));
    EXPECT_FALSE(same_scaling(before, scale(2, none, 500)));
}

TEST(SceneFrame, AFrameInAFrame) {
    const SceneFrame outer{turn(0.5, {0, 0, 1}) * 2.0, {1, 0, 0}}, inner{scale(1, 2, 3), {0, 1, 0}};
    const SceneFrame both = compose(outer, inner);
    const Vec3 point(0.1, 0.2, 0.3);
    const Vec3 step_by_step = outer.axes * (inner.axes * point + inner.origin) + outer.origin;
    EXPECT_NEAR(glm::distance(both.axes * point + both.origin, step_by_step), 0.0, 1e-12);
}

TEST(SceneFrame, AnEvenScaleIsItsMean) {
    EXPECT_TRUE(is_even({turn(1.0, {1, 2, 3}) * 3.0}));
    EXPECT_NEAR(mean_scale({turn(1.0, {1, 2, 3}) * 3.0}), 3.0, 1e-12);
    EXPECT_TRUE(is_even({scale(1, 1.0005, -1)}));
    EXPECT_FALSE(is_even({scale(1, 1, 1.002)}));
    EXPECT_NEAR(mean_scale({scale(1, -2, 4)}), 2.0, 1e-12);
}

TEST(SceneFrame, CanBeTouchedAlmostAnywhere) {
    EXPECT_EQ(problem_of_place({}), "");
    EXPECT_EQ(problem_of_place({Mat3(-1e-6), Vec3(9e6)}), "") << "mirrored, small and far";
}

TEST(SceneFrame, SaysWhatToDoWhereItIsNoPlace) {
    for (const double bad : {none, endless, -endless}) {
        EXPECT_NE(problem_of_place({Mat3(1.0), Vec3(0, bad, 0)}).find("finite"), std::string::npos);
        EXPECT_NE(problem_of_place({Mat3(bad), Vec3(0.0)}).find("finite"), std::string::npos);
        EXPECT_NE(problem_of_shape_frame({Mat3(bad), Vec3(0.0)}).find("finite"), std::string::npos);
    }
    EXPECT_NE(problem_of_place({Mat3(1e20), Vec3(0.0)}).find("scaled by 1e+20"), std::string::npos);
    EXPECT_NE(problem_of_place({Mat3(0.0), Vec3(0.0)}).find("scaled by 0"), std::string::npos);
    EXPECT_NE(problem_of_place({Mat3(1.0), Vec3(0, -1e30, 0)}).find("10,000 km"), std::string::npos);
}

TEST(SceneFrame, AShapeMayBeSmallButNotFlat) {
    EXPECT_EQ(problem_of_shape_frame({Mat3(1e-9), {}}), "");
    EXPECT_NE(problem_of_shape_frame({scale(1, 0, 1), {}}).find("scaled to zero"), std::string::npos);
}

}  // namespace
}  // namespace tactus::scene_frame_test
