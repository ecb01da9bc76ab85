// Surfaces that break, what is felt within bodies, and buttons whose force follows a curve.
#include "session/puncture.hpp"

#include <glm/geometric.hpp>
#include <vector>

#include "core/haptics/force_curve.hpp"
#include "devices/simulated_arm.hpp"
#include "session_rig.hpp"

namespace tactus::puncture_test {
namespace {

using namespace session_test;

constexpr double bears = 3.0;

// Two layers, one on the other, whose tops are at 0 and -10 mm.
std::vector<SessionHandle> add_layers(SessionRig& rig, double shaft_friction) {
    std::vector<SessionHandle> layers;
    for (const double middle : {-0.005, -0.025}) {
        BodyAddition layer =
            body(BoxShape{{0.2, middle < -0.01 ? 0.015 : 0.005, 0.2}}, {0.0, middle, 0.0}, Motion::Static);
        layer.touch_material.stiffness = 1000.0;
        layer.touch_material.pop_through_force = bears;
        layer.touch_material.shaft_friction = shaft_friction;
        layers.push_back(rig.add(layer));
    }
    return layers;
}

SessionRig& with_needle(SessionRig& rig) {
    ProxyDescription needle;
    needle.device = rig.hand;
    needle.settings.radius = 0.001;
    rig.session.set_proxy(rig.proxy, needle);
    rig.device.position = {0.0, 0.02, 0.0};
    rig.ticks(5);
    return rig;
}

std::vector<TouchEvent> events_of(SessionRig& rig) {
    const TouchEvents& events = rig.newest().touch_events[rig.proxy];
    std::vector<TouchEvent> found;
    for (std::uint64_t i = 0; i < events.count; ++i) {
        if (events.ring[i].kind != TouchEvent::Kind::impact) {
            found.push_back(events.ring[i]);
        }
    }
    return found;
}

TEST(Puncture, EachBreakHasItsForceAndEachBodyIsLeftOnce) {
    SessionRig rig;
    const std::vector<SessionHandle> layers = add_layers(with_needle(rig), 0.0);
    rig.draw({0.0, -0.03, 0.0}, 1000);
    double pulled = 0.0;
    for (int i = 1; i <= 1000; ++i) {
        rig.device.position.y = -0.03 + 5e-5 * i;
        rig.tick();
        pulled = std::max(pulled, std::abs(rig.proxy_state().force.y));
    }
    EXPECT_LT(pulled, 0.3);  // nothing is met again from below; what faded in the first tick
    const std::vector<TouchEvent> events = events_of(rig);
    ASSERT_EQ(events.size(), 4u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(events[i].kind, TouchEvent::Kind::broken);
        EXPECT_EQ(events[i].body, layers[i]);
        EXPECT_NEAR(events[i].force, bears, 1000.0 * 5e-5 + 1e-9);
        EXPECT_EQ(events[2 + i].kind, TouchEvent::Kind::left);
        EXPECT_EQ(events[2 + i].body, layers[1 - i]);
    }
    rig.draw({0.0, -0.0015, 0.0}, 500);
    EXPECT_GT(rig.proxy_state().force.y, 2.0);  // whole again
}

// Each meter of shaft bears its friction, in both directions; the work over a round is not positive.
TEST(Puncture, FrictionGrowsWithTheDepthAndGivesNoEnergy) {
    SessionRig rig;
    add_layers(with_needle(rig), 100.0);
    double work = 0.0;
    const auto draw = [&](double to, int ticks) {
        const double from = rig.device.position.y;
        for (int i = 1; i <= ticks; ++i) {
            const double before = rig.device.position.y;
            rig.device.position.y = from + (to - from) * i / ticks;
            work += rig.proxy_state().force.y * (rig.device.position.y - before);
            rig.tick();
        }
    };
    draw(-0.007, 500);
    rig.ticks(200);
    draw(-0.0075, 50);
    EXPECT_NEAR(rig.proxy_state().force.y, 100.0 * 0.0075, 0.02);
    draw(-0.005, 250);
    EXPECT_NEAR(rig.proxy_state().force.y, -100.0 * 0.005, 0.02);
    draw(0.02, 500);
    EXPECT_LT(work, 0.0);
}

// An arm that means to be 2 mm deeper presses all the time.
TEST(Puncture, ANeedleThatIsHeldDoesNotCreep) {
    SessionSettings settings;
    Session session(settings);
    KeyframePath way;
    way.interpolation = PathInterpolation::linear;
    way.keyframes = {
        {0, {0.0, 0.02, 0.0}}, {1'000'000'000, {0.0, -0.045, 0.0}}, {2'000'000'000, {0.0, -0.012, 0.0}}};
    SimulatedArm arm(HandPath{way}, {0.1, 5.0, 200.0});
    const SessionHandle hand = session.add_device(arm, Workspace{}).handle;
    ProxyDescription needle;
    needle.device = hand;
    needle.settings.radius = 0.001;
    const SessionHandle proxy = session.add_proxy(needle).handle;
    BodyAddition flesh = body(BoxShape{{0.2, 0.05, 0.2}}, {0.0, -0.05, 0.0}, Motion::Static);
    flesh.touch_material.stiffness = 1000.0;
    flesh.touch_material.pop_through_force = bears;
    flesh.touch_material.shaft_friction = 100.0;
    ASSERT_EQ(session.add_body(flesh).error, "");
    Nanoseconds now = 0;
    const auto place_after = [&](int ticks) {
        for (int i = 0; i < ticks; ++i) {
            session.tick(now += period);
        }
        session.refresh();
        return session.snapshot().proxies[0].hand;
    };
    const Vec3 held = place_after(3000);
    EXPECT_LT(held.y, -0.01) << "it is within";
    EXPECT_GT(std::abs(session.snapshot().proxies[0].force.y), 0.1) << "and is pulled";
    const Vec3 later = place_after(10'000);
    EXPECT_LT(glm::distance(held, later), 5e-5);
    EXPECT_EQ(session.snapshot().proxies[0].handle, proxy);
}

// What friction holds pushes a body that can move the other way.
TEST(Puncture, APuncturedBodyIsTakenAlong) {
    SessionSettings settings;
    settings.physics.gravity = Vec3(0.0);
    SessionRig rig(settings);
    with_needle(rig);
    BodyAddition cube = body(BoxShape{{0.05, 0.05, 0.05}}, {0.0, -0.05, 0.0}, Motion::Dynamic, 100.0);
    cube.touch_material.stiffness = 1000.0;
    cube.touch_material.pop_through_force = bears;
    cube.touch_material.shaft_friction = 200.0;
    const SessionHandle handle = rig.add(cube);
    rig.draw({0.0, -0.03, 0.0}, 1000);
    rig.ticks(100);
    const double down = rig.state_of(handle)->linear_velocity.y;
    rig.draw({0.0, -0.01, 0.0}, 200);
    rig.ticks(1000);
    EXPECT_GT(rig.state_of(handle)->linear_velocity.y, down);
}

TEST(Puncture, BodiesThatGoWhileTheyArePiercedAreForgotten) {
    SessionRig rig;
    const std::vector<SessionHandle> layers = add_layers(with_needle(rig), 100.0);
    rig.draw({0.0, -0.03, 0.0}, 1000);
    for (const SessionHandle layer : layers) {
        rig.session.remove_body(layer);
    }
    rig.ticks(300);
    EXPECT_EQ(rig.proxy_state().force, Vec3(0.0));
}

// A button: 2 N at 1 mm, 1 N at 1.5 mm, 3 N at 3 mm.
double curve_at(double depth) {
    const double mm = 1e3 * depth;
    return mm < 1.0 ? 2.0 * mm : mm < 1.5 ? 2.0 - 2.0 * (mm - 1.0) : 1.0 + (mm - 1.5) * 4.0 / 3.0;
}

BodyAddition button() {
    std::vector<double> forces;
    for (int i = 0; i <= 300; ++i) {
        forces.push_back(curve_at(1e-5 * i));
    }
    BodyAddition addition = ground();
    auto detail = std::make_shared<TouchDetail>();
    detail->images.curve = ForceCurve::of(0.003, forces);
    addition.detail = detail;
    return addition;
}

TEST(ForceCurve, AClickIsItsCurveAtEachSpeed) {
    for (const double speed : {0.02, 0.2}) {
        SessionRig rig;
        rig.add(button());
        rig.device.position = {0.0, 0.02, 0.0};
        rig.ticks(5);
        rig.device.velocity = {0.0, -speed, 0.0};
        double worst = 0.0;
        while (rig.device.position.y > 0.01 - 0.0029) {
            rig.device.position.y -= speed * 1e-3;
            rig.tick();
            const double due = curve_at(std::max(0.0, 0.01 - rig.device.position.y));
            worst = std::max(worst, std::abs(rig.device.force.y - due));
        }
        EXPECT_LT(worst, 0.02 * 2.0) << speed << " m/s";
    }
}

TEST(ForceCurve, ACurveThatIsTooSteepIsWeakenedAsAWhole) {
    SessionRig rig;
    rig.device.can.feels = true;
    rig.device.can.damping = 0.5;  // bears 1000 N/m at 1 kHz, and the curve has 2000
    rig.add(button());
    rig.device.position = {0.0, 0.02, 0.0};
    rig.ticks(5);
    rig.draw({0.0, 0.009, 0.0}, 200);
    rig.ticks(50);
    EXPECT_NEAR(rig.device.force.y, 0.5 * curve_at(0.001), 1e-3);
}

TEST(ForceCurve, WhatIsNoneIsRefused) {
    SessionRig rig;
    BodyAddition wrong = ground();
    auto detail = std::make_shared<TouchDetail>();
    detail->images.curve = ForceCurve::of(0.0, {0.0, 1.0});
    wrong.detail = detail;
    EXPECT_NE(rig.session.add_body(wrong).error, "");
}

}  // namespace
}  // namespace tactus::puncture_test
