#include "core/haptics/measured_field.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace tactus::measured_field_test {
namespace {

constexpr HandMotion hand{{0.1, -0.2, 0.3}, {0.4, 0.5, -0.6}};
const Mat3 springs{{-300.0, 20.0, 0.0}, {10.0, -100.0, 5.0}, {0.0, 0.0, -50.0}};
const Mat3 dampers{{-3.0, 0.5, 0.0}, {0.0, -2.0, 0.0}, {0.1, 0.0, -1.0}};

Vec3 linear(const HandMotion& at) {
    return springs * at.position + dampers * at.velocity + Vec3(1.0, 2.0, 3.0);
}

double largest(const Mat3& difference) {
    double all = 0.0;
    for (int i = 0; i < 3; ++i) {
        all = std::max(all, glm::length(difference[i]));
    }
    return all;
}

TEST(MeasuredField, WhatIsLinearIsMeasuredAsItIs) {
    const auto moment = measured_field(hand, [](const HandMotion& at) { return std::optional(linear(at)); });
    ASSERT_TRUE(moment.has_value());
    EXPECT_EQ(moment->place, hand.position);
    EXPECT_EQ(moment->velocity, hand.velocity);
    EXPECT_EQ(moment->force, linear(hand));
    EXPECT_LT(largest(moment->by_place - springs), 1e-9);
    EXPECT_LT(largest(moment->by_velocity - dampers), 1e-10);
}

TEST(MeasuredField, WhoeverHasOnceNoAnswerIsNotAskedAgain) {
    for (int answers = 0; answers < 7; ++answers) {
        int asked = 0;
        const auto moment = measured_field(hand, [&](const HandMotion& at) {
            return asked++ < answers ? std::optional(linear(at)) : std::nullopt;
        });
        EXPECT_FALSE(moment.has_value());
        EXPECT_EQ(asked, answers + 1);
    }
}

TEST(MeasuredField, WhatSeveralTellAddsUp) {
    FieldMoment sum;
    const FieldMoment one{hand.position, hand.velocity, {1.0, 0.0, 0.0}, Mat3(-100.0), Mat3(-1.0)};
    add(sum, one);
    EXPECT_EQ(sum.place, one.place);
    EXPECT_EQ(sum.by_place, one.by_place);
    add(sum, one);
    EXPECT_EQ(sum.velocity, one.velocity);
    EXPECT_EQ(sum.force, Vec3(2.0, 0.0, 0.0));
    EXPECT_EQ(sum.by_place, Mat3(-200.0));
    EXPECT_EQ(sum.by_velocity, Mat3(-2.0));
}

}  // namespace
}  // namespace tactus::measured_field_test
