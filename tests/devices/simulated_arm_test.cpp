#include "devices/simulated_arm.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace tactus::simulated_arm_test {
namespace {

HandPath resting(const Vec3& place) {
    KeyframePath path;
    path.keyframes.push_back({0, place});
    return path;
}

TEST(SimulatedArm, StaysOnItsPathWhereNothingPushes) {
    SimulatedArm arm(CircleWave{}, {});
    for (int tick = 0; tick <= 2000; ++tick) {
        const Nanoseconds now = 5'000'000 + tick * 1'000'000;
        const DeviceSample sample = arm.read(now);
        const HandSample intended = sample_path(CircleWave{}, now - 5'000'000);
        ASSERT_LT(glm::length(sample.position - intended.position), 0.01);
        arm.write(now, Vec3(0.0));
    }
}

TEST(SimulatedArm, GivesWayAsItsMusclesAllow) {
    const ArmSettings settings;
    SimulatedArm arm(resting(Vec3(0.0)), settings);
    DeviceSample sample;
    for (Nanoseconds tick = 0; tick < 5000; ++tick) {
        sample = arm.read(std::int64_t{tick} * 1'000'000);
        arm.write(tick * 1'000'000, {3.0, 0.0, 0.0});
    }
    EXPECT_NEAR(sample.position.x, 3.0 / settings.stiffness, 1e-9);
    EXPECT_NEAR(sample.velocity.x, 0.0, 1e-9);
}

TEST(SimulatedArm, WithoutDampingItKeepsItsEnergy) {
    ArmSettings settings;
    settings.damping = 0.0;
    ArmState arm{{0.1, 0.0, 0.0}, Vec3(0.0)};
    const auto energy = [&settings](const ArmState& state) {
        return 0.5 * settings.stiffness * glm::dot(state.position, state.position) +
               0.5 * settings.mass * glm::dot(state.velocity, state.velocity);
    };
    const double before = energy(arm);
    for (int i = 0; i < 10'000; ++i) {
        arm = step_arm(settings, arm, {Vec3(0.0), Vec3(0.0)}, Vec3(0.0), 0.001);
    }
    EXPECT_NEAR(energy(arm), before, 1e-9 * before);
}

TEST(SimulatedArm, SwingsAsFastAsItsMassAndMusclesSay) {
    ArmSettings settings;
    settings.damping = 0.0;
    const double period = 2.0 * 3.14159265358979 * std::sqrt(settings.mass / settings.stiffness);
    ArmState arm{{0.1, 0.0, 0.0}, Vec3(0.0)};
    const int steps = 1000;
    for (int i = 0; i < steps; ++i) {
        arm = step_arm(settings, arm, {Vec3(0.0), Vec3(0.0)}, Vec3(0.0), period / steps);
    }
    EXPECT_NEAR(arm.position.x, 0.1, 1e-5);
}

}  // namespace
TEST(SimulatedArm, BecomesAnotherOneWhereItIs) {
    const Vec3 rest(0.1, 0.2, 0.3);
    SimulatedArm arm(KeyframePath{{{0, rest}, {nanoseconds_per_second, rest}}}, {});
    arm.write(0, Vec3(0.0, 3.0, 0.0));
    for (int tick = 0; tick < 5000; ++tick) {
        arm.read(std::int64_t{tick} * 1'000'000);
    }
    const Vec3 before = arm.read(5'000'000'000).position;
    EXPECT_NEAR(before.y, rest.y + 3.0 / ArmSettings{}.stiffness, 1e-9);
    ArmSettings stiffer;
    stiffer.stiffness = 600.0;
    arm.change(stiffer);
    EXPECT_NEAR(arm.read(5'001'000'000).position.y, before.y, 1e-4);
    for (int tick = 5002; tick < 10000; ++tick) {
        arm.read(std::int64_t{tick} * 1'000'000);
    }
    EXPECT_NEAR(arm.read(10'000'000'000).position.y, rest.y + 3.0 / 600.0, 1e-9);
}

}  // namespace tactus::simulated_arm_test
