// A tool of spheres against surfaces at rest.
#include "core/tool/tool_proxy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <memory>
#include <numbers>
#include <random>

#include "shared/deforms.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/tool_figures.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::tool_proxy_test {
namespace {

using shared::ToolRig;

const Quat upright{1.0, 0.0, 0.0, 0.0};

// A bar of 100 mm over a floor of two triangles.
ToolRig bar_over_floor(const TouchMaterial& material = {}) {
    ToolRig rig(shared::box({0.05, 0.01, 0.01}), {1e-3, 400});
    rig.add(shared::box({0.5, 0.05, 0.5}), material, {{0.0, -0.05, 0.0}, upright});
    return rig;
}

ToolTick settle(ToolRig& rig, const Pose& hand, int ticks = 30) {
    ToolTick last;
    for (int i = 0; i < ticks; ++i) {
        last = rig.tick(hand);
    }
    return last;
}

// High above the floor, up to 2.8 m and twice that angle from where it was.
Pose hand_in_air(shared::RandomValues& random, double angle) {
    const Vec3 place = random.in_box(1.0);
    const Vec3 axis = random.direction();
    return {{place.x, 0.5, place.z}, glm::angleAxis(random.between(-angle, angle), axis)};
}

TEST(ToolProxy, InTheAirItIsTheHand) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        ToolRig rig = bar_over_floor();
        shared::RandomValues random(seed);
        rig.tick({{0.0, 0.5, 0.0}, upright});
        for (int i = 0; i < 50; ++i) {
            const ToolTick tick = rig.tick(hand_in_air(random, 0.5));
            EXPECT_EQ(tick.status, 0u) << seed << ", " << i;
            EXPECT_LT(glm::length(tick.force), 1e-9);
            EXPECT_LT(glm::length(tick.torque), 1e-9);
        }
    }
}

TEST(ToolProxy, WhatATurnBeyondAnyHandsLeavesIsSaidAndMadeUpInTheNextTick) {
    int unfinished = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        ToolRig rig = bar_over_floor();
        shared::RandomValues random(seed);
        rig.tick({{0.0, 0.5, 0.0}, upright});
        for (int i = 0; i < 50; ++i) {
            const Pose hand = hand_in_air(random, 1.0);
            ToolTick tick = rig.tick(hand);
            if (tick.status != 0) {
                EXPECT_EQ(tick.status, static_cast<std::uint32_t>(tool_unfinished)) << seed << ", " << i;
                tick = rig.tick(hand);
                ++unfinished;
            }
            EXPECT_LT(glm::length(tick.force), 1e-9) << seed << ", " << i;
            EXPECT_LT(glm::length(tick.torque), 1e-9) << seed << ", " << i;
        }
    }
    EXPECT_GT(unfinished, 0) << "or it was no test";
}

TEST(ToolProxy, AHandThatIsNoPlaceIsWhereItWasLast) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    ToolRig rig = bar_over_floor();
    const Pose pressing{{0.0, 0.005, 0.0}, upright};
    settle(rig, {{0.0, 0.02, 0.0}, upright}, 2);
    const ToolTick before = settle(rig, pressing);
    for (const Pose& nonsense :
         {Pose{{none, 0.0, 0.0}, upright}, Pose{{0.0, 1e300, 0.0}, upright},
          Pose{{0.0, 0.0, 0.0}, {none, 0, 0, 0}}, Pose{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0}},
          Pose{{0.0, 0.0, 0.0}, {1e200, 0.0, 0.0, 0.0}}}) {
        const ToolTick tick = rig.tick(nonsense);
        EXPECT_EQ(tick.pose.position, before.pose.position);
        EXPECT_EQ(tick.force, before.force);
        EXPECT_EQ(tick.torque, before.torque);
    }
}

