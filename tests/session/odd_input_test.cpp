// Whatever the owner or a device says: no crash, and nothing in a snapshot that is not a number.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "session_rig.hpp"
#include "shared/sound_snapshot.hpp"

namespace tactus::odd_input_test {
namespace {

using namespace session_test;

const std::vector<double> odd_numbers{std::numeric_limits<double>::quiet_NaN(),
                                      std::numeric_limits<double>::infinity(),
                                      -std::numeric_limits<double>::infinity(),
                                      1e300,
                                      -1e300,
                                      1e30,
                                      -1e12,
                                      1e-300,
                                      -1.0};
const Quat upright{1.0, 0.0, 0.0, 0.0};

void expect_sound(const SessionSnapshot& snapshot, const std::string& what) {
    ASSERT_EQ(shared::unsound_in(snapshot), "") << what;
}

// A finger on a box on the ground, and another box beside.
struct Scene {
    Scene() {
        rig.add(ground());
        touched = rig.add(body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.0}, Motion::Dynamic, 0.5));
        other = rig.add(body(BoxShape{Vec3(0.05)}, {0.2, 0.05, 0.0}, Motion::Dynamic, 0.5));
        carried = rig.add(body(BoxShape{Vec3(0.05)}, {0.0, 0.05, 0.3}, Motion::Kinematic));
        rig.device.position = {0.0, 0.2, 0.0};
        rig.tick();
        rig.draw({0.0, 0.105, 0.0}, 100);
    }
    void expect_sound_for(int ticks, const std::string& what) {
        for (int i = 0; i < ticks; ++i) {
            rig.tick();
            expect_sound(rig.newest(), what);
            ASSERT_TRUE(shared::is_sound(rig.device.force)) << what;
        }
    }
    SessionRig rig;
    SessionHandle touched, other, carried;
};

TEST(SessionOddInput, ADeviceThatSaysWhatIsNoPlaceStaysWhereItWas) {
    for (const double value : odd_numbers) {
        Scene scene;
        const Vec3 before = scene.rig.proxy_state().position;
        scene.rig.device.position.y = value;
        scene.expect_sound_for(30, "device at " + std::to_string(value));
        scene.rig.device.position = {0.0, 0.105, 0.0};
        scene.rig.device.velocity = Vec3(value);
        scene.expect_sound_for(30, "device with velocity " + std::to_string(value));
        scene.rig.device.velocity = Vec3(0.0);
        scene.expect_sound_for(300, "device again in order");
        if (!(std::abs(value) <= 1.0)) {
            EXPECT_LT(glm::distance(scene.rig.proxy_state().position, before), 0.01) << value;
        }
    }
}

TEST(SessionOddInput, CommandsOfTheOwnerLeaveEverythingSound) {
    for (const double value : odd_numbers) {
        Scene scene;
        Session& session = scene.rig.session;
        for (const SessionHandle body : {scene.touched, scene.other, scene.carried}) {
            session.teleport_body(body, {Vec3(value), upright});
            session.teleport_body(body, {Vec3(0.0, 0.05, 0.0), Quat(value, 0.0, 0.0, 0.0)});
            session.move_body(body, {Vec3(value), upright}, 0.01);
            session.move_body(body, {Vec3(0.0, 0.05, 0.0), upright}, value);
            session.set_body_velocity(body, Vec3(value), Vec3(0.0));
            session.set_body_velocity(body, Vec3(0.0), Vec3(value));
            session.set_body_push(body, Vec3(value), Vec3(value));
            session.set_body_damping(body, value, value);
            session.set_body_gravity_scale(body, value);
            session.set_body_surface(body, {value, value, false, false});
            session.set_touch_material(body, {value, value, value, value});
        }
        session.set_gravity(Vec3(value));
        scene.expect_sound_for(100, "commands of " + std::to_string(value));
    }
}

TEST(SessionOddInput, AWorkspaceOfNoSizeOrPlaceIsRefused) {
    for (const double value : odd_numbers) {
        Scene scene;
        Workspace workspace;
        workspace.scale = value;
        scene.rig.session.set_workspace(scene.rig.hand, workspace);
        scene.expect_sound_for(20, "workspace of scale " + std::to_string(value));
        workspace.scale = 1.0;
        workspace.pose.position.x = value;
        scene.rig.session.set_workspace(scene.rig.hand, workspace);
        scene.expect_sound_for(20, "workspace at " + std::to_string(value));
        workspace.pose.position.x = 0.0;
        workspace.force_limit = value;
        scene.rig.session.set_workspace(scene.rig.hand, workspace);
        scene.expect_sound_for(20, "force limit of " + std::to_string(value));
    }
}

TEST(SessionOddInput, JointsThatJoinNothingAreRefusedOrForgotten) {
    Scene scene;
    Session& session = scene.rig.session;
    EXPECT_NE(session.add_joint({}, scene.touched, scene.touched).error, "");
    EXPECT_NE(session.add_joint({}, no_handle, no_handle).error, "");
    session.remove_body(scene.other);
    const AddResult late = session.add_joint({}, scene.touched, scene.other);
    scene.expect_sound_for(50, "joint to a body that has gone");
    session.remove_joint(late.handle);
    session.remove_joint(late.handle);
    session.remove_joint(12'345);
    session.remove_body(98'765);
    session.remove_proxy(77);
    session.remove_device(77);
    session.set_workspace(77, {});
    session.set_proxy(77, {});
    session.teleport_body(98'765, {});
    session.set_body_push(98'765, Vec3(1.0), Vec3(1.0));
    scene.expect_sound_for(50, "removed twice");
    session.collect();
    const SessionHandle one = session.add_joint({}, scene.touched, no_handle).handle;
    const SessionHandle two = session.add_joint({}, scene.carried, scene.touched).handle;
    EXPECT_NE(one, two);
}

TEST(SessionOddInput, AThousandBodiesInOneTick) {
    SessionSettings settings;
    settings.commands_per_tick = 5000;
    SessionRig rig(settings);
    rig.add(ground());
    rig.tick();
    std::vector<SessionHandle> boxes;
    for (int i = 0; i < 1000; ++i) {
        boxes.push_back(
            rig.add(body(BoxShape{Vec3(0.05)}, {0.11 * (i % 32) - 1.7, 0.05, 0.11 * (i / 32) - 1.7},
                         Motion::Dynamic, 0.3)));
    }
    for (int i = 0; i < 300; ++i) {
        rig.tick();
        expect_sound(rig.newest(), "a thousand bodies");
    }
    EXPECT_EQ(rig.newest().body_count, 1000u);
    for (const SessionHandle box : boxes) {
        EXPECT_NEAR(rig.state_of(box)->pose.position.y, 0.05, 1e-3);
        rig.session.remove_body(box);
    }
    rig.tick();
    rig.session.collect();
    EXPECT_EQ(rig.newest().body_count, 0u);
}

}  // namespace
}  // namespace tactus::odd_input_test
