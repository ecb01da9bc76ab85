#include "core/haptics/measured_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
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

FieldMoment told_at(const Vec3& place) {
    FieldMoment moment;
    moment.place = place;
    return moment;
}

// 5 N along z for z <= 0.
std::optional<Vec3> wall(const HandMotion& at) {
    return Vec3(0.0, 0.0, at.position.z <= 0.0 ? 5.0 : 0.0);
}

// Between which two of its samples the line leaps (unit: meters).
double width_of_leap(const FieldLine& line) {
    double width = 0.0;
    for (std::size_t i = 1; i < static_cast<std::size_t>(line.count); ++i) {
        width = line.force[i] != line.force[i - 1] ? line.at[i] - line.at[i - 1] : width;
    }
    return width;
}

TEST(MeasuredField, WhatIsLinearIsMeasuredAsItIs) {
    const auto moment = measured_field(hand, told_at({0.1, -0.2, 0.29}),
                                       [](const HandMotion& at) { return std::optional(linear(at)); });
    ASSERT_TRUE(moment.has_value());
    EXPECT_EQ(moment->place, hand.position);
    EXPECT_EQ(moment->velocity, hand.velocity);
    EXPECT_EQ(moment->force, linear(hand));
    EXPECT_LT(largest(moment->by_place - springs), 1e-9);
    EXPECT_LT(largest(moment->by_velocity - dampers), 1e-10);
    ASSERT_EQ(moment->line.count, FieldLine::most);
    EXPECT_LT(glm::distance(moment->line.direction, Vec3(0.0, 0.0, 1.0)), 1e-9) << "the way that it went";
    for (std::size_t i = 0; i < FieldLine::most; ++i) {
        const Vec3 place = hand.position + moment->line.at[i] * moment->line.direction;
        EXPECT_LT(glm::distance(moment->line.force[i], linear({place, hand.velocity})), 1e-9) << i;
    }
}

TEST(MeasuredField, WhoeverHasOnceNoAnswerIsNotAskedAgain) {
    for (int answers = 0; answers < answers_of_a_field; ++answers) {
        int asked = 0;
        const auto moment = measured_field(hand, told_at(hand.position), [&](const HandMotion& at) {
            return asked++ < answers ? std::optional(linear(at)) : std::nullopt;
        });
        EXPECT_FALSE(moment.has_value());
        EXPECT_EQ(asked, answers + 1);
    }
}

TEST(MeasuredField, ALeapIsFoundWithinAFractionOfAMillimeter) {
    for (const double off : {1e-4, -7e-4, 2.3e-3, -4e-3}) {
        const HandMotion beside{{0.0, 0.0, off}, Vec3(0.0)};
        const auto moment = measured_field(beside, told_at({0.0, 0.0, off + 1e-3}), wall);
        ASSERT_TRUE(moment.has_value());
        EXPECT_GT(width_of_leap(moment->line), 0.0) << off;
        EXPECT_LT(width_of_leap(moment->line), 3.5e-4) << off;
    }
}

// Who slides along a wall that a script makes goes across its normal, and presses along it.
TEST(MeasuredField, TheLineStandsOnALeapAndNotOnTheWayOfAHandThatSlidesAlongIt) {
    FieldMoment moment = *measured_field({{0.0, 0.0, 1e-3}, Vec3(0.0)}, told_at({-1e-3, 0.0, 2e-3}), wall);
    EXPECT_GT(moment.line.direction.x, 0.5) << "it came aslant";
    for (int i = 1; i < 20; ++i) {
        moment = *measured_field({{2e-3 * i, 0.0, 2e-4 * (i % 3 - 1)}, Vec3(0.0)}, moment, wall);
        EXPECT_NEAR(std::abs(moment.line.direction.z), 1.0, 1e-9) << i;
    }
}

TEST(MeasuredField, AHandThatRestsKeepsItsLine) {
    const auto wind = [](const HandMotion&) { return std::optional(Vec3(1.0, 0.0, 0.0)); };
    FieldMoment moment = *measured_field({{0.0, 1e-3, 0.0}, Vec3(0.0)}, told_at(Vec3(0.0)), wind);
    moment = *measured_field({{0.0, 1e-3, 0.0}, Vec3(0.0)}, moment, wind);
    EXPECT_EQ(moment.line.direction, Vec3(0.0, 1.0, 0.0));
}

}  // namespace
}  // namespace tactus::measured_field_test