// Pressed flat onto the floor 5 mm deep: 1000 N/m. Turned by 0.1 about its short axis, 1 N m/rad, it stays
// flat.
TEST(ToolProxy, LiesFlatAndGivesTheForceAndTorqueOfTheCoupling) {
    ToolRig rig = bar_over_floor();
    settle(rig, {{0.0, 0.02, 0.0}, upright}, 2);
    settle(rig, {{0.0, 0.012, 0.0}, upright}, 2);
    const double corner = rig.proxy().shape().tolerance;  // the spheres are inscribed
    ToolTick tick = settle(rig, {{0.0, 0.005, 0.0}, upright});
    EXPECT_NEAR(tick.force.y, 5.0, 1e3 * corner);
    EXPECT_LT(glm::length(tick.torque), 1e-2);
    tick = settle(rig, {{0.0, 0.005, 0.0}, glm::angleAxis(0.1, Vec3(0.0, 0.0, 1.0))});
    EXPECT_NEAR(tick.torque.z, -0.1, 2e-3);
    EXPECT_GE(rig.least_gap(), 0.0);
}

TEST(ToolProxy, ForceAndTorqueAreThoseOfASlowBalance) {
    ToolRig rig = bar_over_floor();
    rig.add(shared::icosphere(1, 0.02), {}, {{0.02, 0.02, 0.003}, upright});
    settle(rig, {{0.0, 0.08, 0.0}, upright}, 2);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> chance(-1.0, 1.0);
    for (int i = 0; i < 6; ++i) {
        const Vec3 axis = glm::normalize(Vec3(chance(random), chance(random), chance(random)));
        const Pose hand{{0.01 * chance(random), 0.03 + 0.005 * chance(random), 0.01 * chance(random)},
                        glm::angleAxis(0.3 * chance(random), axis)};
        const ToolTick tick = settle(rig, hand, 60);
        const ToolRig::Balance slow = rig.slow_balance(hand);
        EXPECT_LE(glm::distance(tick.force, slow.force), 0.01 * glm::length(slow.force)) << i;
        EXPECT_LE(glm::distance(tick.torque, slow.torque), 0.01 * glm::length(slow.torque) + 1e-5) << i;
    }
}

// What contacts press with is what the coupling gives.
TEST(ToolProxy, ContactsAndCouplingAreInBalance) {
    ToolRig rig = bar_over_floor({500.0, 0.0, 0.5, 0.4});
    settle(rig, {{0.0, 0.05, 0.0}, upright}, 2);
    const Pose hand{{0.004, 0.006, 0.001}, glm::angleAxis(0.15, glm::normalize(Vec3(1.0, 0.2, 3.0)))};
    const ToolTick tick = settle(rig, hand, 60);
    Vec3 force(0.0), torque(0.0);
    for (const ToolTouch& touch : rig.proxy().touching()) {
        force += touch.force;
        torque += glm::cross(touch.point - tick.pose.position, touch.force);
    }
    EXPECT_GT(glm::length(tick.force), 1.0);
    EXPECT_LT(glm::distance(force, tick.force), 0.01 * glm::length(tick.force));
    EXPECT_LT(glm::distance(torque, tick.torque), 0.01 * glm::length(tick.torque) + 1e-4);
}

TEST(ToolProxy, AStillHandMovesItNotAtAll) {
    ToolRig rig = bar_over_floor({500.0, 0.0, 0.5, 0.4});
    settle(rig, {{0.0, 0.05, 0.0}, upright}, 2);
    const Pose hand{{0.004, 0.006, 0.001}, glm::angleAxis(0.15, glm::normalize(Vec3(1.0, 0.2, 3.0)))};
    settle(rig, hand, 60);
    const Pose before = rig.proxy().pose();
    settle(rig, hand, 200);
    EXPECT_EQ(rig.proxy().pose().position, before.position);
    EXPECT_EQ(rig.proxy().pose().rotation, before.rotation);
}

