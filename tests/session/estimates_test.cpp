// What the far side of scenario 5 finds out about its bodies reaches the operator's model: how surely they
// are seen, and what touch has taught.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "devices/robot_table.hpp"
#include "model_rig.hpp"
#include "shared/rough_eyes.hpp"

namespace tactus::estimates_test {
namespace {

using session_test::body;
using session_test::HeldDevice;
using session_test::ModelRig;
using session_test::ms;
using session_test::period;
using shared::RoughEyes;

constexpr Nanoseconds image = 33 * ms;

TeleopSettings scenario_5() {
    TeleopSettings settings;
    settings.robot = true;
    return settings;
}

PoseDoubt doubt_of(const RoughEyes& eyes) {
    return {Mat3(eyes.of_place() * eyes.of_place()), Mat3(eyes.of_turn() * eyes.of_turn())};
}

// A box on a floor, seen thirty times a second by eyes that say how rough they are, or do not.
struct SeenBox {
    explicit SeenBox(double of_place, bool says_so = true)
        : eyes(of_place, 5.0 * of_place), is_told(says_so) {
        rig.far->add("floor", session_test::ground());
        box = rig.far->add("box", body(BoxShape{Vec3(0.05)}, truth.position, Motion::Dynamic));
        rig.run(from_seconds(0.5));
    }

    void look(double seconds) {
        for (const Nanoseconds end = rig.now + from_seconds(seconds); rig.now < end;) {
            const Pose seen = eyes.see(truth);
            if (is_told) {
                rig.far->session.see_body(box, {{seen, {}, {}}, 0.0, doubt});
            } else {
                rig.far->session.teleport_body(box, seen);
            }
            for (Nanoseconds from = rig.now; rig.now < from + image;) {
                rig.run(period);
                const Pose now = rig.near->pose("box");
                moved = std::max(moved, glm::distance(now.position, before.position));
                before = now;
            }
        }
    }
    double off() const { return glm::distance(rig.near->pose("box").position, truth.position); }

    ModelRig rig{{}, scenario_5()};
    RoughEyes eyes;
    bool is_told;
    PoseDoubt doubt = doubt_of(eyes);
    Pose truth{{0.0, 0.05, 0.0}, {1.0, 0.0, 0.0, 0.0}};
    SessionHandle box = no_handle;
    Pose before;
    double moved = 0.0;  // within a tick
};

TEST(Estimates, NoiseOfKnownChanceShakesNoModel) {
    for (const bool is_told : {true, false}) {
        SeenBox seen(1e-3, is_told);
        seen.rig.run(from_seconds(0.1));
        seen.look(1.0);
        seen.moved = 0.0;
        seen.look(5.0);
        if (is_told) {
            EXPECT_LT(seen.moved, 1e-7);
            EXPECT_LT(seen.off(), 1e-3);
        } else {
            EXPECT_GT(seen.moved, 1e-4) << "the noise shakes nothing at all: this test tells nothing";
        }
    }
}

TEST(Estimates, ASurePlaceIsTakenAtOnce) {
    SeenBox seen(0.0);
    seen.doubt = {Mat3(1e-10), Mat3(1e-8)};
    seen.look(0.2);
    seen.truth.position.x = 0.002;
    seen.look(0.03);
    EXPECT_LT(seen.off(), 1e-5);
}

TEST(Estimates, WhatHasReallyMovedIsPutRightThoughItIsSeenRoughly) {
    SeenBox seen(1e-3);
    seen.look(2.0);
    seen.truth.position.x = 0.03;
    seen.look(0.2);
    EXPECT_LT(seen.off(), 4e-3);
    seen.look(3.0);
    EXPECT_LT(seen.off(), 1.5e-3);
}

TEST(Estimates, AnotherStartOfTheOperatorHearsHowSureItIs) {
    SeenBox seen(1e-3);
    seen.look(1.0);
    seen.rig.start_operator(7);
    seen.look(2.0);
    ASSERT_NE(seen.rig.near->find("box"), nullptr);
    seen.moved = 0.0;
    seen.look(3.0);
    EXPECT_LT(seen.moved, 1e-7);
}

// Where it is put by a camera is where it was; the operator's model is where it must be by now.
TEST(Estimates, WhatMovesIsWhereItMustBeByNowBetweenTwoImages) {
    SeenBox seen(0.0);
    seen.doubt = {Mat3(1e-10), Mat3(1e-8)};
    seen.look(0.2);
    const Vec3 velocity(0.08, 0.0, 0.0);
    constexpr double age = 0.04;
    const Vec3 from = seen.truth.position;
    const Nanoseconds began = seen.rig.now;
    const auto truth = [&] { return from + to_seconds(seen.rig.now - began) * velocity; };
    double worst = 0.0;
    for (int i = 0; i < 20; ++i) {
        seen.rig.far->session.see_body(
            seen.box, {{{truth() - age * velocity, {1.0, 0.0, 0.0, 0.0}}, velocity, {}}, age, seen.doubt});
        for (const Nanoseconds next = seen.rig.now + image; seen.rig.now < next;) {
            seen.rig.run(period);
            const Vec3 there = seen.rig.far->session.snapshot().bodies[0].pose.position;
            worst = std::max(worst, glm::distance(there, truth()));
        }
    }
    EXPECT_LT(worst, 2e-4) << "of 2.6 mm that it goes between two images, and 3.2 mm that it was late";
    EXPECT_LT(glm::distance(seen.rig.near->pose("box").position, truth()), 5e-4);
    // Nobody sees it any more: it does not go on for ever.
    seen.rig.run(from_seconds(1.0));
    const Vec3 last = from + (to_seconds(seen.rig.now - began) - 1.0 + longest_guess - age) * velocity;
    EXPECT_LT(glm::distance(seen.rig.far->session.snapshot().bodies[0].pose.position, last), 5e-3);
}

// --- what touch teaches

// A robot over a table whose surface is told with a stiffness of its own.
struct RobotRig {
    static constexpr double top = -0.01;  // of the tip's centre where it touches (unit: meters)
    static constexpr double told_stiffness = 220.0;

