// A force that the owner computes, in a session: felt, safe, and recorded with all else.
#include <cmath>
#include <limits>

#include "core/haptics/measured_field.hpp"
#include "recorded_inputs.hpp"
#include "session_rig.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::hand_field_test {
namespace {

using namespace session_test;

FieldMoment even(const Vec3& force) {
    FieldMoment moment;
    moment.force = force;
    return moment;
}

FieldMoment spring(double stiffness, const Vec3& hand) {
    return {hand, Vec3(0.0), -stiffness * hand, Mat3(-stiffness), Mat3(0.0)};
}

TEST(SessionField, IsFeltByTheHandBesideWhatItTouches) {
    SessionRig rig;
    rig.add(ground());
    rig.device.position = {0.0, 0.05, 0.0};
    rig.tick();
    rig.draw({0.0, 0.005, 0.0}, 50);
    for (int i = 0; i < 200; ++i) {
        if (i % 16 == 0) {
            FieldMoment moment = even({2.0, 0.0, 0.0});
            moment.place = rig.device.position;
            rig.session.set_hand_field(rig.proxy, moment);
        }
        rig.tick();
    }
    EXPECT_NEAR(rig.device.force.x, 2.0, 1e-6);
    EXPECT_NEAR(rig.device.force.y, 500.0 * 0.005, 1e-3);
}

TEST(SessionField, IsGoneWhenTheOwnerFallsSilent) {
    SessionRig rig;
    rig.session.set_hand_field(rig.proxy, even({2.0, 0.0, 0.0}));
    rig.ticks(60);
    EXPECT_NEAR(rig.device.force.x, 2.0, 1e-6);
    rig.ticks(200);
    EXPECT_EQ(rig.device.force.x, 0.0);
}

// The device bears 800 N/m at 1 kHz: half of it for the field, and the wall has what that leaves.
TEST(SessionField, FieldAndWallTogetherAreNoStifferThanIsSafe) {
    SessionRig rig;
    rig.device.can.damping = 0.4;
    BodyAddition wall = ground();
    wall.touch_material.stiffness = 10'000.0;
    rig.add(wall);
    rig.device.position = {0.0, 0.05, 0.0};
    rig.tick();
    rig.draw({0.0, 0.0, 0.0}, 50);
    for (int i = 0; i < 500; ++i) {
        if (i % 16 == 0) {
            rig.session.set_hand_field(rig.proxy, spring(5'000.0, {0.0, 0.0, 0.0}));
        }
        rig.tick();
    }
    EXPECT_NEAR(rig.device.force.y, 400.0 * 0.01, 1e-3) << "at the field's middle: of the wall alone";
    rig.ticks(300);
    EXPECT_NEAR(rig.device.force.y, 800.0 * 0.01, 1e-3) << "the field is silent";
}

TEST(SessionField, NonsenseIsNotTaken) {
    SessionRig rig;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const auto refused = [&](auto&& spoil) {
        FieldMoment moment = even({1.0, 0.0, 0.0});
        spoil(moment);
        rig.session.set_hand_field(rig.proxy, moment);
    };
    refused([](FieldMoment& m) { m.place = Vec3(nan); });
    refused([](FieldMoment& m) { m.velocity = Vec3(nan); });
    refused([](FieldMoment& m) { m.force.y = nan; });
    refused([](FieldMoment& m) { m.force.x = 1e9; });
    refused([](FieldMoment& m) { m.by_place = Mat3(nan); });
    refused([](FieldMoment& m) { m.by_place = Mat3(1e300); });
    refused([](FieldMoment& m) { m.by_velocity = Mat3(nan); });
    const auto refused_line = [&](auto&& spoil) {
        refused([&](FieldMoment& m) {
            m.line.direction = {0.0, 1.0, 0.0};
            m.line.near = 0.01;
            m.line.add(-0.01, m.force);
            m.line.add(0.01, m.force);
            spoil(m.line);
        });
    };
    refused_line([](FieldLine& line) { line.at[0] = nan; });
    refused_line([](FieldLine& line) { line.at[0] = line.at[1]; });
    refused_line([](FieldLine& line) { line.at[1] = 1e9; });
    refused_line([](FieldLine& line) { line.force[1].z = nan; });
    refused_line([](FieldLine& line) { line.direction *= 2.0; });
    refused_line([](FieldLine& line) { line.direction = Vec3(nan); });
    refused_line([](FieldLine& line) { line.near = -0.1; });
    refused_line([](FieldLine& line) { line.count = 1; });
    refused_line([](FieldLine& line) { line.count = -3; });
    refused_line([](FieldLine& line) { line.count = FieldLine::most + 1; });
    refused_line([](FieldLine& line) { line = {}, line.direction = {1.0, 0.0, 0.0}; });
    rig.session.set_hand_field(99, even({1.0, 0.0, 0.0}));
    rig.ticks(60);
    EXPECT_EQ(rig.device.force, Vec3(0.0));
}

TEST(SessionField, IsPlayedAgainToTheSameBitsAndAllocatesNothing) {
    RecordedInputs inputs;
    SessionRig rig({}, &inputs.recorder);
    rig.add(ground());
    rig.session.settle();
    FieldMoment told;
    const auto teeth = [](const HandMotion& hand) {
        const double at = 200.0 * hand.position.x;
        return std::optional(Vec3(3.0 * (at - std::floor(at)), -150.0 * hand.position.y, 0.0));
    };
    for (int i = 0; i < 1000; ++i) {
        rig.device.position = {0.02 * std::sin(0.01 * i), 0.02 + 0.015 * std::sin(0.02 * i), 0.0};
        if (i % 16 == 0) {
            told = *measured_field({rig.device.position, Vec3(0.0)}, told, teeth);
            rig.session.set_hand_field(rig.proxy, told);
        }
        testing::AuditScope audit;
        rig.tick();
        audit.finish();
        ASSERT_EQ(audit.allocations() + audit.frees() + audit.waits(), 0u) << audit.describe();
    }
    inputs.end();
    expect_whole(inputs.play(), 1'000);
}

}  // namespace
}  // namespace tactus::hand_field_test
