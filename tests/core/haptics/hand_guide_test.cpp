#include "core/haptics/hand_guide.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "shared/random_values.hpp"

namespace tactus::hand_guide_test {
namespace {

using Form = HandGuide::Form;

HandGuide guide_of(Form form, std::initializer_list<Vec3> points) {
    HandGuide guide;
    guide.form = form;
    if (form == Form::way) {
        guide.way = GuideWay::of(points);
        return guide;
    }
    for (const Vec3& point : points) {
        guide.points[guide.count++] = point;
    }
    return guide;
}

TEST(HandGuide, LeadsToTheNearestPlace) {
    const Vec3 hand(0.3, 0.2, 0.1);
    const auto expect = [&](const HandGuide& guide, const Vec3& place) {
        EXPECT_EQ(check_guide(guide), "");
        EXPECT_LT(glm::distance(guided_place(guide, hand), place), 1e-12);
    };
    expect(guide_of(Form::point, {{1.0, 2.0, 3.0}}), {1.0, 2.0, 3.0});
    expect(guide_of(Form::line, {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}}), {0.3, 0.0, 0.0});
    expect(guide_of(Form::plane, {{0.0, 0.05, 0.0}, {1.0, 0.05, 0.0}, {0.0, 0.05, 1.0}}), {0.3, 0.05, 0.1});
    expect(guide_of(Form::way, {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}}), {0.1, 0.0, 0.0});
    expect(guide_of(Form::way, {{0.0, 0.0, 0.1}, {0.4, 0.0, 0.1}, {0.4, 0.4, 0.1}}), {0.4, 0.2, 0.1});
    expect(guide_of(Form::way, {{0.3, 0.2, 0.0}, {0.3, 0.2, 0.0}}), {0.3, 0.2, 0.0});
    EXPECT_EQ(check_guide({}), "");
}

TEST(HandGuide, PullsMostAtHalfItsRangeAndNotBeyondIt) {
    const auto pull = [](double distance) {
        return guide_force(HandGuide::Mode::attract, {0.0, distance, 0.0}, 0.04, 300.0).y;
    };
    EXPECT_EQ(pull(0.0), 0.0);
    EXPECT_NEAR(pull(1e-6), -300e-6, 1e-8);
    EXPECT_NEAR(pull(0.02), -300.0 * 0.04 / 4.0, 1e-12);
    EXPECT_GT(pull(0.019), pull(0.02));
    EXPECT_GT(pull(0.021), pull(0.02));
    EXPECT_EQ(pull(0.04), 0.0);
    EXPECT_EQ(pull(1.0), 0.0);
}

// Round a closed way of the hand it does no work: it is the slope of a potential.
TEST(HandGuide, MakesNoEnergy) {
    shared::RandomValues random(1406);
    for (const HandGuide& guide :
         {guide_of(Form::point, {{0.0, 0.0, 0.0}}), guide_of(Form::line, {{0.0, 0.0, 0.0}, {1.0, 1.0, 0.0}}),
          guide_of(Form::plane, {{0.0, 0.0, 0.0}, {1.0, 0.2, 0.0}, {0.0, 0.3, 1.0}}),
          guide_of(Form::way, {{-0.02, 0.0, 0.0}, {0.01, 0.01, 0.0}, {0.01, 0.01, 0.03}})}) {
        for (int round = 0; round < 20; ++round) {
            const Vec3 middle = random.in_box(0.02);
            const Vec3 u = random.in_box(0.03);
            const Vec3 v = random.in_box(0.03);
            double work = 0.0;
            double moved = 0.0;
            constexpr int steps = 20'000;
            const auto at = [&](double share) {
                const double a = 2.0 * 3.14159265358979 * share;
                return middle + u * std::cos(a) + v * std::sin(a);
            };
            for (int i = 0; i < steps; ++i) {
                const Vec3 from = at(static_cast<double>(i) / steps);
                const Vec3 to = at((i + 1.0) / steps);
                const Vec3 hand = 0.5 * (from + to);
                const auto mode = static_cast<HandGuide::Mode>(round % 3);
                const Vec3 force = guide_force(mode, hand - guided_place(guide, hand), 0.03, 200.0);
                work += glm::dot(force, to - from);
                moved += std::abs(glm::dot(force, to - from));
            }
            EXPECT_LT(std::abs(work), 1e-6 + 1e-4 * moved);
        }
    }
}

