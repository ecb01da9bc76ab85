// Tools that touch each other.
#include "core/tool/tool_group.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "shared/meshes.hpp"
#include "shared/pair_figures.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::tool_group_test {
namespace {

using shared::PairRig;

const Quat upright{1.0, 0.0, 0.0, 0.0};

Pose place(double x, double y, double z = 0.0, const Quat& rotation = upright) {
    return {{x, y, z}, rotation};
}

ToolSettings coupled(double stiffness, double friction = 0.0) {
    ToolSettings settings;
    settings.stiffness = stiffness;
    settings.turning_stiffness = 1e-3 * stiffness;
    settings.static_friction = settings.dynamic_friction = friction;
    return settings;
}

// A bar of 100 mm over a plate.
void add_bar_and_plate(PairRig& rig, const ToolSettings& bar, const ToolSettings& plate) {
    rig.add_tool(shared::box({0.05, 0.01, 0.01}), {1e-3, 300}, bar);
    rig.add_tool(shared::box({0.04, 0.02, 0.04}), {1e-3, 400}, plate);
    rig.ticks({place(0.0, 0.06), place(0.0, 0.0)}, 2);
}

TEST(ToolGroup, TwoHandsPressEachOtherAsTwoSpringsInSeries) {
    for (const double ratio : {1.0, 0.1, 20.0}) {
        PairRig rig;
        add_bar_and_plate(rig, coupled(1000.0), coupled(1000.0 * ratio));
        rig.ticks({place(0.0, 0.022), place(0.0, 0.0)}, 60);
        const double apart = rig.tool(0).pose().position.y - rig.tool(1).pose().position.y;
        EXPECT_NEAR(apart, 0.03, 1e-3);  // the spheres are inscribed
        const double expected = 1000.0 * ratio / (1.0 + ratio) * (apart - 0.022);
        EXPECT_NEAR(rig.last(0).force.y, expected, 2e-3 * expected) << ratio;
        EXPECT_NEAR(rig.last(1).force.y, -expected, 2e-3 * expected) << ratio;
        EXPECT_EQ(rig.last(0).status, static_cast<std::uint32_t>(tool_touching)) << ratio;
        EXPECT_GE(rig.least_gap(0), 0.0);
    }
}

// What a device cannot render of its coupling is not there for the other hand either.
TEST(ToolGroup, WhatAHandIsGivenIsBalanced) {
    PairRig rig;
    rig.add_tool(shared::box({0.05, 0.01, 0.01}), {1e-3, 300}, coupled(1000.0), 0.25);
    rig.add_tool(shared::box({0.04, 0.02, 0.04}), {1e-3, 400}, coupled(1000.0));
    rig.ticks({place(0.0, 0.06), place(0.0, 0.0)}, 2);
    rig.ticks({place(0.0, 0.022), place(0.0, 0.0)}, 60);
    EXPECT_GT(rig.last(0).force.y, 4.0);
    EXPECT_NEAR(0.25 * rig.last(0).force.y, -rig.last(1).force.y, 2e-3);
    for (std::size_t i = 0; i < 2; ++i) {
        Vec3 sum(0.0);
        for (const ToolMeeting& meeting : rig.tool(i).meetings()) {
            sum += meeting.force;
            EXPECT_EQ(meeting.other, &rig.tool(1 - i));
        }
        EXPECT_LT(glm::distance(sum, rig.last(i).force), 0.01 * glm::length(sum)) << i;
    }
}

TEST(ToolGroup, ForcesAndTorquesAreThoseOfASlowBalance) {
    for (const double ratio : {1.0, 0.1, 10.0}) {
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const shared::PairFigures figures = shared::press_pair(ratio, seed);
            EXPECT_LT(figures.tool.force_error, 1.0) << ratio << " " << seed;
            EXPECT_LT(figures.tool.torque_error, 1.0) << ratio << " " << seed;
            EXPECT_LT(figures.balance_error, 0.1) << ratio << " " << seed;
            EXPECT_EQ(figures.tool.still_way, 0.0) << ratio << " " << seed;
            EXPECT_EQ(figures.tool.penetrations, 0) << ratio << " " << seed;
        }
    }
}

