// A joint of a scene and its twin: made with its bodies, made anew with them, in the same frames.
#include "world/joint_twin.hpp"

#include <gtest/gtest.h>

namespace tactus::joint_twin_test {
namespace {

struct Scene {
    SessionHandle add_box(double x) {
        BodyAddition addition;
        addition.description.shapes = {PlacedShape{BoxShape{Vec3(0.1)}, Pose{}}};
        addition.description.motion = Motion::Dynamic;
        addition.description.pose.position = Vec3(x, 0, 0);
        return session.add_body(addition).handle;
    }
    Session session{SessionSettings{}};
};

JointDescription pin_at(double x) {
    JointDescription joint;
    joint.frame.position = Vec3(x, 0, 0);
    return joint;
}

JointTwin::End end_at(std::uint64_t source, SessionHandle body, double x) {
    JointTwin::End end{source, body, Pose{}};
    end.pose.position = Vec3(x, 0, 0);
    return end;
}

TEST(JointTwin, JoinsInTheFramesOfItsBodies) {
    Scene scene;
    const SessionHandle first = scene.add_box(0), second = scene.add_box(1);
    JointTwin twin;
    twin.synchronise(scene.session, pin_at(0.4), end_at(1, first, 0), end_at(2, second, 1));
    EXPECT_NE(twin.handle(), no_handle);
    EXPECT_EQ(twin.problem(), "");
    EXPECT_DOUBLE_EQ(twin.joined().frame.position.x, 0.4);
    EXPECT_DOUBLE_EQ(twin.joined().second_frame->position.x, -0.6);
}

TEST(JointTwin, StaysWhereNothingHasChanged) {
    Scene scene;
    const SessionHandle first = scene.add_box(0), second = scene.add_box(1);
    JointTwin twin;
    twin.synchronise(scene.session, pin_at(0.4), end_at(1, first, 0), end_at(2, second, 1));
    const SessionHandle before = twin.handle();
    const std::uint64_t revision = twin.revision();
    twin.synchronise(scene.session, pin_at(0.4), end_at(1, first, 5), end_at(2, second, 6));
    EXPECT_EQ(twin.handle(), before);
    EXPECT_EQ(twin.revision(), revision);
}

TEST(JointTwin, KeepsItsFramesWhenABodyIsMadeAnew) {
    Scene scene;
    const SessionHandle first = scene.add_box(0);
    JointTwin twin;
    twin.synchronise(scene.session, pin_at(0.4), end_at(1, first, 0), end_at(2, scene.add_box(1), 1));
    const std::uint64_t revision = twin.revision();
    twin.synchronise(scene.session, pin_at(9.0), end_at(1, first, 3), end_at(2, scene.add_box(1), 4));
    EXPECT_NE(twin.revision(), revision);
    EXPECT_DOUBLE_EQ(twin.joined().frame.position.x, 0.4) << "limits count from where they were first joined";
    EXPECT_DOUBLE_EQ(twin.joined().second_frame->position.x, -0.6);
}

TEST(JointTwin, TakesOtherFramesWithAnotherBody) {
    Scene scene;
    const SessionHandle first = scene.add_box(0), second = scene.add_box(1), third = scene.add_box(2);
    JointTwin twin;
    twin.synchronise(scene.session, pin_at(0.4), end_at(1, first, 0), end_at(2, second, 1));
    twin.synchronise(scene.session, pin_at(0.4), end_at(1, first, 0), end_at(3, third, 2));
    EXPECT_DOUBLE_EQ(twin.joined().second_frame->position.x, -1.6);
}

TEST(JointTwin, JoinsABodyToTheWorld) {
    Scene scene;
    JointTwin twin;
    twin.synchronise(scene.session, pin_at(0.4), end_at(1, scene.add_box(1), 1), {});
    EXPECT_NE(twin.handle(), no_handle);
    EXPECT_DOUBLE_EQ(twin.joined().second_frame->position.x, 0.4);
    twin.remove(scene.session);
    EXPECT_EQ(twin.handle(), no_handle);
}

}  // namespace
}  // namespace tactus::joint_twin_test
