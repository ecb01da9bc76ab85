// What joins bodies in the environment joins them in the operator's model, in the same place, however they
// stand when that is built.
#include "session/model_joints.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <numbers>

#include "model_rig.hpp"

namespace tactus::model_joints_test {
namespace {

using namespace session_test;

constexpr double half_pi = 0.5 * std::numbers::pi;

// A door that hangs on the scene at x = 0, y = 0.5: its frame's z axis, the hinge, is the scene's y axis.
const Quat upright = glm::angleAxis(-half_pi, Vec3(1.0, 0.0, 0.0));

BodyAddition leaf() {
    BodyAddition door = body(BoxShape{{0.2, 0.3, 0.01}}, {0.2, 0.5, 0.0}, Motion::Dynamic, 1.0);
    door.description.can_sleep = false;
    return door;
}

JointDescription hinge(double lower, double upper) {
    JointDescription joint;
    joint.kind = JointKind::Hinge;
    joint.angular[2] = {lower, upper};
    joint.frame = {{-0.2, 0.0, 0.0}, upright};
    joint.second_frame = Pose{{0.0, 0.5, 0.0}, upright};
    return joint;
}

double opened(const Pose& pose) {
    const Vec3 leaf_axis = pose.rotation * Vec3(1.0, 0.0, 0.0);
    return std::atan2(-leaf_axis.z, leaf_axis.x);
}

struct Door : ModelRig {
    explicit Door(const JointDescription& joint, const LinkConditions& conditions = {})
        : ModelRig(conditions) {
        door = far->add("Door", leaf());
        join(joint);
    }
    void join(const JointDescription& joint) {
        handle = far->session.add_joint(joint, door, no_handle).handle;
        far->teller.tell_joint(handle, joint, door, no_handle);
    }
    void part() {
        far->session.remove_joint(handle);
        far->teller.forget_joint(handle);
    }
    Pose there() const {
        const SessionSnapshot& snapshot = far->session.snapshot();
        const BodyState* const state = state_of(snapshot.bodies, snapshot.body_count, door);
        return state ? state->pose : Pose{};
    }
    // By a hand that goes through the leaf's middle towards -z.
    void push(double way) {
        near->device.position = {0.3, 0.5, 0.05};
        run(100 * ms);
        for (int i = 0; i < 500; ++i) {
            near->device.position.z -= way / 500.0;
            run(ms);
        }
    }
    void expect_same(double tolerance) const {
        EXPECT_LT(glm::distance(near->pose("Door").position, there().position), tolerance);
        EXPECT_NEAR(opened(near->pose("Door")), opened(there()), 10.0 * tolerance);
    }

    SessionHandle door = no_handle, handle = no_handle;
};

TEST(ModelJoints, ADoorOpensInTheModelAsInTheEnvironment) {
    Door rig(hinge(-half_pi, half_pi));
    rig.run(500 * ms);
    rig.push(0.2);
    rig.run(1000 * ms);
    EXPECT_GT(std::abs(opened(rig.there())), 0.2);
    EXPECT_NEAR(rig.near->pose("Door").position.y, 0.5, 1e-4) << "it hangs";
    rig.expect_same(1e-3);
}

TEST(ModelJoints, AMotorTurnsTheModelToo) {
    JointDescription turning = hinge(1.0, -1.0);
    turning.motor_speed = 0.5;
    turning.motor_torque = 100.0;
    Door rig(turning);
    rig.run(1000 * ms);
    const double before = opened(rig.near->pose("Door"));
    rig.run(1000 * ms);
    const double turned = opened(rig.near->pose("Door")) - before;
    EXPECT_NEAR(std::abs(turned), 0.5, 0.02);
    rig.expect_same(1e-3);
}

// A joint that does not fit takes the body to where it does, at once, and the far side's truth takes it back.
TEST(ModelJoints, OneThatTakesAwayWhatIsPressedIsNoStep) {
    ModelRig rig;
    rig.far->add("Ground", body(BoxShape{{1.0, 0.05, 1.0}}, {0.0, -0.05, 0.0}, Motion::Static));
    const SessionHandle box =
        rig.far->add("Box", body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.0}, Motion::Dynamic, 0.3));
    rig.run(1000 * ms);
    rig.near->device.position = {0.0, 0.2, 0.0};
    rig.run(100 * ms);
    while (glm::length(rig.near->device.force) < 2.0 && rig.near->device.position.y > 0.05) {
        rig.near->device.position.y -= 1e-4;
        rig.run(ms);
    }
    rig.run(200 * ms);
    ASSERT_GT(glm::length(rig.near->device.force), 1.5);
    JointDescription elsewhere;
    elsewhere.kind = JointKind::Pin;
    elsewhere.second_frame = Pose{{0.0, 0.2, 0.2}, {1.0, 0.0, 0.0, 0.0}};
    double largest = 0.0, way = 0.0;
    Vec3 before = rig.near->device.force;
    const auto watch = [&](Nanoseconds span) {
        for (const Nanoseconds end = rig.now + span; rig.now < end;) {
            rig.run(ms);
            const Vec3 now = rig.near->device.force;
            largest = std::max(largest, glm::distance(now, std::exchange(before, now)));
            way = std::max(way, glm::distance(rig.near->pose("Box").position, {0.0, 0.05, 0.0}));
        }
    };
    for (int i = 0; i < 5; ++i) {
        rig.far->teller.tell_joint(7, elsewhere, box, no_handle);
        watch(20 * ms);
        rig.far->teller.forget_joint(7);
        watch(300 * ms);
    }
    EXPECT_GT(way, 0.05) << "it was taken away";
    EXPECT_LT(largest, 0.5) << "N, from one tick to the next";
}

