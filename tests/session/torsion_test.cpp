// Soft fingers hold bodies against turning.
#include <numbers>

#include "session_rig.hpp"
#include "shared/torsion_figures.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::torsion_test {
namespace {

using namespace session_test;

constexpr SoftFinger skin{1e5, 0.008};

TEST(Torsion, OfHeldCubesIsCoulombs) {
    for (const double edge : {0.04, 0.08}) {
        for (const double pressing : {2.0, 8.0}) {
            const shared::TorsionFigures figures = shared::turn_held_cube(edge, pressing);
            EXPECT_LE(figures.break_away_error, 1.0) << edge << " m, " << pressing << " N";
            EXPECT_LE(figures.slipping_error, 1.0) << edge << " m, " << pressing << " N";
        }
    }
}

TEST(Torsion, ABoxLiftedBesideItsMiddleDoesNotTurn) {
    const shared::LiftFigures soft = shared::lift_beside_middle(skin);
    EXPECT_LT(soft.turned, 1.0);
    EXPECT_NEAR(soft.risen, 0.05, 0.002);
    EXPECT_GT(shared::lift_beside_middle({}).turned, 30.0);
}

// A finger that presses a light cube onto the ground: nothing rings.
TEST(Torsion, LightThingsComeToRest) {
    for (const double edge : {0.05, 0.005}) {
        SessionRig rig;
        rig.add(ground());
        ProxyDescription description;
        description.device = rig.hand;
        description.finger = skin;
        rig.session.set_proxy(rig.proxy, description);
        BodyAddition cube = body(BoxShape{Vec3(0.5 * edge)}, {0.0, 0.5 * edge, 0.0}, Motion::Dynamic,
                                 1000.0 * edge * edge * edge);
        cube.touch_material = {1000.0, 0.0, 0.9, 0.9};
        cube.description.angular_velocity = {0.0, 3.0, 0.0};
        const SessionHandle handle = rig.add(cube);
        rig.device.position = {0.0, edge + 0.011, 0.0};
        rig.draw({0.0, edge + 0.006, 0.0}, 100);
        rig.ticks(500);
        const Pose before = rig.state_of(handle)->pose;
        rig.ticks(1'000);
        const BodyState* const after = rig.state_of(handle);
        EXPECT_LT(glm::length(after->pose.position - before.position), 1e-6) << edge;
        EXPECT_LT(glm::length(after->angular_velocity), 1e-3) << edge;
    }
}

// A handle that tells how it is turned turns what it holds; nothing is allocated on the way.
TEST(Torsion, AHandleThatTurnsTurnsWhatItHolds) {
    class Knob final : public Device {
    public:
        DeviceSample read(Nanoseconds) override { return {position, rotation, Vec3(0.0), 0, true}; }
        void write(Nanoseconds, const Vec3&) override {}
        DeviceCapabilities capabilities() const override {
            DeviceCapabilities can;
            can.rotates = true;
            return can;
        }
        Vec3 position{0.0};
        Quat rotation{1.0, 0.0, 0.0, 0.0};
    };
    for (const bool soft : {true, false}) {
        SessionSettings settings;
        settings.physics.gravity = Vec3(0.0);
        Knob knob;
        Session session(settings);
        Workspace workspace;
        workspace.force_limit = 1e6;
        ProxyDescription description;
        description.device = session.add_device(knob, workspace).handle;
        description.finger = soft ? skin : SoftFinger{};
        session.add_proxy(description);
        BodyAddition lid = body(BoxShape{Vec3(0.03)}, Vec3(0.0), Motion::Dynamic, 0.2);
        lid.touch_material = {1000.0, 0.0, 0.9, 0.9};
        BodyAddition ice = body(PlaneShape{{0.0, 1.0, 0.0}, -0.03}, Vec3(0.0), Motion::Static);
        ice.description.material.friction = 0.0;
        lid.description.material.friction = 0.0;
        session.add_body(ice);
        const SessionHandle handle = session.add_body(lid).handle;
        session.settle();
        Nanoseconds now = 0;
        knob.position = {0.0, 0.041, 0.0};
        session.tick(now += period);
        knob.position = {0.0, 0.034, 0.0};
        testing::AuditScope audit;
        for (int i = 0; i <= 500; ++i) {
            const double half_angle = 0.5 * 0.001 * i;
            knob.rotation = {std::cos(half_angle), 0.0, std::sin(half_angle), 0.0};
            session.tick(now += period);
        }
        audit.finish();
        EXPECT_EQ(audit.allocations() + audit.frees(), 0u) << audit.describe();
        session.refresh();
        const SessionSnapshot& snapshot = session.snapshot();
        const BodyState* const state = state_of(snapshot.bodies, snapshot.body_count, handle);
        ASSERT_NE(state, nullptr);
        const double angle = 2.0 * std::asin(state->pose.rotation.y);
        EXPECT_NEAR(angle, soft ? 0.5 : 0.0, 0.01);
    }
}

TEST(Torsion, FingersWithoutFormAreRefused) {
    SessionRig rig;
    for (const SoftFinger& finger : {SoftFinger{-1.0, 0.01}, SoftFinger{1e5, 0.0}, SoftFinger{NAN, 0.01},
                                     SoftFinger{INFINITY, 0.01}, SoftFinger{1e5, NAN}}) {
        ProxyDescription description;
        description.device = rig.hand;
        description.finger = finger;
        EXPECT_NE(rig.session.add_proxy(description).error, "");
    }
}

}  // namespace
}  // namespace tactus::torsion_test
