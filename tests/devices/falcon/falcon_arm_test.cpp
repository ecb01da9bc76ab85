#include "devices/falcon/falcon_arm.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "shared/delta_figures.hpp"
#include "shared/random_values.hpp"

namespace tactus::falcon_arm_test {
namespace {

FalconReport at(const FalconData& data, const Vec3& place) {
    const Vec3 turned = (delta_pose(data.geometry, place).angles - data.zero_angles) *
                        (data.counts_a_turn * data.geometry.gear / (360.0 * delta_degrees));
    FalconReport report;
    for (int i = 0; i < 3; ++i) {
        report.encoders[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(std::lround(turned[i]));
    }
    report.homed = 7;
    return report;
}

TEST(FalconArm, FindsTheHandWithinItsEncodersSteps) {
    const FalconData data;
    shared::RandomValues random(1);
    for (int i = 0; i < 2'000; ++i) {
        FalconArm arm(data);
        const Vec3 place = shared::sound_place(data.geometry, random);
        DeviceSample sample;
        ASSERT_TRUE(arm.read(at(data, place), 0.001, sample));
        EXPECT_LT(glm::distance(sample.position + delta_centre(data.geometry), place), 4e-4);
    }
}

// Over many packets what rounding has left out is made up for.
TEST(FalconArm, TheMeanForceHasTheDirectionThatWasAsked) {
    const FalconData data;
    shared::RandomValues random(2);
    for (int i = 0; i < 200; ++i) {
        FalconArm arm(data);
        const Vec3 place = shared::sound_place(data.geometry, random);
        DeviceSample sample;
        ASSERT_TRUE(arm.read(at(data, place), 0.001, sample));
        const Vec3 read = sample.position + delta_centre(data.geometry);
        const Vec3 wanted = random.direction() * random.magnitude(0.05, 20.0);
        Vec3 mean(0.0);
        for (int packet = 0; packet < 1'000; ++packet) {
            const auto counts = arm.counts(wanted);
            for (int leg = 0; leg < 3; ++leg) {
                ASSERT_LE(std::abs(counts[static_cast<std::size_t>(leg)]), data.max_counts);
                mean[leg] +=
                    1e-3 * counts[static_cast<std::size_t>(leg)] * data.torque_a_count * data.geometry.gear;
            }
        }
        const Vec3 force = glm::transpose(shared::numeric_jacobian(data.geometry, read)) * mean;
        const double off = std::atan2(glm::length(glm::cross(force, wanted)), glm::dot(force, wanted));
        EXPECT_LT(off / delta_degrees, 0.1);
        EXPECT_LE(glm::length(force), glm::length(wanted) * 1.001);
    }
}

}  // namespace
}  // namespace tactus::falcon_arm_test
