// A damped surface whose body something else than physics sets going does not kick the hand on it.
#include <gtest/gtest.h>

#include <functional>
#include <glm/geometric.hpp>
#include <vector>

#include "session_rig.hpp"

namespace tactus::driven_surface_test {
namespace {

using session_test::body;
using session_test::ground;
using session_test::SessionRig;

constexpr double stiffness = 500.0;   // (unit: newtons per meter)
constexpr double largest_step = 0.5;  // (unit: newtons)

// A hand that presses with 5 N on a box of half a kilogram, all of it damped.
struct Pressed {
    Pressed() {
        BodyAddition floor = ground();
        floor.touch_material = {stiffness, 5.0, 0.0, 0.0};
        rig.add(floor);
        BodyAddition light = body(BoxShape{Vec3(0.05)}, Vec3(0.0, 0.05, 0.0), Motion::Dynamic, 0.5);
        light.touch_material = {stiffness, 5.0, 0.0, 0.0};
        box = rig.add(light);
        rig.device.position = {0.0, 0.15, 0.0};
        rig.draw({0.0, 0.1, 0.0}, 200);
        rig.ticks(300);
    }

    // Besides what the spring follows of the box's way, in any tick (unit: newtons).
    double largest_step_after(const std::function<void(Pressed&)>& change) {
        EXPECT_NEAR(rig.device.force.y, 5.0, 0.2);
        change(*this);
        double largest = 0.0;
        for (int i = 0; i < 300; ++i) {
            const Vec3 before = rig.device.force;
            const Vec3 from = rig.state_of(box)->pose.position;
            rig.tick();
            const double way = glm::distance(rig.state_of(box)->pose.position, from);
            largest = std::max(largest, glm::distance(rig.device.force, before) - stiffness * way);
        }
        return largest;
    }

    SessionRig rig;
    SessionHandle box = no_handle;
};

TEST(DrivenSurface, SetGoing) {
    for (const double speed : {-1.0, -0.3, 0.3, 1.0}) {
        Pressed pressed;
        EXPECT_LE(pressed.largest_step_after([speed](Pressed& p) {
            p.rig.session.set_body_velocity(p.box, Vec3(0.0, speed, 0.0), Vec3(0.0));
        }),
                  largest_step)
            << speed;
    }
}

TEST(DrivenSurface, Struck) {
    for (const double impulse : {-0.5, 0.5}) {
        Pressed pressed;
        EXPECT_LE(pressed.largest_step_after([impulse](Pressed& p) {
            p.rig.session.push_body(p.box, {.impulse = Vec3(0.0, impulse, 0.0), .central = true});
        }),
                  largest_step)
            << impulse;
    }
}

// As a frame of Godot's physics puts the box right, which Godot moves.
double largest_step_after_correction(const Vec3& by, const Vec3& velocity) {
    Pressed pressed;
    pressed.rig.session.lead_body(pressed.box, true);
    pressed.rig.ticks(10);
    BodyCorrection correction;
    correction.by = by;
    correction.linear = velocity;
    correction.seconds = 0.016;
    return pressed.largest_step_after(
        [&correction](Pressed& p) { p.rig.session.correct_body(p.box, correction); });
}

TEST(DrivenSurface, LedToASpeed) {
    for (const double speed : {-0.5, 0.5}) {
        EXPECT_LE(largest_step_after_correction(Vec3(0.0), Vec3(0.0, speed, 0.0)), largest_step) << speed;
    }
}

TEST(DrivenSurface, LedToAPlace) {
    for (const double way : {-0.01, 0.01, 0.02}) {
        EXPECT_LE(largest_step_after_correction(Vec3(0.0, way, 0.0), Vec3(0.0)), largest_step) << way;
    }
}

TEST(DrivenSurface, LedAsAScriptMovesIt) {
    for (const Motion motion : {Motion::Static, Motion::Kinematic}) {
        for (const double way : {-0.02, 0.01}) {
            SessionRig rig;
            BodyAddition floor = body(BoxShape{Vec3(0.5, 0.05, 0.5)}, Vec3(0.0, -0.05, 0.0), motion);
            floor.touch_material = {stiffness, 5.0, 0.0, 0.0};
            const SessionHandle moved = rig.add(floor);
            rig.device.position = {0.0, 0.05, 0.0};
            rig.draw({0.0, 0.0, 0.0}, 200);
            rig.ticks(100);
            EXPECT_NEAR(rig.device.force.y, 5.0, 0.01);
            rig.session.move_body(moved, {Vec3(0.0, -0.05 + way, 0.0), Quat(1.0, 0.0, 0.0, 0.0)}, 0.016);
            for (int i = 0; i < 100; ++i) {
                const Vec3 before = rig.device.force;
                rig.tick();
                EXPECT_LE(glm::distance(rig.device.force, before),
                          largest_step + stiffness * std::abs(way) / 16.0)
                    << way << ", tick " << i;
            }
        }
    }
}

// What a hand itself makes of a light body is no change of the scene: a damper of 3 N s/m at 0.2 m/s.
TEST(DrivenSurface, ALightBodyThatAHandPushesIsFeltAsItIs) {
    SessionSettings weightless;
    weightless.physics.gravity = Vec3(0.0);
    SessionRig rig(weightless);
    BodyAddition light = body(SphereShape{0.03}, Vec3(0.0), Motion::Dynamic, 0.02);
    light.touch_material = {stiffness, 3.0, 0.0, 0.0};
    rig.add(light);
    rig.device.position = {0.0, 0.05, 0.0};
    rig.tick();
    rig.device.velocity = {0.0, -0.2, 0.0};
    double most = 0.0;
    for (int i = 0; i < 100; ++i) {
        rig.device.position.y -= 0.2e-3;
        rig.tick();
        const ProxyState& state = rig.proxy_state();
        const double pressed = state.contact_count > 0 ? state.forces[0].y : 0.0;
        EXPECT_NEAR(rig.device.force.y, pressed, 1e-12) << "tick " << i;
        most = std::max(most, pressed);
    }
    EXPECT_GT(most, 0.4);
}

}  // namespace
}  // namespace tactus::driven_surface_test