// Pressed by another tool against a wall, and held by a third one from behind.
TEST(ToolGroup, PressedAgainstAWallByAnotherItIsInBalanceToo) {
    PairRig rig;
    rig.add_wall(shared::box({0.5, 0.05, 0.5}), {500.0, 0.0, 0.0, 0.0}, {{0.0, -0.05, 0.0}, upright});
    rig.add_tool(shared::box({0.03, 0.01, 0.02}), {1e-3, 300}, coupled(800.0));
    rig.add_tool(shared::box({0.02, 0.015, 0.03}), {1e-3, 300}, coupled(2000.0));
    rig.ticks({place(0.0, 0.02), place(0.005, 0.07)}, 2);
    const std::vector<Pose> hands{place(0.0, 0.012),
                                  place(0.005, 0.028, 0.002, glm::angleAxis(0.05, Vec3(1, 0, 0)))};
    rig.ticks(hands, 60);
    const std::vector<Wrench> slow = rig.slow_balance(hands);
    for (std::size_t i = 0; i < 2; ++i) {
        const ToolTick& last = rig.last(i);
        EXPECT_LT(glm::distance(last.force, slow[i].force), 0.01 * glm::length(slow[i].force)) << i;
        EXPECT_LT(glm::distance(last.torque, slow[i].torque), 0.01 * glm::length(slow[i].torque) + 1e-5) << i;
        EXPECT_EQ(last.status, static_cast<std::uint32_t>(tool_touching)) << i;
    }
    EXPECT_GT(rig.last(1).force.y, 5.0);
    // The wall bears what both press with.
    Vec3 borne(0.0);
    for (const ToolTouch& touch : rig.tool(0).touching()) {
        borne += touch.force;
    }
    EXPECT_NEAR(borne.y, rig.last(0).force.y + rig.last(1).force.y, 0.02);
    EXPECT_GE(rig.least_gap(0), 0.0);
    EXPECT_GE(rig.least_wall_gap(), 0.0);
}

TEST(ToolGroup, ThreeInARowPressThroughTheMiddleOne) {
    PairRig rig;
    for (const double stiffness : {1000.0, 500.0, 2000.0}) {
        rig.add_tool(shared::box({0.02, 0.01, 0.02}), {1e-3, 200}, coupled(stiffness));
    }
    rig.ticks({place(0.0, 0.0), place(0.0, 0.03), place(0.0, 0.06)}, 2);
    const std::vector<Pose> hands{place(0.0, 0.003), place(0.002, 0.017), place(-0.001, 0.032)};
    rig.ticks(hands, 80);
    const std::vector<Wrench> slow = rig.slow_balance(hands);
    Vec3 sum(0.0);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_LT(glm::distance(rig.last(i).force, slow[i].force), 0.01 * glm::length(slow[0].force)) << i;
        EXPECT_EQ(rig.last(i).status, static_cast<std::uint32_t>(tool_touching)) << i;
        sum += rig.last(i).force;
    }
    EXPECT_LT(glm::length(sum), 2e-3 * glm::length(slow[0].force));
    EXPECT_LT(rig.last(0).force.y, -1.0);
    EXPECT_GT(rig.last(2).force.y, 1.0);
    EXPECT_GE(std::min(rig.least_gap(0), rig.least_gap(2)), 0.0);
}

TEST(ToolGroup, HandsAtRestMoveNothing) {
    PairRig rig;
    add_bar_and_plate(rig, coupled(1000.0, 0.4), coupled(700.0, 0.6));
    const std::vector<Pose> hands{
        place(0.01, 0.022, 0.003, glm::angleAxis(0.1, glm::normalize(Vec3(1, 0.3, 2)))),
        place(0.0, 0.0, 0.0, glm::angleAxis(-0.05, Vec3(0, 0, 1)))};
    rig.ticks(hands, 60);
    const Pose before[2] = {rig.tool(0).pose(), rig.tool(1).pose()};
    rig.ticks(hands, 200);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(rig.tool(i).pose().position, before[i].position);
        EXPECT_EQ(rig.tool(i).pose().rotation, before[i].rotation);
        EXPECT_GT(glm::length(rig.last(i).force), 1.0);
    }
}

// The lower friction of both counts.
TEST(ToolGroup, TheySlideOnEachOtherByCoulombsLaw) {
    const shared::PairFigures figures = shared::slide_pair();
    EXPECT_LT(figures.friction_error, 1.0);
    EXPECT_LT(figures.balance_error, 0.1);
    EXPECT_EQ(figures.tool.penetrations, 0);
}

