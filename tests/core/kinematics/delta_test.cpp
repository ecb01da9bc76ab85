#include "core/kinematics/delta.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "shared/delta_figures.hpp"
#include "shared/random_values.hpp"

namespace tactus::delta_test {
namespace {

class EachFalcon : public testing::TestWithParam<DeltaGeometry> {};
INSTANTIATE_TEST_SUITE_P(Delta, EachFalcon, testing::Values(falcon_geometry, falcon_geometry_martin),
                         [](const auto& given) { return given.index == 0 ? "Libnifalcon" : "Martin"; });

TEST_P(EachFalcon, GoesThereAndBackAndPushesWhereItIsTold) {
    const shared::DeltaFigures figures = shared::check_delta(GetParam(), 1, 20'000);
    EXPECT_EQ(figures.lost, 0);
    EXPECT_LE(figures.round_trip_rad, 1e-9);
    EXPECT_LE(figures.round_trip_m, 1e-9);
    EXPECT_LE(figures.jacobian_error, 1e-6);
    EXPECT_LE(figures.force_direction_deg, 0.1);
    EXPECT_LE(figures.force_size_error, 1e-6);
    EXPECT_LE(figures.steps_warm, 4);
}

// The geometry itself, in the legs' own frames: bars and rods keep their lengths.
TEST_P(EachFalcon, RodsAreAsLongAsTheyAre) {
    const DeltaGeometry& g = GetParam();
    shared::RandomValues random(2);
    for (int i = 0; i < 1'000; ++i) {
        const Vec3 place = shared::sound_place(g, random);
        const DeltaPose pose = delta_pose(g, place);
        for (int leg = 0; leg < 3; ++leg) {
            const double phi = g.leg_angles[static_cast<std::size_t>(leg)];
            const Vec3 out(std::cos(phi), std::sin(phi), 0.0);
            const Vec3 side(-std::sin(phi), std::cos(phi), 0.0);
            const Vec3 elbow = out * (g.base_out + g.upper_arm * std::cos(pose.angles[leg])) +
                               side * g.base_sideways +
                               Vec3(0.0, 0.0, g.upper_arm * std::sin(pose.angles[leg]));
            const Vec3 joint = place + out * g.platform_out + side * g.platform_sideways;
            const Vec3 reach = joint - elbow;
            // Out of the leg's plane only a rod leans, in it the bars add to its length.
            const double lean = glm::dot(reach, side);
            const double in_plane = glm::length(reach - side * lean) - g.bars;
            EXPECT_NEAR(std::hypot(lean, in_plane), g.rod_length, 1e-12);
            EXPECT_NEAR(glm::length(pose.rods[static_cast<std::size_t>(leg)]), 1.0, 1e-12);
        }
    }
}

TEST_P(EachFalcon, VelocityIsThatOfThePlace) {
    const DeltaGeometry& g = GetParam();
    shared::RandomValues random(3);
    for (int i = 0; i < 1'000; ++i) {
        const Vec3 place = shared::sound_place(g, random);
        const Vec3 velocity = random.in_ball(1.0);
        const Vec3 rates = shared::numeric_jacobian(g, place) * velocity;
        EXPECT_LT(glm::length(delta_velocity(delta_pose(g, place), rates) - velocity), 1e-6);
    }
}

TEST_P(EachFalcon, TorquesAndForcesAreEachOthersInverse) {
    shared::RandomValues random(4);
    for (int i = 0; i < 1'000; ++i) {
        const DeltaPose pose = delta_pose(GetParam(), shared::sound_place(GetParam(), random));
        const Vec3 force = random.in_ball(10.0);
        EXPECT_LT(glm::length(delta_force(pose, delta_torques(pose, force)) - force), 1e-12);
    }
}

// Round the axis the legs are alike: what one does, the next does a third of a turn on.
TEST_P(EachFalcon, LooksTheSameFromEachLeg) {
    const DeltaGeometry& g = GetParam();
    shared::RandomValues random(5);
    for (int i = 0; i < 1'000; ++i) {
        const Vec3 place = shared::sound_place(g, random);
        const double turn = g.leg_angles[1] - g.leg_angles[0];
        const Vec3 turned(std::cos(turn) * place.x - std::sin(turn) * place.y,
                          std::sin(turn) * place.x + std::cos(turn) * place.y, place.z);
        EXPECT_NEAR(delta_pose(g, place).angles[0], delta_pose(g, turned).angles[1], 1e-12);
    }
}

TEST(Delta, OutOfReachIsSaid) {
    EXPECT_EQ(delta_pose(falcon_geometry, {0.0, 0.0, 0.3}).state, DeltaState::out_of_reach);
    EXPECT_EQ(delta_pose(falcon_geometry, {0.3, 0.0, 0.1}).state, DeltaState::out_of_reach);
    EXPECT_EQ(delta_pose(falcon_geometry, {NAN, 0.0, 0.1}).state, DeltaState::out_of_reach);
}

// Along its axis until the arms are straight: it is said before, and ever less is left.
TEST(Delta, StraightArmsAreApproachedWithLessAndLessClearance) {
    DeltaGeometry free = falcon_geometry;
    free.highest_angle = 3.0;
    DeltaPose last;
    double clearance = 1.0;
    for (double way = 0.0; way < 0.2; way += 1e-4) {
        const DeltaPose pose = delta_pose(free, delta_centre(free) + Vec3(0.0, 0.0, way));
        if (pose.state == DeltaState::out_of_reach) {
            break;
        }
        EXPECT_LE(pose.clearance, clearance + 1e-12) << way;
        clearance = pose.clearance;
        last = pose;
    }
    EXPECT_EQ(last.clearance, 0.0);
    EXPECT_EQ(last.state, DeltaState::leg_straight);
}

// The product of the sizes of the Jacobian, taken numerically, and of its inverse: a sphere has 3.
TEST_P(EachFalcon, SoundPlacesAreWellConditionedAndEverySingularityIsMet) {
    const auto size = [](const Mat3& m) {
        return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
    };
    shared::RandomValues random(6);
    std::array<int, 6> met{};
    for (int i = 0; i < 200'000; ++i) {
        const Vec3 place(random.between(-0.12, 0.12), random.between(-0.12, 0.12), random.between(0.0, 0.2));
        const DeltaPose pose = delta_pose(GetParam(), place);
        ++met[static_cast<std::size_t>(pose.state)];
        if (pose.state == DeltaState::sound) {
            const Mat3 numeric = shared::numeric_jacobian(GetParam(), place);
            EXPECT_LT(size(numeric) * size(glm::inverse(numeric)), 40.0);
        }
    }
    EXPECT_GT(met[static_cast<std::size_t>(DeltaState::leg_straight)], 100);
    EXPECT_GT(met[static_cast<std::size_t>(DeltaState::leg_sideways)], 100);
    EXPECT_GT(met[static_cast<std::size_t>(DeltaState::platform_loose)], 100);
}

TEST(Delta, AnglesThatNoPlaceHasAreNotFound) {
    const DeltaPlace found = delta_place(falcon_geometry, {3.0, -0.4, -0.4}, delta_centre(falcon_geometry));
    EXPECT_FALSE(found.found);
    EXPECT_FALSE(delta_place(falcon_geometry, {NAN, 0.0, 0.0}, delta_centre(falcon_geometry)).found);
}

}  // namespace
}  // namespace tactus::delta_test