TEST(HandGuide, WhatLeadsNowhereIsSaid) {
    const auto says = [](const HandGuide& guide, const char* words) {
        EXPECT_NE(check_guide(guide).find(words), std::string::npos) << check_guide(guide);
    };
    says(guide_of(Form::point, {}), "too few points");
    says(guide_of(Form::line, {{0.0, 0.0, 0.0}}), "too few points");
    says(guide_of(Form::line, {{0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}}), "one place");
    says(guide_of(Form::plane, {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {3.0, 0.0, 0.0}}), "on a line");
    says(guide_of(Form::way, {{0.0, 0.0, 0.0}, {std::nan(""), 0.0, 0.0}}), "point 1");
    HandGuide guide = guide_of(Form::point, {{0.0, 0.0, 0.0}});
    guide.range = 0.0;
    says(guide, "no positive length");
    guide.range = 0.1;
    guide.stiffness = -1.0;
    says(guide, "below 0");
    HandGuide way = guide_of(Form::way, {});
    says(way, "too few points");
    way.way = nullptr;
    says(way, "too few points");
    way.way = GuideWay::of(std::vector<Vec3>(GuideWay::most + 1));
    says(way, "at most 4096");
    guide.stiffness = 1.0;
    guide.count = 17;
    says(guide, "few points");
    guide.count = 1;
    guide.frame.rotation = {0.0, 0.0, 0.0, 0.0};
    says(guide, "frame");
}

// What a file says of a way has to be what its points make.
TEST(HandGuide, AWayWhoseBlocksAreNotItsOwnIsRefused) {
    GuideWay way = *GuideWay::of({{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.2, 0.1, 0.0}});
    EXPECT_EQ(check_way(way), "");
    way.blocks[0].radius *= 0.5;
    EXPECT_NE(check_way(way), "");
    way.blocks.clear();
    EXPECT_NE(check_way(way), "");
}

TEST(HandGuide, TheNearestPlaceOnALongWayIsThatOfALookAtAllOfIt) {
    shared::RandomValues random(58);
    std::vector<Vec3> points{random.in_box(0.1)};
    while (points.size() < 1000) {
        points.push_back(points.back() + random.in_box(0.01));
    }
    const auto way = GuideWay::of(points);
    for (int i = 0; i < 300; ++i) {
        const Vec3 hand = points[static_cast<std::size_t>(3 * i)] + random.in_box(0.05);
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k + 1 < points.size(); ++k) {
            least = std::min(least,
                             glm::distance(hand, nearest_on_line(points[k], points[k + 1], hand, 0.0, 1.0)));
        }
        EXPECT_EQ(glm::distance(hand, nearest_on_way(*way, hand)), least) << i;
    }
}

TEST(HandGuide, EachModeIsItsClosedForm) {
    using Mode = HandGuide::Mode;
    const auto force = [](Mode mode, double d) { return guide_force(mode, {0.0, d, 0.0}, 0.04, 300.0).y; };
    EXPECT_NEAR(force(Mode::hold, 0.1), -300.0 * 0.1, 1e-9);
    EXPECT_NEAR(force(Mode::forbid, 0.03), 300.0 * 0.01, 1e-9);
    EXPECT_NEAR(force(Mode::forbid, 0.01), 300.0 * 0.03 * 0.5, 1e-9);
    EXPECT_EQ(force(Mode::forbid, 0.0), 0.0);
    EXPECT_EQ(force(Mode::forbid, 0.05), 0.0);
    EXPECT_NEAR(force(Mode::forbid, 0.02 + 1e-12), force(Mode::forbid, 0.02 - 1e-12), 1e-6);
}

TEST(HandGuide, NoneIsSteeperThanItSays) {
    using Mode = HandGuide::Mode;
    for (const Mode mode : {Mode::attract, Mode::hold, Mode::forbid}) {
        HandGuide guide = guide_of(Form::point, {{0.0, 0.0, 0.0}});
        guide.mode = mode;
        for (int i = 0; i < 1000; ++i) {
            const double d = 5e-5 * i;
            const Vec3 change = guide_force(mode, {d + 1e-7, 0.0, 0.0}, guide.range, guide.stiffness) -
                                guide_force(mode, {d, 0.0, 0.0}, guide.range, guide.stiffness);
            EXPECT_LE(std::abs(change.x), steepest(guide) * 1.0001e-7) << i;
        }
    }
}

}  // namespace
}  // namespace tactus::hand_guide_test
