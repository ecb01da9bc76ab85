#include "core/teleop/robot_drive.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/math/body_motion.hpp"
#include "shared/random_values.hpp"

namespace tactus::robot_drive_test {
namespace {

constexpr double tick = 1e-3;

// A mass with friction that is driven and pushed; returns what the observer makes of it after a while.
Vec3 observed(const RobotBody& body, const Vec3& drive, const Vec3& push, double seconds) {
    ContactObserver observer;
    Vec3 velocity(0.0);
    Vec3 contact = observer.observe(body, drive, velocity, tick);
    for (double t = 0.0; t < seconds; t += tick) {
        velocity += tick / body.mass * (drive + push - friction_of(body, velocity));
        contact = observer.observe(body, drive, velocity, tick);
    }
    return contact;
}

TEST(ContactObserver, FindsThePushWhateverTheMotorsDo) {
    shared::RandomValues random(1);
    for (int i = 0; i < 100; ++i) {
        const RobotBody body{random.between(0.1, 1.0), random.between(0.5, 5.0), random.between(0.0, 0.3)};
        const Vec3 push = random.direction() * random.between(0.0, 5.0);
        const Vec3 drive = random.direction() * random.between(0.0, 5.0);
        EXPECT_LT(glm::distance(observed(body, drive, push, 0.5), push), 0.02 * glm::length(push) + 0.02);
    }
}

TEST(ContactObserver, SeesNothingWhereNothingIs) {
    const RobotBody body{0.3, 2.0, 0.2};
    EXPECT_LT(glm::length(observed(body, {1.0, 0.5, 0.0}, Vec3(0.0), 0.05)), 0.02);
}

TEST(ContactObserver, IsAsLateAsItsBandwidth) {
    const RobotBody body{0.3, 2.0, 0.0};
    const double share = observed(body, Vec3(0.0), {1.0, 0.0, 0.0}, 1.0 / ContactObserver::bandwidth).x;
    EXPECT_NEAR(share, 1.0 - std::exp(-1.0), 0.1);
}

TEST(RobotDrive, GoesTowardsTheHandNoFasterThanAllowedAndNoFartherThanItReaches) {
    Vec3 at(0.0);
    for (int i = 0; i < 1'000; ++i) {
        const Vec3 before = at;
        at = next_target(at, {0.1, 0.0, 0.0}, 0.5, Vec3(0.0), 0.04, tick);
        EXPECT_LE(glm::distance(before, at), 0.5 * tick * (1.0 + 1e-12));
    }
    EXPECT_NEAR(at.x, 0.04, 1e-12);
}

TEST(RobotDrive, GoesGentlyToAHandThatRestsAndATwentiethFasterThanOneThatMoves) {
    EXPECT_DOUBLE_EQ(follow_speed(0.5, 1.0), 0.525);
    EXPECT_DOUBLE_EQ(follow_speed(0.0, 1.0), 0.2);
    EXPECT_DOUBLE_EQ(follow_speed(3.0, 1.0), 1.0);
    EXPECT_DOUBLE_EQ(follow_speed(0.0, 0.05), 0.05);
}

TEST(RobotDrive, TurnsTowardsTheHandTheShortWayNoFasterThanAllowed) {
    shared::RandomValues random(3);
    for (int i = 0; i < 100; ++i) {
        const Quat hand = glm::angleAxis(random.between(-3.0, 3.0), random.direction());
        Quat at(1.0, 0.0, 0.0, 0.0);
        const double whole = angle_between(at, hand);
        const int ticks = static_cast<int>(std::ceil(whole / (2.0 * tick)));
        for (int j = 0; j < ticks; ++j) {
            const Quat before = at;
            at = next_turn(at, j % 2 == 0 ? hand : -hand, 2.0, tick);
            EXPECT_LE(angle_between(before, at), 2.0 * tick * (1.0 + 1e-6));
        }
        EXPECT_LT(angle_between(at, hand), 1e-9);
    }
}

// An inertia with friction, turned by a quarter from any side: it ends where it is wanted.
TEST(RobotDrive, ATorqueTurnsItWhereItIsWanted) {
    shared::RandomValues random(4);
    for (int i = 0; i < 20; ++i) {
        const Quat wanted = glm::angleAxis(1.5, random.direction());
        Quat rotation(1.0, 0.0, 0.0, 0.0);
        Vec3 spin(0.0);
        for (int j = 0; j < 2'000; ++j) {
            spin += tick / 1e-4 * drive_torque({1.0, 0.01}, wanted, Vec3(0.0), rotation, spin);
            rotation = glm::normalize(turn_by(spin, tick) * rotation);
        }
        EXPECT_LT(angle_between(rotation, wanted), 1e-6);
    }
}

}  // namespace
}  // namespace tactus::robot_drive_test