TEST(ToolProxy, SticksWithinTheConeAndSlidesBeyond) {
    for (const auto& [drawn, sticks] : {std::pair{0.0015, true}, std::pair{0.0060, false}}) {
        ToolRig rig = bar_over_floor({500.0, 0.0, 0.5, 0.3});
        settle(rig, {{0.0, 0.03, 0.0}, upright}, 2);
        settle(rig, {{0.0, 0.005, 0.0}, upright});
        const double pressed = rig.proxy().pose().position.y - 0.005;
        ToolTick tick;
        for (int i = 1; i <= 100; ++i) {
            tick = rig.tick({{drawn * i / 100.0, 0.005, 0.0}, upright});
        }
        tick = settle(rig, {{drawn, 0.005, 0.0}, upright});
        const double gone = rig.proxy().pose().position.x;
        if (sticks) {
            EXPECT_NEAR(gone, 0.0, 1e-5);
        } else {
            EXPECT_LE(drawn - gone, 0.5 * pressed + 1e-5);
            EXPECT_GE(drawn - gone, 0.3 * pressed - 1e-5);
        }
    }
}

TEST(ToolProxy, AFrictionImageMakesAFloorSlippery) {
    const TouchDetail detail{{nullptr, std::make_shared<const TouchImage>(TouchImage{1, 1, {0.5f}})}, {}};
    TouchMaterial material{500.0, 0.0, 0.6, 0.6};
    material.detail = &detail;
    ToolRig rig = bar_over_floor(material);
    settle(rig, {{0.0, 0.03, 0.0}, upright}, 2);
    settle(rig, {{0.0, 0.005, 0.0}, upright});
    const double pressed = rig.proxy().pose().position.y - 0.005;
    for (int i = 1; i <= 100; ++i) {
        rig.tick({{6e-5 * i, 0.005, 0.0}, upright});
    }
    settle(rig, {{0.006, 0.005, 0.0}, upright});
    EXPECT_NEAR(0.006 - rig.proxy().pose().position.x, 0.3 * pressed, 0.02 * pressed);
}

// A bar longer than the room is wide is turned in it as fast as no hand can: all spheres stay inside.
TEST(ToolProxy, FastTurnsInANarrowRoomLeadThroughNoWall) {
    ToolRig rig(shared::box({0.05, 0.01, 0.01}), {1e-3, 300});
    TriangleMesh room = shared::box({0.08, 0.04, 0.03});
    const std::size_t outside = room.triangles.size();
    for (std::size_t i = 0; i < outside; ++i) {  // seen from inside as well: nobody is within a solid
        const auto [a, b, c] = room.triangles[i];
        room.triangles.push_back({a, c, b});
    }
    rig.add(room);
    rig.tick({Vec3(0.0), upright});
    std::mt19937 random(9);
    std::uniform_real_distribution<double> chance(-1.0, 1.0);
    testing::AuditScope audit;
    double deepest = 0.0;
    bool inside = true;
    for (int i = 0; i < 400; ++i) {
        const Vec3 axis = glm::normalize(Vec3(chance(random), chance(random), chance(random)));
        const Pose hand{0.1 * Vec3(chance(random), chance(random), chance(random)),
                        glm::angleAxis(std::numbers::pi * chance(random), axis)};
        const ToolTick tick = rig.tick(hand);
        deepest = std::min(deepest, rig.least_gap());
        for (const ToolSphere& sphere : rig.proxy().shape().spheres) {
            const Vec3 place = glm::abs(to_parent(tick.pose, sphere.center));
            inside = inside && place.x < 0.08 && place.y < 0.04 && place.z < 0.03;
        }
    }
    audit.finish();
    EXPECT_TRUE(inside);
    EXPECT_EQ(deepest, 0.0);
    EXPECT_EQ(audit.allocations() + audit.frees(), 0u) << audit.describe();
}

