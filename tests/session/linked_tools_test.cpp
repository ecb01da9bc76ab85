// A tool over a link: the operator's touches the model, the far side's follows it within its own contacts.
#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>

#include "core/math/wrench.hpp"
#include "linked_tools.hpp"
#include "recorded_inputs.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::linked_tools_test {
namespace {

using namespace session_test;

// The bar comes down beside the block, turns a little and pushes it along.
void push(HeldDevice& device, int tick) {
    const double t = 1e-3 * tick;
    const double along = 0.12 * std::clamp(t - 0.5, 0.0, 1.5);
    const double speed = t > 0.5 && t < 2.0 ? 0.12 : 0.0;
    const double angle = 0.15 * std::sin(2.0 * t);
    put(device, {-0.02 + along, 0.05, 0.015 * std::sin(3.0 * t)},
        glm::angleAxis(angle, glm::normalize(Vec3(0.1, 1.0, 0.05))), {speed, 0.0, 0.045 * std::cos(3.0 * t)});
}

TEST(LinkedTools, ARightModelFeelsAsWithoutALink) {
    LinkedTools linked(0.1);
    linked.add(floor_of(0.3));
    linked.add(block(0.3, 0.3));
    SessionRig alone(LinkedPlaces::session_settings());
    alone.session.remove_proxy(alone.proxy);
    let_turn(alone.device);
    alone.add(floor_of(0.3));
    const SessionHandle pushed = alone.add(block(0.3, 0.3));
    ASSERT_EQ(alone.session.add_tool(bar(), held_by(alone.hand)).error, "");
    linked.settle();
    alone.session.settle();
    double strongest = 0.0, most_turning = 0.0;
    for (int i = 0; i < 3'000; ++i) {
        push(linked.hand(), i);
        push(alone.device, i);
        linked.tick();
        alone.tick();
        const ToolState& mine = alone.newest().tools[0];
        // But for the hand's spin, which is told in whole microradians a second.
        ASSERT_LT(glm::distance(linked.ours().force, mine.force), 1e-4) << i;
        ASSERT_LT(glm::distance(linked.ours().torque, mine.torque), 1e-5) << i;
        ASSERT_LT(glm::distance(linked.hand().torque, alone.device.torque), 1e-5) << i;
        ASSERT_LT(linked.apart(1), 1e-6) << i;
        strongest = std::max(strongest, glm::length(mine.force));
        most_turning = std::max(most_turning, glm::length(mine.torque));
    }
    EXPECT_GT(strongest, 0.5);
    EXPECT_GT(most_turning, 0.005);
    EXPECT_GT(alone.state_of(pushed)->pose.position.x, 0.22);
    EXPECT_EQ(linked.statistics().corrections, 0u);
    // The far tool is where this one was a delay ago.
    linked.ticks(200);
    EXPECT_LT(glm::distance(linked.theirs().pose.position, linked.ours().pose.position), 1e-9);
}

struct Corrected {
    double apart = 0.0;           // of the two blocks in the end (unit: meters)
    double largest_step = 0.0;    // of the torque on the hand in a tick (unit: newton meters)
    double largest_torque = 0.0;  // (unit: newton meters)
    double force_step = 0.0;      // (unit: newtons)
    double corrections = 0.0;
};

Corrected push_wrong_block(Correction correction, double loss, const BodyAddition& believed) {
    TeleopSettings here;
    here.correction = correction;
    LinkedTools linked(0.1, loss, here);
    linked.add(floor_of(0.3));
    linked.add(block(0.3, 0.3), believed);
    linked.settle();
    Corrected seen;
    Vec3 torque(0.0), force(0.0);
    for (int i = 0; i < 3'000; ++i) {
        push(linked.hand(), i);
        linked.tick();
        const Vec3 now = linked.hand().torque;
        seen.largest_step = std::max(seen.largest_step, glm::distance(now, torque));
        seen.largest_torque = std::max(seen.largest_torque, glm::length(now));
        seen.force_step = std::max(seen.force_step, glm::distance(linked.hand().force, force));
        torque = now;
        force = linked.hand().force;
    }
    seen.apart = glm::distance(linked.near.pose(linked.watched[1]).position,
                               linked.far.pose(linked.watched[1]).position);
    seen.corrections = static_cast<double>(linked.statistics().corrections);
    return seen;
}

TEST(LinkedTools, AWrongMassAndFrictionAreCorrectedAndTheHandIsNotKicked) {
    BodyAddition wrong = block(0.6, 0.05);
    wrong.touch_material = {1000.0, 0.0, 0.05, 0.05};
    for (const double loss : {0.0, 0.3}) {
        const Corrected never = push_wrong_block(Correction::none, loss, wrong);
        const Corrected ours = push_wrong_block(Correction::stealthy_direction, loss, wrong);
        EXPECT_GT(never.apart, 1e-3) << loss;
        EXPECT_LT(ours.apart, 2e-4) << loss;
        EXPECT_GT(ours.corrections, 0.0);
        EXPECT_LT(ours.largest_torque, 0.3) << loss;
        EXPECT_LT(ours.largest_step, std::max(0.01, 1.5 * never.largest_step)) << loss;
        EXPECT_LT(ours.force_step, std::max(0.5, 1.5 * never.force_step)) << loss;
    }
}

TEST(LinkedTools, AWrongShapeAndPlaceAreCorrected) {
    BodyAddition wrong = block(0.3, 0.3, 0.21);
    wrong.description.shapes = {PlacedShape{BoxShape{{0.045, 0.05, 0.06}}, Pose{}}};
    const Corrected ours = push_wrong_block(Correction::stealthy_direction, 0.0, wrong);
    const Corrected never = push_wrong_block(Correction::none, 0.0, wrong);
    EXPECT_GT(never.apart, 3e-3);
    EXPECT_LT(ours.apart, 2e-4);
    EXPECT_LT(ours.largest_torque, 0.3);
}

// Every correction there is, on a body that is not where the model has it.
TEST(LinkedTools, EveryCorrectionLeavesTheToolOutsideAndFinite) {
    for (int scheme = 0; scheme <= static_cast<int>(Correction::passive); ++scheme) {
        const Corrected seen = push_wrong_block(static_cast<Correction>(scheme), 0.0, block(0.3, 0.3, 0.215));
        EXPECT_LT(seen.largest_torque, 1.0) << scheme;
        EXPECT_TRUE(std::isfinite(seen.force_step)) << scheme;
    }
}

// The operator knows of no wall. The far tool stays at it, and is there when the hand comes back.
TEST(LinkedTools, TheFarToolPassesNoWallHoweverFarTheHandGoes) {
    LinkedTools linked(0.05, 0.2);
    linked.far.session.add_body(body(BoxShape{{0.02, 0.3, 0.3}}, {0.2, 0.0, 0.0}, Motion::Static));
    linked.far.session.settle();
    put(linked.hand(), Vec3(0.0), Quat(1.0, 0.0, 0.0, 0.0));
    linked.ticks(50);
    double strongest = 0.0;
    for (int i = 0; i < 2'000; ++i) {
        const double t = 1e-3 * i;
        put(linked.hand(), {0.4 * std::sin(2.0 * t), 0.0, 0.0},
            glm::angleAxis(1.2 * std::sin(5.0 * t), Vec3(0.0, 0.0, 1.0)));
        linked.tick();
        for (const ToolSphere& sphere : bar()->spheres) {
            const Vec3 center = to_parent(linked.theirs().pose, sphere.center);
            ASSERT_LT(center.x + sphere.radius, 0.18 + 1e-6) << i;
        }
        strongest = std::max(strongest, glm::length(linked.theirs().force));
    }
    EXPECT_GT(strongest, 50.0);
}

TEST(LinkedTools, AHandThatIsLostLetsTheFarToolGoAndComesBackToIt) {
    LinkedTools linked(0.02);
    linked.add(floor_of(0.0));
    linked.settle();
    for (int i = 0; i < 300; ++i) {
        put(linked.hand(), {0.0, 0.05 - 0.00015 * i, 0.0}, Quat(1.0, 0.0, 0.0, 0.0));
        linked.tick();
    }
    EXPECT_GT(linked.theirs().force.y, 3.0);
    linked.lose_everything(true);
    linked.ticks(1'500);
    EXPECT_EQ(linked.theirs().force, Vec3(0.0));
    linked.lose_everything(false);
    linked.ticks(500);
    EXPECT_GT(linked.theirs().force.y, 3.0);
    EXPECT_GT(linked.theirs().pose.position.y, 0.009);
}

TEST(LinkedTools, TraditionalTouchBringsBackForceAndTorqueOneDelayLater) {
    TeleopSettings traditional;
    traditional.traditional = true;
    LinkedTools linked(0.04, 0.0, traditional, traditional);
    linked.add(floor_of(0.0));
    linked.settle();
    linked.ticks(100);
    std::vector<Wrench> here, there;
    for (int i = 0; i < 600; ++i) {
        const double down = std::min(1.0, 2.5e-3 * i);
        put(linked.hand(), {0.0, 0.05 - 0.045 * down, 0.0}, glm::angleAxis(0.08 * down, Vec3(0.0, 0.0, 1.0)));
        linked.tick();
        here.push_back({linked.ours().force, linked.ours().torque});
        there.push_back({linked.theirs().force, linked.theirs().torque});
    }
    EXPECT_GT(there.back().force.y, 3.0);
    EXPECT_LT(there.back().torque.z, -0.05);
    EXPECT_LT(glm::distance(here.back().force, there.back().force), 1e-3);
    EXPECT_LT(glm::distance(here.back().torque, there.back().torque), 1e-5);
    EXPECT_LT(glm::distance(linked.ours().pose.position, linked.theirs().pose.position), 1e-8);
    EXPECT_TRUE(linked.ours().status & tool_touching);
    // Twenty ticks after it was felt there, give or take one.
    const auto first = [](const std::vector<Wrench>& felt) {
        return std::ranges::find_if(felt, [](const Wrench& w) { return w.force.y > 0.5; }) - felt.begin();
    };
    EXPECT_NEAR(static_cast<double>(first(here) - first(there)), 20.0, 3.0);
    linked.lose_everything(true);
    linked.ticks(1'000);
    EXPECT_EQ(linked.hand().force, Vec3(0.0));
    EXPECT_EQ(linked.hand().torque, Vec3(0.0));
}

// A hand like an arm, pushed back by what it is told: over a delay that shakes it without an observer.
TEST(LinkedTools, KeptPassiveTraditionalTouchGivesNoMoreThanItWasGiven) {
    TeleopSettings traditional;
    traditional.traditional = true;
    traditional.passivity = Passivity::time_domain;
    LinkedTools linked(0.1, 0.0, traditional, traditional);
    linked.add(floor_of(0.0));
    linked.settle();
    linked.ticks(100);
    double given = 0.0, most = 0.0;
    Vec3 velocity(0.0), place{0.0, 0.03, 0.0};
    for (int i = 0; i < 4'000; ++i) {
        const Vec3 wanted{0.0, i < 300 ? 0.03 : 0.0, 0.0};
        const Vec3 force = linked.hand().force + (wanted - place) * 300.0 - velocity * 2.0;
        velocity += force * (1e-3 / 0.3);
        place += velocity * 1e-3;
        put(linked.hand(), place, Quat(1.0, 0.0, 0.0, 0.0), velocity);
        linked.tick();
        given += glm::dot(linked.hand().force, velocity) * 1e-3;
        most = std::max(most, given);
    }
    EXPECT_LT(most, 2e-3);
    EXPECT_LT(glm::length(velocity), 0.02);
}

TEST(LinkedTools, ASessionThatWasRecordedReplaysToTheSameBits) {
    RecordedInputs near_inputs(LinkedPlaces::session_settings()),
        far_inputs(LinkedPlaces::session_settings());
    {
        LinkedTools linked(0.06, 0.2, {}, {}, &near_inputs.recorder, &far_inputs.recorder);
        linked.add(floor_of(0.3));
        linked.add(block(0.3, 0.3), block(0.4, 0.2));
        linked.settle();
        for (int i = 0; i < 1'500; ++i) {
            push(linked.hand(), i);
            linked.tick();
            if (i % 16 == 15) {
                near_inputs.drain();
                far_inputs.drain();
            }
        }
        EXPECT_GT(linked.statistics().corrections, 0u);
    }
    near_inputs.end();
    far_inputs.end();
    for (const RecordedInputs* const inputs : {&near_inputs, &far_inputs}) {
        expect_whole(inputs->play(), 1'500);
    }
}

TEST(LinkedTools, ATickAllocatesNothing) {
    LinkedTools linked(0.06);
    linked.add(floor_of(0.3));
    linked.add(block(0.3, 0.3), block(0.4, 0.2));
    linked.settle();
    linked.ticks(50);
    std::size_t seen = 0;
    for (int i = 0; i < 1'500; ++i) {
        push(linked.hand(), i);
        linked.now += period;
        testing::AuditScope audit;
        linked.near.session.tick(linked.now);
        linked.far.session.tick(linked.now);
        audit.finish();
        seen += audit.allocations() + audit.frees();
        for (LinkedPlaces::Place* const place : {&linked.near, &linked.far}) {
            place->session.refresh();
            place->session.collect();
        }
    }
    EXPECT_EQ(seen, 0u);
}

// With a deadband the far tool goes on as it was last told to.
TEST(LinkedTools, ADeadbandSendsLessAndTheFarToolStaysNear) {
    TeleopSettings sparse;
    sparse.deadband.enabled = true;
    LinkedTools all(0.05), few(0.05, 0.0, sparse, sparse);
    double farthest = 0.0;
    for (int i = 0; i < 2'000; ++i) {
        for (LinkedTools* const linked : {&all, &few}) {
            push(linked->hand(), i);
            linked->tick();
        }
        if (i > 300) {
            farthest =
                std::max(farthest, glm::distance(few.theirs().pose.position, all.theirs().pose.position));
        }
    }
    EXPECT_LT(few.statistics().link.packets_sent, all.statistics().link.packets_sent / 3);
    EXPECT_LT(farthest, 2e-3);
    EXPECT_GT(few.far.port->statistics.front().sample, 1'500u);
}

// Ticks of the two sides that differ: what lies between two samples is turned in between.
TEST(LinkedTools, AHandThatLeapsAndFlipsMovesTheFarToolNoFasterThanAHand) {
    LinkedTools linked(0.02);
    linked.ticks(100);
    Pose before = linked.theirs().pose;
    for (int i = 0; i < 500; ++i) {
        const bool odd = i / 7 % 2 == 1;
        put(linked.hand(), odd ? Vec3(50.0, 0.0, 0.0) : Vec3(0.0),
            odd ? Quat(0.0, 1.0, 0.0, 0.0) : Quat(1.0, 0.0, 0.0, 0.0));
        linked.tick();
        const Pose now = linked.theirs().pose;
        if (linked.theirs().hand.position != Vec3(0.0)) {
            EXPECT_LT(angle_between(before.rotation, now.rotation), 0.11);
        }
        before = now;
    }
}

// Who sends no tool is told nothing of one, and a tool without a partner at the far side touches nothing.
TEST(LinkedTools, AToolWithoutOneAtTheFarSideTouchesNothing) {
    LinkedTools linked(0.02);
    linked.add(floor_of(0.0));
    linked.far.session.remove_tool(0);
    linked.settle();
    put(linked.hand(), {0.0, 0.05, 0.0}, Quat(1.0, 0.0, 0.0, 0.0));
    linked.ticks(50);
    put(linked.hand(), {0.0, 0.006, 0.0}, Quat(1.0, 0.0, 0.0, 0.0));
    linked.ticks(300);
    EXPECT_EQ(linked.ours().force.y, 0.0);
    EXPECT_TRUE(linked.statistics().disagreement.has(Term::missing_hand));
    EXPECT_EQ(linked.far.session.snapshot().tool_count, 0u);
}

}  // namespace
}  // namespace tactus::linked_tools_test