TEST(ToolGroup, TheyStickWithinTheConeAndOneCarriesTheOther) {
    PairRig rig;
    add_bar_and_plate(rig, coupled(1000.0, 0.5), coupled(4000.0, 0.5));
    rig.ticks({place(0.0, 0.022), place(0.0, 0.0)}, 40);
    const auto on_plate = [&] { return to_local(rig.tool(1).pose(), rig.tool(0).pose().position); };
    const Vec3 before = on_plate();
    for (int i = 1; i <= 100; ++i) {
        rig.tick({place(0.0, 0.022), place(2e-5 * i, 0.0)});
    }
    EXPECT_LT(glm::distance(on_plate(), before), 2e-6);
    EXPECT_GT(rig.tool(0).pose().position.x, 1e-3);
    EXPECT_NEAR(rig.last(0).force.x, -rig.last(1).force.x, 5e-3);
    EXPECT_EQ(rig.last(0).status & tool_sliding, 0u);
}

// What sticks to a wall does so by static friction although another tool slides on it.
TEST(ToolGroup, WhatSlidesOnItDoesNotLoosenItFromAWall) {
    PairRig rig;
    rig.add_wall(shared::box({0.5, 0.05, 0.5}), {500.0, 0.0, 0.9, 0.1}, {{0.0, -0.05, 0.0}, upright});
    ToolSettings patient = coupled(1000.0, 0.2);
    patient.max_work = 100'000;
    rig.add_tool(shared::box({0.06, 0.01, 0.03}), {1e-3, 400}, patient);
    rig.add_tool(shared::box({0.02, 0.01, 0.02}), {1e-3, 200}, patient);
    rig.ticks({place(0.0, 0.02), place(-0.02, 0.05)}, 2);
    rig.ticks({place(0.0, 0.002), place(-0.02, 0.022)}, 40);
    const double before = rig.tool(0).pose().position.x;
    std::uint32_t seen = 0;
    for (int i = 1; i <= 200; ++i) {
        rig.tick({place(0.0, 0.002), place(-0.02 + 1e-4 * i, 0.022)});
        seen |= rig.last(1).status;
    }
    EXPECT_NE(seen & tool_sliding, 0u);
    EXPECT_NEAR(rig.tool(0).pose().position.x, before, 1e-6);
    EXPECT_GT(rig.tool(1).pose().position.x, -0.01);
}