TEST(ToolProxy, BeginsOnlyWhereItIsFree) {
    ToolRig rig = bar_over_floor();
    EXPECT_EQ(rig.tick({{0.0, -0.02, 0.0}, upright}).status, static_cast<std::uint32_t>(tool_absent));
    EXPECT_EQ(rig.tick({{0.0, 0.005, 0.0}, upright}).status, static_cast<std::uint32_t>(tool_absent));
    EXPECT_EQ(rig.tick({{0.0, 0.02, 0.0}, upright}).status, 0u);
}

// A sheet that passes between two balls on a stick meets neither.
TEST(ToolProxy, NeverBeginsAstrideAWall) {
    auto dumbbell = std::make_shared<ToolShape>();
    dumbbell->spheres = {{{-0.02, 0.0, 0.0}, 0.01}, {{0.02, 0.0, 0.0}, 0.01}};
    dumbbell->reach = 0.03;
    ToolProxy tool(dumbbell, 8, {});
    TouchScene scene(4, 8);
    const TriangleMesh sheet{{{0.0, -1.0, -1.0}, {0.0, 1.0, -1.0}, {0.0, 0.0, 1.0}}, {{0, 1, 2}}};
    const auto shape = shared::touch_of(sheet);
    scene.add(*shape, {}, {}, 1);
    const auto status_at = [&](double x) {
        scene.begin_tick();
        return tool.move(scene, {{x, 0.0, 0.0}, upright}).status;
    };
    EXPECT_EQ(status_at(0.0), static_cast<std::uint32_t>(tool_absent));
    EXPECT_EQ(status_at(0.005), static_cast<std::uint32_t>(tool_absent));
    EXPECT_EQ(status_at(0.031), 0u);
}

// It is not held there: it begins anew where the hand is out, and says so. What comes elsewhere is nothing to
// it, but that a force may be another one.
TEST(ToolProxy, ABodyThatComesToStandInItLetsItGo) {
    ToolRig rig = bar_over_floor();
    settle(rig, {{0.0, 0.02, 0.0}, upright}, 2);
    EXPECT_FALSE(settle(rig, {{0.0, 0.0, 0.0}, upright}).jumped);
    const auto touching = static_cast<std::uint32_t>(tool_touching);
    rig.add(shared::box(Vec3(0.02)), {}, {{0.3, 0.2, 0.0}, upright});
    const ToolTick beside = rig.tick({{0.0, 0.0, 0.0}, upright});
    EXPECT_TRUE(beside.jumped);
    EXPECT_EQ(beside.status & (tool_absent | tool_squeezed | touching), touching);
    EXPECT_FALSE(rig.tick({{0.0, 0.0, 0.0}, upright}).jumped);
    rig.add(shared::box(Vec3(0.2)), {}, {{0.0, 0.1, 0.0}, upright});
    const ToolTick within = rig.tick({{0.0, 0.0, 0.0}, upright});
    EXPECT_TRUE(within.jumped);
    EXPECT_EQ(within.status, static_cast<std::uint32_t>(tool_absent | tool_squeezed));
    EXPECT_EQ(within.force, Vec3(0.0));
    EXPECT_EQ(settle(rig, {{0.0, 0.1, 0.0}, upright}, 2).status, static_cast<std::uint32_t>(tool_absent));
    EXPECT_EQ(settle(rig, {{0.0, 0.4, 0.0}, upright}, 2).status, 0u);
    EXPECT_EQ(settle(rig, {{0.0, 0.3, 0.0}, upright}).status & touching, touching);
}

