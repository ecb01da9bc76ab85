#include "core/proxy/constrained_step.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "shared/random_values.hpp"

namespace tactus::constrained_step_test {
namespace {

using shared::RandomValues;

constexpr double sphere_radius = 0.1;

struct Sample {
    Contact contact;
    Curvature curvature;
};

Sample flat(const Vec3& normal, double gap = 0.0) {
    Sample sample{{normal, gap, {}, ContactState::solid}, {}};
    const Vec3 other = std::abs(normal.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    sample.curvature.u = glm::normalize(glm::cross(normal, other));
    return sample;
}

ConstrainedStep step_over(const Vec3& pull, std::span<const Sample> samples,
                          double trust = std::numeric_limits<double>::infinity()) {
    ContactList list;
    for (const Sample& sample : samples) {
        list.add(sample.contact);
    }
    WorkBudget work(1'000'000);
    ConstrainedStep step = flat_step(pull, list, 1e-12, work);
    Curvature pressing[3];
    for (int i = 0; i < step.pressing_count; ++i) {
        pressing[i] = samples[static_cast<std::size_t>(step.pressing[i])].curvature;
    }
    if (step.pressing_count < 3) {
        bend_step(step, pull, list, {pressing, static_cast<std::size_t>(step.pressing_count)},
                  {sphere_radius, 1e-12, trust}, work);
    }
    return step;
}

Vec3 lift(std::span<const Sample> samples) {
    ContactList list;
    for (const Sample& sample : samples) {
        list.add(sample.contact);
    }
    WorkBudget work(1'000'000);
    return lift_to_rest(list, 1e-12, work);
}

TEST(ConstrainedStep, GoesAllTheWayWithoutContacts) {
    const ConstrainedStep step = step_over({1.0, 2.0, 3.0}, {});
    EXPECT_EQ(step.motion, Vec3(1.0, 2.0, 3.0));
    EXPECT_EQ(step.pressing_count, 0);
}

TEST(ConstrainedStep, AFlatContactTakesThePullAcrossIt) {
    const Sample contacts[] = {flat({0.0, 1.0, 0.0})};
    const ConstrainedStep step = step_over({1.0, -2.0, 0.5}, contacts);
    EXPECT_LT(glm::length(step.motion - Vec3(1.0, 0.0, 0.5)), 1e-15);
    ASSERT_EQ(step.pressing_count, 1);
    EXPECT_NEAR(step.pressure[0], 2.0, 1e-15);
}

TEST(ConstrainedStep, AContactWithAGapLetsTheProxyCloseIt) {
    const Sample contacts[] = {flat({0.0, 1.0, 0.0}, 0.25)};
    EXPECT_NEAR(step_over({0.0, -2.0, 0.0}, contacts).motion.y, -0.25, 1e-15);
}

TEST(ConstrainedStep, AContactBelowRestPushesOut) {
    const Sample contacts[] = {flat({0.0, 1.0, 0.0}, -1e-9)};
    EXPECT_NEAR(step_over({0.0, -2.0, 0.0}, contacts).motion.y, 1e-9, 1e-15);
}

TEST(ConstrainedStep, PullAwayLeavesTheSurface) {
    const Sample contacts[] = {flat({0.0, 1.0, 0.0})};
    const ConstrainedStep step = step_over({0.0, 2.0, 0.0}, contacts);
    EXPECT_EQ(step.motion, Vec3(0.0, 2.0, 0.0));
    EXPECT_EQ(step.pressing_count, 0);
}

TEST(ConstrainedStep, ContactsTooNarrowToLeaveHoldStill) {
    const Sample contacts[] = {flat({0.0, 1.0, 0.0}, -1e-6), flat({0.0, -1.0, 0.0}, -1e-6)};
    const ConstrainedStep step = step_over({0.0, -2.0, 0.0}, contacts);
    EXPECT_LT(glm::length(step.motion), 1e-6);
    const ConstrainedStep along = step_over({1.0, -2.0, 0.0}, contacts);
    EXPECT_NEAR(along.motion.x, 1.0, 1e-12);
}

// On a sphere of radius R the resting place is where the normal points to the hand; from a small angle away
// one curved step must land there up to the square of the angle.
TEST(ConstrainedStep, CurvatureMakesTheStepOntoASphereSecondOrder) {
    constexpr double radius = 0.5;
    for (const double angle : {1e-2, 1e-3, 1e-4}) {
        const Vec3 hand(0.0, 0.8 * radius, 0.0);
        const Vec3 normal(std::sin(angle), std::cos(angle), 0.0);
        const Vec3 at = radius * normal;
        Sample contact = flat(normal);
        contact.curvature.bend_u = contact.curvature.bend_v = 1.0 / radius;
        const ConstrainedStep step = step_over(hand - at, {&contact, 1});
        const Vec3 reached = glm::normalize(at + step.motion);
        EXPECT_LT(std::abs(reached.x), 2.0 * angle * angle) << angle;
    }
}

TEST(ConstrainedStep, CurvatureMakesTheStepOntoAnEdgeSecondOrderAcrossAndExactAlong) {
    constexpr double radius = 0.1;
    const double angle = 1e-3;
    const Vec3 hand(0.0, 0.05, 0.03);
    const Vec3 normal(std::sin(angle), std::cos(angle), 0.0);
    Sample contact = flat(normal);
    contact.curvature.u = Vec3(std::cos(angle), -std::sin(angle), 0.0);
    contact.curvature.bend_u = 1.0 / radius;
    const ConstrainedStep step = step_over(hand - radius * normal, {&contact, 1});
    const Vec3 reached = radius * normal + step.motion;
    EXPECT_NEAR(reached.z, 0.03, 1e-12);
    EXPECT_LT(std::abs(reached.x), radius * 2.0 * angle * angle);
}

// Below a sphere that rolls over it along x.
Sample edge_below() {
    Sample edge = flat({0.0, 1.0, 0.0});
    edge.contact.state = ContactState::edge;
    edge.curvature.u = Vec3(1.0, 0.0, 0.0);
    edge.curvature.bend_u = 1.0 / sphere_radius;
    return edge;
}

// Over an edge, three radii above the hand, with something 1e-4 ahead whose plane ends the way after 0.01.
ConstrainedStep step_beside(ContactState state) {
    Sample ahead = flat(glm::normalize(Vec3(-0.01, 1.0, 0.0)), 1e-4);
    ahead.contact.state = state;
    const Sample contacts[] = {edge_below(), ahead};
    return step_over({1e-3, -3.0 * sphere_radius, 0.0}, contacts, 0.03);
}

TEST(ConstrainedStep, WhatFallsAwayBesideItEndsNoBentStep) {
    for (const ContactState state : {ContactState::seen, ContactState::edge, ContactState::corner}) {
        const ConstrainedStep step = step_beside(state);
        EXPECT_TRUE(step.bent);
        EXPECT_NEAR(step.motion.x, 0.03, 1e-9);
    }
}

TEST(ConstrainedStep, AFaceInItsWayLeavesHalvesOfABentStep) {
    for (const ContactState state : {ContactState::face, ContactState::solid}) {
        const ConstrainedStep step = step_beside(state);
        EXPECT_TRUE(step.bent);
        EXPECT_LE(step.motion.x, 0.01 * (1.0 + 1e-4));
        EXPECT_GE(step.motion.x, 0.005);
    }
}

// What it is about to run into is met on a way that falls away from it later.
TEST(ConstrainedStep, WhatIsMetOnTheWayEndsABentStep) {
    Sample ahead = flat(glm::normalize(Vec3(-0.1, 1.0, 0.0)), 1e-6);
    ahead.contact.state = ContactState::corner;
    const Sample contacts[] = {edge_below(), ahead};
    const Vec3 motion = step_over({1e-6, -3.0 * sphere_radius, 0.0}, contacts, 0.05).motion;
    const Vec3 corner = -ahead.contact.normal * (sphere_radius + ahead.contact.gap);
    for (int i = 0; i <= 1'000; ++i) {
        EXPECT_GE(glm::distance(1e-3 * i * motion, corner), sphere_radius * (1.0 - 1e-9));
    }
}

// Around an edge that the hand is behind, a step leads to where the edge ends and not beyond.
TEST(ConstrainedStep, AnEdgeIsBelievedInUpToItsEnd) {
    constexpr double radius = 0.1;
    Sample contact = flat({0.0, 1.0, 0.0});
    contact.curvature.u = Vec3(1.0, 0.0, 0.0);
    contact.curvature.bend_u = 1.0 / radius;
    contact.curvature.add_end({Vec3(0.5, 0.0, 0.0), 0.5 * 0.02});
    contact.curvature.add_end({Vec3(-1.0, 0.0, 0.0), 0.03});
    for (const double side : {1.0, -1.0}) {
        const Vec3 pull(side * 1e-3, -3.0 * radius, 0.0);
        const double reached = step_over(pull, {&contact, 1}).motion.x * side;
        const double end = side > 0.0 ? 0.02 : 0.03;
        EXPECT_GE(reached, end);
        EXPECT_LE(reached, 1.01 * end);
    }
}

// What is not trusted is the bent step: a flat one goes as far as the pull.
TEST(ConstrainedStep, ABentStepGoesNoFartherThanItIsTrusted) {
    constexpr double radius = 0.1;
    Sample contact = flat({0.0, 1.0, 0.0});
    contact.curvature.bend_u = contact.curvature.bend_v = 1.0 / radius;
    const Vec3 pull(1e-3, -0.9 * radius, 0.0);
    EXPECT_NEAR(step_over(pull, {&contact, 1}).motion.x, 1e-2, 1e-12);
    EXPECT_NEAR(step_over(pull, {&contact, 1}, 4e-3).motion.x, 4e-3, 1e-12);
    EXPECT_NEAR(step_over(pull, {&contact, 1}, 1e-5).motion.x, 1e-3, 1e-12);
}

TEST(ConstrainedStep, CoveredContactsDoNotCount) {
    Sample covered = flat({0.0, 1.0, 0.0});
    covered.contact.state = ContactState::covered;
    EXPECT_EQ(step_over({0.0, -1.0, 0.0}, {&covered, 1}).motion, Vec3(0.0, -1.0, 0.0));
}

TEST(ConstrainedStep, LiftIsTheShortestWayToRest) {
    std::vector<Sample> list{flat({0.0, 1.0, 0.0}, -1e-6), flat({1.0, 0.0, 0.0}, 2.0)};
    EXPECT_LT(glm::distance(lift(list), Vec3(0.0, 1e-6, 0.0)), 1e-15);
    list.push_back(flat({1.0, 0.0, 0.0}, -2e-6));
    EXPECT_LT(glm::distance(lift(list), Vec3(2e-6, 1e-6, 0.0)), 1e-15);
}

// Whatever the contacts: no step may cross a contact plane, as the surfaces behind them are convex.
TEST(ConstrainedStep, NeverCrossesAContactPlane) {
    RandomValues random(71);
    for (int i = 0; i < 20'000; ++i) {
        std::vector<Sample> contacts;
        for (int k = 0; k < 1 + random.below(6); ++k) {
            contacts.push_back(flat(random.direction(), random.flip() ? 0.0 : random.magnitude(1e-9, 1e-2)));
            if (random.flip()) {
                contacts.back().curvature.bend_u = random.magnitude(0.1, 100.0);
                contacts.back().curvature.bend_v = random.flip() ? contacts.back().curvature.bend_u : 0.0;
            }
        }
        const Vec3 pull = random.in_ball(0.2);
        const ConstrainedStep step = step_over(pull, contacts);
        for (const Sample& sample : contacts) {
            ASSERT_GE(glm::dot(sample.contact.normal, step.motion), -sample.contact.gap - 1e-10)
                << "case " << i;
        }
        for (int k = 0; k < step.pressing_count; ++k) {
            ASSERT_GT(step.pressure[k], 0.0);
        }
    }
}

// Without bends the step is a descent: it never ends farther from the hand than it began.
TEST(ConstrainedStep, NeverMovesAwayFromTheHandOverFlatContacts) {
    RandomValues random(72);
    for (int i = 0; i < 20'000; ++i) {
        std::vector<Sample> contacts;
        for (int k = 0; k < 1 + random.below(6); ++k) {
            contacts.push_back(flat(random.direction(), random.flip() ? 0.0 : random.magnitude(1e-9, 1e-2)));
        }
        const Vec3 pull = random.in_ball(0.2);
        const ConstrainedStep step = step_over(pull, contacts);
        ASSERT_LE(glm::length(pull - step.motion), glm::length(pull) + 1e-10) << "case " << i;
    }
}

}  // namespace
}  // namespace tactus::constrained_step_test