// One is in the other's hollow, and both hands leap and turn as no hand can.
TEST(ToolGroup, NeitherComesThroughTheOther) {
    testing::AuditScope audit;
    const shared::PairFigures figures = shared::rub_pair(2'000, 2'000, 3);
    EXPECT_EQ(figures.tool.passes, 0);
    EXPECT_EQ(figures.tool.penetrations, 0) << figures.tool.deepest;
    EXPECT_GT(figures.tool.contact_ticks, 1'000);
    EXPECT_EQ(figures.tool.still_way, 0.0);
}

// Both turn about places far off: the way of the one, seen from the other, bends most.
TEST(ToolGroup, LeversThatTurnFastMeet) {
    PairRig rig;
    const auto lever = [](double stiffness) {
        ToolSettings settings = coupled(stiffness);
        settings.turning_stiffness = 10.0 * stiffness;
        return settings;
    };
    TriangleMesh blade = shared::box({0.1, 0.004, 0.01});
    for (Vec3& vertex : blade.vertices) {
        vertex.x += 0.1;  // held at its end
    }
    rig.add_tool(blade, {1e-3, 300}, lever(1000.0));
    rig.add_tool(blade, {1e-3, 300}, lever(1000.0));
    const auto swung = [](double x, double angle) {
        return place(x, 0.0, 0.0, glm::angleAxis(angle, Vec3(0, 0, 1)));
    };
    const double half = std::numbers::pi;
    rig.ticks({swung(-0.15, 0.6), swung(0.15, half - 0.2)}, 2);
    double deepest = 0.0;
    double crossed = 0.0;
    for (int i = 0; i < 60; ++i) {
        const double by = 0.05 * i;
        rig.tick({swung(-0.15, 0.6 - by), swung(0.15, half - 0.2 - by)});
        deepest = std::max(deepest, -rig.least_gap(0));
        // The tip of the one, seen from the other's side: from above it stays above.
        const Vec3 tip = to_local(rig.tool(1).pose(), to_parent(rig.tool(0).pose(), Vec3(0.2, 0.0, 0.0)));
        crossed = std::max(crossed, tip.x > 0.0 && tip.x < 0.2 ? tip.y : 0.0);
    }
    EXPECT_EQ(deepest, 0.0);
    EXPECT_EQ(crossed, 0.0);
}

TEST(ToolGroup, LittleWorkLeavesThemUnfinishedAndNeverThrough) {
    PairRig rig;
    ToolSettings slow = coupled(1000.0, 0.4);
    slow.max_work = 600;
    rig.add_tool(shared::box({0.05, 0.01, 0.01}), {1e-3, 300}, slow);
    rig.add_tool(shared::box({0.04, 0.02, 0.04}), {1e-3, 400}, slow);
    rig.ticks({place(0.0, 0.3), place(0.0, 0.0)}, 2);
    int unfinished = 0;
    double deepest = 0.0;
    for (int i = 0; i < 400; ++i) {
        const double y = i < 200 ? 0.06 - 2e-4 * i : 0.02;
        rig.tick({place(0.01, y, 0.0, glm::angleAxis(0.3 * std::sin(0.1 * i), Vec3(0.6, 0.0, 0.8))),
                  place(0.0, 0.0)});
        unfinished += (rig.last(0).status & tool_unfinished) != 0;
        deepest = std::max(deepest, -rig.least_gap(0));
        EXPECT_LT(rig.work(), 4 * slow.max_work + 4'000) << i;
    }
    EXPECT_GT(unfinished, 50);
    EXPECT_EQ(deepest, 0.0);
    EXPECT_GT(rig.tool(0).pose().position.y, 0.0);
}

TEST(ToolGroup, EachHasToBeInALayerOfTheOthersMask) {
    for (const bool first : {true, false}) {
        for (const bool second : {true, false}) {
            PairRig rig;
            ToolSettings bar = coupled(1000.0), plate = coupled(1000.0);
            bar.layer = 2;
            plate.layer = 4;
            bar.mask = first ? 4u : 1u;
            plate.mask = second ? 2u : 1u;
            add_bar_and_plate(rig, bar, plate);
            rig.ticks({place(0.0, 0.022), place(0.0, 0.0)}, 20);
            EXPECT_EQ(!rig.tool(0).meetings().empty(), first && second);
            EXPECT_EQ(glm::length(rig.last(1).force) > 1.0, first && second);
        }
    }
}

// In each other when their masks begin to say so: they pass until they have been apart.
TEST(ToolGroup, MasksThatChangeFindThemInEachOther) {
    PairRig rig;
    ToolSettings blind = coupled(1000.0);
    blind.mask = 2;
    add_bar_and_plate(rig, blind, coupled(1000.0));
    rig.ticks({place(0.0, 0.0), place(0.0, 0.0)}, 5);
    rig.tool(0).set_settings(coupled(1000.0));
    rig.ticks({place(0.0, 0.01), place(0.0, 0.0)}, 5);
    EXPECT_LT(glm::length(rig.last(0).force), 1e-9);
    rig.ticks({place(0.0, 0.05), place(0.0, 0.0)}, 2);
    rig.ticks({place(0.0, 0.02), place(0.0, 0.0)}, 40);
    EXPECT_GT(rig.last(0).force.y, 1.0);
    EXPECT_GE(rig.least_gap(0), 0.0);
}

TEST(ToolGroup, AToolBeginsOnlyWhereItIsInNoOther) {
    PairRig rig;
    add_bar_and_plate(rig, coupled(1000.0), coupled(1000.0));
    rig.tool(0).restart();
    rig.ticks({place(0.0, 0.0), place(0.0, 0.0)}, 3);  // wholly inside
    EXPECT_EQ(rig.last(0).status, static_cast<std::uint32_t>(tool_absent));
    EXPECT_EQ(rig.last(1).status, 0u);
    rig.ticks({place(0.0, 0.02), place(0.0, 0.0)}, 3);  // through its side
    EXPECT_EQ(rig.last(0).status, static_cast<std::uint32_t>(tool_absent));
    rig.ticks({place(0.0, 0.04), place(0.0, 0.0)}, 3);
    EXPECT_EQ(rig.last(0).status, 0u);
}

// To the bit.
TEST(ToolGroup, AToolByItselfIsAsWithoutAGroup) {
    PairRig pair;
    pair.add_wall(shared::box({0.5, 0.05, 0.5}), {500.0, 0.0, 0.5, 0.4}, {{0.0, -0.05, 0.0}, upright});
    pair.add_tool(shared::box({0.05, 0.01, 0.01}), {1e-3, 300});
    pair.add_tool(shared::box({0.05, 0.01, 0.01}), {1e-3, 300});
    shared::ToolRig alone(shared::box({0.05, 0.01, 0.01}), {1e-3, 300});
    alone.add(shared::box({0.5, 0.05, 0.5}), {500.0, 0.0, 0.5, 0.4}, {{0.0, -0.05, 0.0}, upright});
    for (int i = 0; i < 200; ++i) {
        const Pose hand = place(1e-4 * i, i < 20 ? 0.02 : 0.005, 0.0,
                                glm::angleAxis(0.1 * std::sin(0.05 * i), Vec3(0, 0, 1)));
        const ToolTick tick = alone.tick(hand);
        pair.tick({hand, place(0.0, 5.0)});
        ASSERT_EQ(pair.last(0).pose.position, tick.pose.position) << i;
        ASSERT_EQ(pair.last(0).force, tick.force) << i;
        ASSERT_EQ(pair.last(0).status, tick.status) << i;
    }
}

TEST(ToolGroup, IsTheSameOnEveryRunAndAllocatesNothing) {
    const auto play = [] {
        PairRig rig;
        rig.add_wall(shared::box({0.5, 0.05, 0.5}), {500.0, 0.0, 0.5, 0.4}, {{0.0, -0.05, 0.0}, upright});
        for (int i = 0; i < 4; ++i) {
            rig.add_tool(shared::box({0.02, 0.01, 0.02}), {1e-3, 200}, coupled(500.0 * (1 + i), 0.1 * i));
        }
        std::vector<Pose> hands;
        for (int i = 0; i < 4; ++i) {
            hands.push_back(place(0.0, 0.02 + 0.03 * i));
        }
        rig.ticks(hands, 2);
        testing::AuditScope audit;
        for (int i = 0; i < 300; ++i) {
            for (int t = 0; t < 4; ++t) {
                hands[static_cast<std::size_t>(t)].position +=
                    Vec3(1e-5 * t, -1e-4, 1e-5 * std::sin(0.1 * i * t));
            }
            rig.tick(hands);
        }
        audit.finish();
        EXPECT_EQ(audit.allocations() + audit.frees(), 0u) << audit.describe();
        std::vector<double> seen;
        for (std::size_t t = 0; t < 4; ++t) {
            const ToolTick& last = rig.last(t);
            seen.insert(seen.end(), {last.pose.position.x, last.pose.position.y, last.pose.rotation.z,
                                     last.force.y, last.torque.x});
        }
        return seen;
    };
    EXPECT_EQ(play(), play());
}

// Tried out and taken back.
TEST(ToolGroup, GoesOnFromWhatItRemembers) {
    PairRig rig;
    ToolSettings patient = coupled(1000.0, 0.4);
    patient.max_work = 100'000;  // what its work has ended goes on from where it was
    add_bar_and_plate(rig, patient, patient);
    const std::vector<Pose> pressed{place(0.003, 0.022), place(0.0, 0.0)};
    rig.ticks(pressed, 40);
    const ToolMemory memories[2] = {rig.tool(0).memory(), rig.tool(1).memory()};
    rig.tick({place(0.01, 0.02, 0.01), place(0.0, 0.002)});
    const Vec3 once = rig.last(0).force;
    rig.ticks({place(0.1, 0.2), place(0.0, -0.1)}, 3);
    for (std::size_t i = 0; i < 2; ++i) {
        rig.tool(i).recall(memories[i], rig.scene());
    }
    rig.tick({place(0.01, 0.02, 0.01), place(0.0, 0.002)});
    EXPECT_LT(glm::distance(rig.last(0).force, once), 1e-2 * glm::length(once));
    EXPECT_GE(rig.least_gap(0), 0.0);
}

// Put into each other from outside: no force, and each again as soon as they are apart.
TEST(ToolGroup, WhatIsPutDeepIntoAnotherPassesUntilItIsApart) {
    PairRig rig;
    add_bar_and_plate(rig, coupled(1000.0), coupled(1000.0));
    ToolMemory inside = rig.tool(0).memory();
    inside.pose = place(0.0, 0.0);
    rig.tool(0).recall(inside, rig.scene());
    rig.ticks({place(0.0, 0.0), place(0.0, 0.0)}, 3);
    EXPECT_LT(glm::length(rig.last(0).force), 1e-9);
    rig.ticks({place(0.0, 0.05), place(0.0, 0.0)}, 3);
    rig.ticks({place(0.0, 0.02), place(0.0, 0.0)}, 40);
    EXPECT_GT(rig.last(0).force.y, 1.0);
}

// A body that carries one of them stops it at the other; a correction does as well.
TEST(ToolGroup, ACorrectionTakesItNoFartherThanTheOther) {
    PairRig rig;
    add_bar_and_plate(rig, coupled(1000.0), coupled(1000.0));
    rig.ticks({place(0.0, 0.035), place(0.0, 0.0)}, 3);
    rig.tool(0).go_along(rig.scene(), place(0.0, -0.2), -1);
    EXPECT_GT(rig.tool(0).pose().position.y, 0.028);
    EXPECT_GE(rig.least_gap(0), 0.0);
}

}  // namespace
}  // namespace tactus::tool_group_test