// A block that comes from the side takes a tool at rest along, and one that carries it lifts it.
TEST(ToolProxy, BodiesThatMoveTakeItAlong) {
    for (const Vec3& way : {Vec3(-1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0)}) {
        ToolRig rig(shared::box({0.05, 0.01, 0.01}), {1e-3, 400});
        const Vec3 from = way * -0.2;
        rig.add(shared::box(Vec3(0.05)), {500.0, 0.0, 0.5, 0.4}, {from, upright});
        rig.tick({Vec3(0.0), upright});
        double least = 1.0;
        for (int i = 1; i <= 200; ++i) {
            rig.carry(0, {from + way * (0.001 * i), upright});
            rig.tick({Vec3(0.0), upright});
            least = std::min(least, rig.least_gap());
        }
        EXPECT_GT(least, 0.0);
        const double extent = way.x != 0.0 ? 0.05 : 0.01;
        EXPECT_NEAR(glm::dot(rig.proxy().pose().position, way), 0.05 + extent, 1.1e-3);
    }
}

// One that turns under it and leaves carries it by friction, without slip.
TEST(ToolProxy, FrictionCarriesItAlong) {
    ToolRig rig = bar_over_floor({500.0, 0.0, 0.8, 0.7});
    settle(rig, {{0.0, 0.02, 0.0}, upright}, 2);
    settle(rig, {{0.0, 0.0, 0.0}, upright});
    for (int i = 1; i <= 50; ++i) {
        rig.carry(0, {{1e-5 * i, -0.05, 0.0}, upright});
        rig.tick({{0.0, 0.0, 0.0}, upright});
    }
    EXPECT_NEAR(rig.proxy().pose().position.x, 5e-4, 1e-6);
}

TEST(ToolProxy, APegGoesIntoItsHoleFromEveryAngle) {
    for (const double tilt : {0.0, 0.2, 0.5}) {
        for (const double around : {0.0, 2.0}) {
            const shared::ToolFigures figures = shared::play_peg(tilt, around, 4);
            EXPECT_EQ(figures.penetrations, 0) << tilt << " " << around;
            EXPECT_EQ(figures.passes, 0) << tilt << " " << around;
            EXPECT_EQ(figures.arrivals, 1) << tilt << " " << around;
            EXPECT_EQ(figures.still_way, 0.0) << tilt << " " << around;
        }
    }
}

// A block that comes from below at a speed, or from the side, or turning: the tool is driven before it.
TEST(ToolProxy, CitizenAFastBodyDrivesASmallToolBeforeIt) {
    for (const double speed : {2.0, 12.0, 25.0, 45.0}) {
        for (const Vec3& way : {Vec3(0.0, 1.0, 0.0), Vec3(0.8, 0.6, 0.0)}) {
            ToolRig rig(shared::box(Vec3(0.01)), {1e-3, 200});
            const Quat turned = glm::angleAxis(std::acos(way.y), Vec3(0.0, 0.0, -1.0));
            rig.add(shared::box({0.05, 0.05, 0.05}), {1000.0, 0.0, 0.0, 0.0}, {-0.3 * way, turned});
            rig.tick({});
            double gone = -0.3;
            while (gone < 0.2) {
                gone += 1e-3 * speed;
                rig.carry(0, {gone * way, turned});
                const ToolTick tick = rig.tick({});
                EXPECT_EQ(tick.status & (tool_absent | tool_squeezed), 0u) << speed << " m/s at " << gone;
                EXPECT_GT(glm::dot(tick.pose.position, way), gone + 0.05) << speed << " m/s at " << gone;
            }
        }
    }
}

// Beyond what bodies may do in a tick it begins anew, as it did.
TEST(ToolProxy, CitizenAToolIsNotCarriedFasterThanAPointer) {
    ToolRig rig(shared::box(Vec3(0.01)), {1e-3, 200});
    rig.add(shared::box({0.05, 0.05, 0.05}), {1000.0, 0.0, 0.0, 0.0}, {{0.0, -0.3, 0.0}, upright});
    rig.tick({});
    std::uint32_t seen = 0;
    for (double at = -0.3; at < 0.1; at += 0.08) {
        rig.carry(0, {{0.0, at, 0.0}, upright});
        seen |= rig.tick({}).status;
    }
    EXPECT_NE(seen & (tool_absent | tool_squeezed), 0u);
}