// Its limits count from where it was hung, not from where it stands when the operator comes.
TEST(ModelJoints, WhoComesLaterFindsTheSameLimits) {
    Door rig(hinge(-0.6, 0.6));
    rig.run(500 * ms);
    rig.push(0.3);
    const double open = opened(rig.there());
    ASSERT_GT(std::abs(open), 0.3);
    rig.near.reset();
    rig.run(1500 * ms);
    rig.start_operator(7);
    rig.run(1000 * ms);
    rig.expect_same(1e-3);
    rig.push(0.6);
    rig.run(500 * ms);
    EXPECT_LT(std::abs(opened(rig.near->pose("Door"))), 0.62);
    rig.expect_same(2e-3);
}

TEST(ModelJoints, AChangeWhileItIsTouchedReachesTheModel) {
    Door rig(hinge(-half_pi, half_pi));
    rig.run(500 * ms);
    rig.push(0.1);
    rig.part();
    rig.join(hinge(-0.4, 0.4));
    double largest = 0.0;
    Vec3 before = rig.near->device.force;
    for (int i = 0; i < 1000; ++i) {
        rig.near->device.position.z -= i < 500 ? 0.2 / 500.0 : 0.0;
        rig.run(ms);
        largest = std::max(largest, glm::distance(rig.near->device.force, before));
        before = rig.near->device.force;
    }
    EXPECT_NEAR(std::abs(opened(rig.near->pose("Door"))), 0.4, 0.02) << "and no farther";
    EXPECT_LT(largest, 0.5) << "N in a tick";
    rig.expect_same(2e-3);
}

TEST(ModelJoints, WhatIsPartedFallsInTheModelToo) {
    Door rig(hinge(-half_pi, half_pi));
    rig.run(500 * ms);
    rig.push(0.06);
    rig.part();
    rig.run(300 * ms);
    EXPECT_LT(rig.near->pose("Door").position.y, 0.3);
    EXPECT_EQ(rig.near->builder.joints().count(), 0u);
}

TEST(ModelJoints, ABodyDescribedAnewIsJoinedAgain) {
    Door rig(hinge(-half_pi, half_pi));
    rig.run(500 * ms);
    BodyAddition heavier = leaf();
    heavier.description.mass = 2.0;
    rig.far->teller.tell(rig.door, "Door", heavier);
    rig.run(1000 * ms);
    EXPECT_NEAR(rig.near->pose("Door").position.y, 0.5, 1e-4);
    EXPECT_EQ(rig.near->builder.joints().count(), 1u);
    EXPECT_TRUE(rig.near->builder.joints().problems().empty());
}

TEST(ModelJoints, AfterARestartTheDoorStillHangs) {
    Door rig(hinge(-half_pi, half_pi));
    rig.run(500 * ms);
    rig.start_environment(9);
    rig.door = rig.far->add("Door", leaf());
    rig.join(hinge(-half_pi, half_pi));
    for (int i = 0; i < 40; ++i) {
        rig.run(100 * ms);
        ASSERT_NEAR(rig.near->pose("Door").position.y, 0.5, 5e-3) << i;
    }
    EXPECT_EQ(rig.near->builder.joints().count(), 1u);
    rig.expect_same(1e-3);
}

TEST(ModelJoints, TwoBodiesAreJoinedAsTheyWere) {
    ModelRig rig;
    BodyAddition post = body(BoxShape{Vec3(0.05)}, {0.0, 1.0, 0.0}, Motion::Static);
    BodyAddition bob = body(BoxShape{Vec3(0.05)}, {0.3, 1.0, 0.0}, Motion::Dynamic);
    const SessionHandle first = rig.far->add("Bob", bob);
    const SessionHandle second = rig.far->add("Post", post);
    JointDescription slider;
    slider.kind = JointKind::Slider;
    slider.linear[0] = {-0.1, 0.1};
    // Slides along the scene's y axis: falls as far as it may.
    slider.frame = {{-0.15, 0.0, 0.0}, glm::angleAxis(half_pi, Vec3(0.0, 0.0, 1.0))};
    slider.second_frame = Pose{{0.15, 0.0, 0.0}, slider.frame.rotation};
    const SessionHandle joint = rig.far->session.add_joint(slider, first, second).handle;
    rig.run(500 * ms);
    rig.far->teller.tell_joint(joint, slider, first, second);
    rig.run(3000 * ms);
    EXPECT_NEAR(rig.near->pose("Bob").position.y, 0.9, 2e-3);
    EXPECT_NEAR(rig.near->pose("Bob").position.x, 0.3, 2e-3);
}

}  // namespace
}  // namespace tactus::model_joints_test