    explicit RobotRig(const RobotTable::Settings& table)
        : robot({}, std::make_shared<RobotTable>(table)), near(at_operator, 1, settings) {
        EndpointSettings end = shared::endpoint(Side::teleoperator_side, 2);
        end.scenario = scenario_of(settings);
        far.attach(std::make_unique<RobotSide>(session_test::small_session(), settings, at_far, port, end));
        ProxyDescription pointer;
        pointer.device = far.add_device(robot, {}).handle;
        far.add_proxy(pointer);
        BodyAddition floor = body(BoxShape{Vec3(0.3, 0.05, 0.3)},
                                  Vec3(0.0, top - pointer.settings.radius - 0.05, 0.0), Motion::Static);
        floor.touch_material = {told_stiffness, 0.0, 0.0, 0.0};
        const AddResult added = far.add_body(floor);
        EXPECT_EQ(added.error, "");
        EXPECT_EQ(teller.tell(added.handle, "floor", floor), "");
        near.device.position = {0.0, 0.02, 0.0};
        run(1.0);
    }

    void run(double seconds) {
        for (const Nanoseconds end = now + from_seconds(seconds); now < end;) {
            now += period;
            near.tick(now);
            far.tick(now);
            far.collect();
            far.refresh();
            port->statistics.refresh();
            teller.update(far.snapshot(), port->statistics.front().link.peer_epoch);
            step = std::max(step, glm::distance(near.device.force, before));
            before = near.device.force;
        }
    }
    // The hand presses and slides, as one that feels for something does.
    void feel(double seconds) {
        for (int i = 0; i < static_cast<int>(1e3 * seconds); ++i) {
            const double t = to_seconds(now - began);
            const double deep = 0.003 + 0.0015 * std::sin(2.0 * std::numbers::pi * t);
            put({0.012 * std::sin(6.0 * t), top - deep, 0.0});
            const Vec3& force = near.device.force;
            roughest = force.y > 0.1 ? std::max(roughest, std::abs(force.x) / force.y) : roughest;
        }
    }
    void put(const Vec3& to) {
        near.device.velocity = (to - near.device.position) * 1e3;
        near.device.position = to;
        run(1e-3);
    }
    void touch() {
        const Vec3 from = near.device.position;
        for (int i = 1; i <= 200; ++i) {
            put(from + (Vec3(0.0, top - 0.003, 0.0) - from) * (i / 200.0));
        }
        began = now;
    }

    TeleopSettings settings = scenario_5();
    MemoryLinkPair wire{8192};
    LinkEmulator at_operator{wire.first(), LinkConditions{}, 1}, at_far{wire.second(), LinkConditions{}, 2};
    EmulatedRobot robot;
    session_test::Operator near;
    Session far{session_test::small_session()};
    std::shared_ptr<TeleopPort> port = std::make_shared<TeleopPort>();
    EnvironmentTeller teller{port};
    Nanoseconds now = 0, began = 0;
    Vec3 before{0.0};
    double step = 0.0;      // of the force on the hand, within a tick (unit: newtons)
    double roughest = 0.0;  // how much of it was friction, at most (dimensionless)
};

TEST(Estimates, AModelComesToFeelAsWhatTheRobotTouches) {
    for (const auto& [stiffness, friction] :
         {std::pair{400.0, 0.3}, {600.0, 0.5}, {900.0, 0.3}, {1200.0, 0.2}}) {
        RobotTable::Settings table;
        table.height = RobotRig::top;
        table.stiffness = stiffness;
        table.friction = friction;
        RobotRig rig(table);
        rig.touch();
        ASSERT_NEAR(rig.near.device.force.y, 0.003 * RobotRig::told_stiffness, 0.05);
        rig.step = 0.0;
        rig.feel(2.0);
        // What two seconds have taught is felt without a step, a little at a time.
        EXPECT_LT(rig.step, 0.03) << stiffness;
        const Vec3 still = rig.near.device.position;
        rig.put(still);
        rig.run(10.0);
        EXPECT_LT(rig.step, 0.03) << stiffness;
        const double deep = RobotRig::top - still.y;
        EXPECT_NEAR(rig.near.device.force.y / deep, stiffness, 0.1 * stiffness);
        // Friction, too: none was told.
        rig.began = rig.now;
        rig.roughest = 0.0;
        rig.feel(4.0);
        EXPECT_NEAR(rig.roughest, friction, 0.1 * friction) << stiffness;
    }
}

}  // namespace
}  // namespace tactus::estimates_test