std::shared_ptr<const ToolShape> fine_peg() {
    static const auto peg = make_tool_shape(shared::box({0.01, 0.03, 0.01}), {2e-4, 4000}).shape;
    return peg;
}

// Five boxes that leave a square hole of 20.1 mm, 30 mm deep, and a hand that goes down into it.
struct SquareHole {
    SquareHole() : shape(fine_peg()), proxy(std::make_unique<ToolProxy>(shape, 16, ToolSettings{})) {
        constexpr double half = 0.01005;
        constexpr double wall = 0.02;
        add({wall, 0.015, 2.0 * wall + half}, {half + wall, 0.015, 0.0});
        add({wall, 0.015, 2.0 * wall + half}, {-half - wall, 0.015, 0.0});
        add({half, 0.015, wall}, {0.0, 0.015, half + wall});
        add({half, 0.015, wall}, {0.0, 0.015, -half - wall});
        add({0.2, 0.05, 0.2}, {0.0, -0.05, 0.0});
    }

    void add(const Vec3& half_extents, const Vec3& at) {
        const PlacedShape placed{BoxShape{half_extents}, {}};
        boxes.push_back(make_touch_shape({&placed, 1}).shape);
        scene.add(*boxes.back(), {at, upright}, TouchMaterial{1000.0, 0.0, 0.0, 0.0}, 1);
    }

    ToolTick tick(const Pose& hand) {
        scene.begin_tick();
        return proxy->move(scene, hand);
    }

    std::shared_ptr<const ToolShape> shape;
    std::vector<std::shared_ptr<const TouchShape>> boxes;
    TouchScene scene{16, 16};
    std::unique_ptr<ToolProxy> proxy;
};

// So many spheres are near a wall that one tick's work does not suffice for a look at all of them.
TEST(ToolProxy, CitizenAPegOfManySpheresGetsToTheBottomOfItsHole) {
    SquareHole hole;
    ASSERT_GT(hole.shape->spheres.size(), 1500u);
    for (int i = 0; i <= 2000; ++i) {
        hole.tick({{0.0, 0.07 - 0.045 * std::min(1.0, i / 1000.0), 0.0}, upright});
    }
    EXPECT_TRUE(hole.proxy->is_present());
    EXPECT_NEAR(hole.proxy->pose().position.y, 0.03, 2e-5);
    EXPECT_NEAR(hole.proxy->pose().position.x, 0.0, 5.1e-5);
}

TEST(ToolProxy, CitizenAPegLedSidewaysGetsToTheBottomOfItsHole) {
    for (const Vec3& aside : {Vec3(3e-4, 0.0, 0.0), Vec3(0.002, 0.0, 0.001), Vec3(0.0, 0.0, -0.005)}) {
        SquareHole hole;
        for (int i = 0; i <= 4000; ++i) {
            const Vec3 at(0.0, 0.07 - 0.045 * std::min(1.0, i / 1000.0), 0.0);
            hole.tick({i < 700 ? at : at + aside, upright});
        }
        EXPECT_TRUE(hole.proxy->is_present());
        EXPECT_NEAR(hole.proxy->pose().position.y, 0.03, 2e-5) << aside.x << ' ' << aside.z;
    }
}

