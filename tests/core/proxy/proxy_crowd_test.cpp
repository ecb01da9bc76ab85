// Where thousands of triangles are about as near as the one that is touched, the proxy still goes where it
// may: see crowd.hpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "core/haptics/force_law.hpp"
#include "core/proxy/proxy.hpp"
#include "shared/judge_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/reference_descent.hpp"
#include "shared/rough_meshes.hpp"
#include "shared/rough_paths.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::proxy_crowd_test {
namespace {

using shared::RandomValues;
using shared::TouchRig;

// One question among 256,000 triangles that grow from 1e-5 to 1 takes more than a tick here: to find what is
// touched, or how far the way is free. It never stands still for more than a tick or two.
TEST(ProxyCrowd, InACrowdThatTakesMoreThanATickItGoesOn) {
    constexpr double radius = 0.2;
    const TriangleMesh mesh = shared::graded(256, 500);
    const shared::JudgeTree judge(mesh);
    const std::vector<Vec3> way = shared::slow_scan(judge, radius, 450);
    for (const int work : {4'000, 8'000, 18'000}) {
        TouchRig rig(radius);
        rig.add(mesh);
        ProxySettings settings = rig.proxy.settings();
        settings.max_work = work;
        rig.proxy.set_settings(settings);
        int held = 0, longest = 0, unfinished = 0;
        for (std::size_t i = 0; i < way.size(); ++i) {
            const Vec3 before = rig.proxy.position();
            const ProxyTick tick = rig.tick(way[i]);
            const bool is_unfinished = (tick.status & proxy_unfinished) != 0;
            unfinished += is_unfinished;
            held = is_unfinished && glm::distance(before, tick.position) < 1e-4 * radius ? held + 1 : 0;
            longest = std::max(longest, held);
            if (i % 10 == 0) {
                ASSERT_GE(judge.nearest(tick.position, 2.0 * radius).distance, radius) << "tick " << i;
            }
        }
        EXPECT_LE(longest, 2) << "work " << work;
        EXPECT_GT(unfinished, 20) << "work " << work;
    }
}

// All edges of a rim lie within a ten-thousandth of the radius of a ball in a hole's mouth: to look at each
// once takes more than a tick. It rolls out of the mouth and back.
TEST(ProxyCrowd, InTheMouthOfABoreItGoesOn) {
    constexpr double wide = 0.1, height = 0.2, radius = 0.11;
    const TriangleMesh mesh = shared::bore(8'000, wide, height);
    const shared::JudgeTree judge(mesh);
    TouchRig rig(radius);
    rig.add(mesh);
    RandomValues random(3);
    Vec3 hand(0.0, height + 0.1, 0.0);
    Vec3 goal = hand;
    rig.tick(hand);
    shared::ReferenceDescent reference(judge, radius);
    int unfinished = 0, standing = 0, longest = 0, series = 0, astray = 0;
    for (int i = 0; i < 2'000; ++i) {
        if (i % 20 == 0) {
            goal = Vec3(0.0, height, 0.0) + random.in_ball(0.3);
        }
        hand += 0.1 * (goal - hand);
        const Vec3 before = rig.proxy.position();
        const ProxyTick tick = rig.tick(hand);
        const bool is_unfinished = (tick.status & proxy_unfinished) != 0;
        const bool stands = is_unfinished && glm::distance(before, tick.position) < 1e-3 * radius;
        unfinished += is_unfinished;
        standing += stands;
        series = stands ? series + 1 : 0;
        longest = std::max(longest, series);
        if (stands && standing % 5 == 0) {
            const shared::SlowVec3 end = reference.settle(tick.position, hand).position;
            astray += glm::distance(end, shared::SlowVec3(tick.position)) > 0.01 * radius;
        }
        ASSERT_GE(judge.nearest(tick.position, 2.0 * radius).distance, radius) << "tick " << i;
    }
    EXPECT_GT(unfinished, 50);
    EXPECT_LE(standing, 250);
    EXPECT_LE(longest, 30);
    EXPECT_LE(astray, 3);  // it stands where it sits in the mouth
}

// In a funnel's seat a ball touches all of its facets at once: to look at each takes more than a tick. It
// stays there, however many there are, and does not leave over the rim.
TEST(ProxyCrowd, InAFunnelsSeatItStays) {
    constexpr double radius = 0.12;
    struct Case {
        int count;
        double unevenness;
        int max_moving, max_unfinished;
    };
    for (const Case& played :
         {Case{1'024, 0.0, 5, 20}, {2'048, 0.0, 10, 30}, {8'192, 1.0, 10, 50}, {20'000, 0.0, 100, 250}}) {
        const TriangleMesh mesh = shared::funnel(played.count, played.unevenness);
        const shared::JudgeTree judge(mesh);
        TouchRig rig(radius);
        rig.add(mesh);
        const auto hand_at = [](int i) {
            const double down = std::min(i / 300.0, 1.0);
            return Vec3(0.3 * (1.0 - down) + 0.05 * std::sin(0.004 * i), 0.6 - 0.9 * down,
                        0.04 * std::sin(0.007 * i + 1.0));
        };
        Vec3 before = hand_at(0);
        double thrown = 0.0;
        int moving = 0, unfinished = 0;
        for (int i = 0; i < 1'500; ++i) {
            const Vec3 hand = hand_at(i);
            const ProxyTick tick = rig.tick(hand);
            thrown = std::max(thrown, glm::distance(tick.position, hand) - glm::distance(before, hand));
            moving += i >= 300 && glm::distance(before, tick.position) > 1e-3 * radius;
            unfinished += (tick.status & proxy_unfinished) != 0;
            ASSERT_GE(judge.nearest(tick.position, 2.0 * radius).distance, radius) << "tick " << i;
            before = tick.position;
        }
        // Its walls rise by 4 over 3: they would meet 4/3 of the throat's radius below it, and a sphere
        // between them is 5/3 of its radius above that.
        const Vec3 seat(0.0, -0.1 - 4.0 / 3.0 * 0.05 + 5.0 / 3.0 * radius, 0.0);
        EXPECT_LT(glm::distance(before, seat), 0.02 * radius) << played.count;
        EXPECT_LT(thrown, 0.11 * radius) << played.count;
        EXPECT_LE(moving, played.max_moving) << played.count;
        EXPECT_LE(unfinished, played.max_unfinished) << played.count;
    }
}

// A funnel whose throat is as wide as the ball that sits in it: 20,000 triangles touch it or nearly, and a
// sweep along them takes three ticks' work.
struct Throat {
    static constexpr double radius = 0.05;
    static constexpr int in_seat = 150;  // ticks until it sits there

    TouchRig rig{radius};
    int body = -1;

    explicit Throat(const TriangleMesh& mesh) {
        body = rig.add(mesh);
        for (int i = 0; i < in_seat; ++i) {
            rig.tick({0.01, std::max(-0.3, 0.3 - 0.006 * i), 0.01});
        }
    }
    // A hand outside that drags it up along the wall, for so many ticks.
    static Vec3 hand(int i) { return {std::min(0.3, 0.02 * i), -0.2 + std::min(0.2, 0.004 * i), 0.0}; }
};

TEST(ProxyCrowd, OutOfAThroatOfItsOwnSizeItComesInAFewTicks) {
    const TriangleMesh mesh = shared::funnel(5'000, 1.0);
    const shared::JudgeTree judge(mesh);
    Throat throat(mesh);
    ASSERT_LT(throat.rig.proxy.position().y, -0.09);
    int standing = 0;
    for (int i = 0; i < 100; ++i) {
        const Vec3 before = throat.rig.proxy.position();
        const ProxyTick tick = throat.rig.tick(Throat::hand(i));
        standing += (tick.status & proxy_unfinished) && tick.position == before;
        ASSERT_GE(judge.nearest(tick.position, 2.0 * Throat::radius).distance, Throat::radius)
            << "tick " << i;
    }
    EXPECT_LE(standing, 30);
    shared::ReferenceDescent reference(judge, Throat::radius);
    const Vec3 place = throat.rig.proxy.position();
    const shared::SlowVec3 end = reference.settle(place, Throat::hand(99)).position;
    EXPECT_LT(static_cast<double>(glm::distance(end, shared::SlowVec3(place))), 1e-3 * Throat::radius);
}

// While a sweep takes its ticks what it goes along may leave, or the proxy be put back.
TEST(ProxyCrowd, WhatALongSweepGoesAlongMayGo) {
    const TriangleMesh mesh = shared::funnel(5'000, 1.0);
    for (int ticks = 1; ticks < 8; ++ticks) {
        Throat throat(mesh);
        for (int i = 0; i < ticks; ++i) {
            throat.rig.tick(Throat::hand(40));
        }
        const ProxyMemory memory = throat.rig.proxy.memory();
        throat.rig.scene.remove(throat.body);
        EXPECT_EQ(throat.rig.tick(Throat::hand(41)).position, Throat::hand(41)) << ticks;
        throat.rig.proxy.recall(memory);
        EXPECT_EQ(throat.rig.tick(Throat::hand(42)).position, Throat::hand(42)) << ticks;
    }
}

// Where the work of a tick has ended before all that holds the proxy was seen, the force of what was is
// another one. It may jump then, and says so.
TEST(ProxyCrowd, NoForceJumpsUnsaid) {
    constexpr double radius = 0.05;
    constexpr int slower = 8;
    const TriangleMesh mesh = shared::funnel(5'000, 1.0);
    const shared::JudgeTree judge(mesh);
    const std::vector<Vec3> way = shared::fast_walk(judge, radius, 200);
    TouchRig rig(radius);
    rig.add(mesh);
    Vec3 last_hand = way.front();
    Vec3 last_force(0.0);
    int jumps = 0;
    for (std::size_t i = 0; i + slower < slower * way.size(); ++i) {
        const double share = static_cast<double>(i % slower) / slower;
        const Vec3 hand = glm::mix(way[i / slower], way[i / slower + 1], share);
        const ProxyTick tick = rig.tick(hand);
        const Vec3 force = contact_force(rig.scene, rig.proxy.touching(), tick.slide, Vec3(0.0), 1e-3).total;
        const double stiffness = TouchMaterial{}.stiffness;
        const double given = glm::distance(hand, last_hand);
        const bool steps = glm::distance(force, last_force) > stiffness * (5.0 * given + 0.001 * radius);
        ASSERT_TRUE(tick.jumped || !steps) << "tick " << i;
        jumps += tick.jumped && steps;
        last_hand = hand;
        last_force = force;
    }
    EXPECT_GT(jumps, 0);
}

}  // namespace
}  // namespace tactus::proxy_crowd_test