// It is there as soon as it is known to be free, however many ticks that takes.
TEST(ToolProxy, CitizenAToolOfManySpheresAppearsInANarrowPlace) {
    for (const std::int64_t work : {6000, 12'000}) {
        SquareHole hole;
        ToolSettings settings;
        settings.max_work = work;
        hole.proxy->set_settings(settings);
        int ticks = 0;
        while (!hole.proxy->is_present() && ticks < 500) {
            hole.tick({{0.0, 0.04, 0.0}, upright});
            ++ticks;
        }
        EXPECT_LT(ticks, 500) << work;
    }
}

// What is tried out and taken back leaves the tool as it was, and what it knows of its surroundings true.
TEST(ToolProxy, WhatItRemembersIsAllThatItsNextMoveDependsOn) {
    ToolRig rig = bar_over_floor({500.0, 0.0, 0.5, 0.4});
    settle(rig, {{0.0, 0.05, 0.0}, upright}, 2);
    settle(rig, {{0.0, 0.006, 0.0}, upright});
    std::mt19937 random(3);
    std::uniform_real_distribution<double> chance(-1.0, 1.0);
    int finished = 0;
    for (int i = 0; i < 50; ++i) {
        const ToolMemory memory = rig.proxy().memory();
        const Pose first{{0.002 * chance(random), 0.006, 0.0},
                         glm::angleAxis(0.02 * chance(random), Vec3(0.0, 0.0, 1.0))};
        const ToolTick once = rig.tick(first);
        rig.tick({{0.05 * chance(random), -0.02, 0.03}, glm::angleAxis(chance(random), Vec3(0, 1, 0))});
        rig.proxy().recall(memory, rig.scene());
        EXPECT_EQ(rig.proxy().pose().position, memory.pose.position);
        const ToolTick again = rig.tick(first);
        // A tick that its work has ended goes on in the next.
        if (((once.status | again.status) & tool_unfinished) == 0) {
            ++finished;
            EXPECT_LT(glm::distance(again.force, once.force), 1e-3 * (1.0 + glm::length(once.force))) << i;
        }
        EXPECT_GE(rig.least_gap(), 0.0) << i;
    }
    EXPECT_GT(finished, 25);
}

// A correction that would take it through a wall takes it to the wall.
TEST(ToolProxy, GoesAlongWithACorrectionUpToWhatIsInTheWay) {
    ToolRig rig = bar_over_floor();
    rig.add(shared::box({0.01, 0.2, 0.2}), {}, {{0.1, 0.0, 0.0}, upright});
    settle(rig, {{0.0, 0.02, 0.0}, upright}, 2);
    settle(rig, {{0.0, 0.005, 0.0}, upright});
    const Pose before = rig.proxy().pose();
    rig.proxy().go_along(rig.scene(), {{0.01, 0.0, 0.0}, upright}, 0);
    EXPECT_NEAR(rig.proxy().pose().position.x - before.position.x, 0.01, 1e-9);
    rig.proxy().go_along(rig.scene(), {{0.5, 0.0, 0.0}, glm::angleAxis(0.2, Vec3(1.0, 0.0, 0.0))}, 0);
    EXPECT_LT(rig.proxy().pose().position.x, 0.045);
    EXPECT_GT(rig.proxy().pose().position.x, 0.03);
}

// On a floor that holds it, a body beside it that is corrected does not rub it along, but pushes it.
TEST(ToolProxy, GoesAlongWithWhatItRestsOnHardest) {
    for (const bool leans_on_wall : {false, true}) {
        ToolRig rig = bar_over_floor({500.0, 0.0, 0.1, 0.1});
        const int wall = 1;
        rig.add(shared::box({0.01, 0.2, 0.2}), {}, {{0.1, 0.0, 0.0}, upright});
        settle(rig, {{0.0, 0.03, 0.0}, upright}, 2);
        settle(rig, {{0.045, 0.03, 0.0}, upright});
        settle(rig, {leans_on_wall ? Vec3(0.07, 0.005, 0.0) : Vec3(0.045, -0.02, 0.0), upright}, 100);
        const Vec3 before = rig.proxy().pose().position;
        rig.proxy().go_along(rig.scene(), {{-0.001, 0.0, 0.002}, upright}, wall);
        const Vec3 way = rig.proxy().pose().position - before;
        EXPECT_NEAR(way.z, leans_on_wall ? 0.002 : 0.0, 1e-9);
        EXPECT_NEAR(way.x, -0.001, 1e-9);
    }
}

}  // namespace
}  // namespace tactus::tool_proxy_test
