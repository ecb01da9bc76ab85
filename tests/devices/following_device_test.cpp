#include "devices/following_device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <vector>

#include "core/math/body_motion.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::following_device_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;

// A second of ticks with a new target every 16 ms.
std::vector<DeviceSample> a_second_of_wild_targets(FollowingDevice& hand) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-0.1, 0.1);
    std::vector<DeviceSample> samples;
    for (Nanoseconds t = 0; t < 1000 * ms; t += ms) {
        if (t % (16 * ms) == 0) {
            hand.aim({{place(random), place(random), place(random)}, 0});
        }
        samples.push_back(hand.read(t));
    }
    return samples;
}

TEST(UnderPointer, KeepsTheDepthAndTakesThePlaceOfThePointer) {
    const ScreenRay ray{Vec3(0, 0, 1), glm::normalize(Vec3(0.5, 0, -1)), Vec3(0, 0, -1)};
    const std::optional<Vec3> place = under_pointer(ray, Vec3(0, 0.3, -1), 0.0);
    ASSERT_TRUE(place);
    EXPECT_LT(glm::length(*place - Vec3(1, 0, -1)), 1e-12);
    EXPECT_LT(glm::length(*under_pointer(ray, *place, 2.0) - Vec3(2, 0, -3)), 1e-12);
}

TEST(UnderPointer, StaysBeforeTheCamera) {
    const ScreenRay ray{Vec3(0.0), Vec3(0, 0, -1), Vec3(0, 0, -1)};
    EXPECT_NEAR(under_pointer(ray, Vec3(0, 0, -0.1), -5.0)->z, -0.02, 1e-12);
    EXPECT_NEAR(under_pointer(ray, Vec3(0, 0, 7), 0.0)->z, -0.02, 1e-12) << "from behind";
}

TEST(UnderPointer, LeadsToNoPlaceWhereTheCameraSeesNone) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(under_pointer({Vec3(0.0), Vec3(1, 0, 0), Vec3(0, 0, -1)}, Vec3(0, 0, -1), 0.0));
    EXPECT_FALSE(under_pointer({Vec3(0.0), Vec3(none), Vec3(0, 0, -1)}, Vec3(0, 0, -1), 0.0));
    EXPECT_FALSE(under_pointer({Vec3(none), Vec3(0, 0, -1), Vec3(0, 0, -1)}, Vec3(0, 0, -1), 0.0));
    EXPECT_FALSE(under_pointer({Vec3(0, 0, 1e9), Vec3(0, 0, -1), Vec3(0, 0, -1)}, Vec3(0, 0, 1e9), 0.0));
}

TEST(TurnFollower, ComesToItsTargetByTheShortestWay) {
    const Quat target = glm::angleAxis(2.0, glm::normalize(Vec3(1.0, 2.0, -1.0)));
    TurnFollower turn;
    double farther = angle_between(turn.rotation, target);
    for (int i = 0; i < 200; ++i) {
        turn = follow(turn, target, 80.0, 0.001);
        const double now = angle_between(turn.rotation, target);
        ASSERT_LE(now, farther) << "in step " << i;
        ASSERT_NEAR(std::abs(glm::dot(Vec3(turn.rotation.x, turn.rotation.y, turn.rotation.z),
                                      glm::normalize(Vec3(1.0, 2.0, -1.0)))),
                    std::sqrt(1.0 - turn.rotation.w * turn.rotation.w), 1e-9)
            << "about another axis";
        farther = now;
    }
    EXPECT_LT(farther, 1e-5);
    EXPECT_LT(glm::length(turn.velocity), 1e-3);
}

TEST(TurnFollower, ManySmallStepsAreOneLargeStep) {
    const Quat target = glm::angleAxis(1.0, Vec3(0.0, 1.0, 0.0));
    const TurnFollower start{Quat(1.0, 0.0, 0.0, 0.0), {0.0, 3.0, 0.0}};
    TurnFollower small = start;
    for (int i = 0; i < 100; ++i) {
        small = follow(small, target, 80.0, 0.0003);
    }
    const TurnFollower large = follow(start, target, 80.0, 0.03);
    EXPECT_LT(angle_between(small.rotation, large.rotation), 1e-9);
    EXPECT_LT(glm::length(small.velocity - large.velocity), 1e-8);
}

TEST(FollowingDevice, TurnsWhereItsTargetsTurn) {
    const Quat target = glm::angleAxis(0.7, Vec3(0.0, 0.0, 1.0));
    for (const bool rotates : {false, true}) {
        FollowingDevice hand({.rotates = rotates});
        EXPECT_EQ(hand.capabilities().rotates, rotates);
        hand.aim({Vec3(0.0), 0, true, target});
        Quat last;
        for (Nanoseconds t = 0; t < 500 * ms; t += ms) {
            last = hand.read(t).rotation;
        }
        EXPECT_LT(angle_between(last, rotates ? target : Quat(1.0, 0.0, 0.0, 0.0)), 1e-6);
    }
}

TEST(Follower, ManySmallStepsAreOneLargeStep) {
    const Vec3 target{1.0, -2.0, 0.5};
    const Follower start{{0.2, 0.1, 0.0}, {3.0, 0.0, -1.0}};
    Follower small = start;
    for (int i = 0; i < 100; ++i) {
        small = follow(small, target, 80.0, 0.0003);
    }
    const Follower large = follow(start, target, 80.0, 0.03);
    EXPECT_LE(glm::length(small.position - large.position), 1e-12);
    EXPECT_LE(glm::length(small.velocity - large.velocity), 1e-10);
}

TEST(Follower, ObeysItsEquation) {
    const double rate = 50.0;
    const double h = 1e-5;
    const Vec3 target{1.0, 0.0, 0.0};
    const Follower now{{0.3, 0.2, 0.0}, {0.0, 1.0, 0.0}};
    const Follower soon = follow(now, target, rate, h);
    const Vec3 acceleration = (soon.velocity - now.velocity) / h;
    const Vec3 expected = rate * rate * (target - now.position) - 2.0 * rate * now.velocity;
    EXPECT_LE(glm::length(acceleration - expected), 1e-2 * glm::length(expected));
}

TEST(FollowingDevice, RestsWhereItWasPutUntilItIsAimed) {
    FollowingDevice hand({.rest = {0.1, 0.2, 0.3}});
    for (Nanoseconds t = 0; t < 10 * ms; t += ms) {
        const DeviceSample sample = hand.read(t);
        EXPECT_EQ(sample.position, Vec3(0.1, 0.2, 0.3));
        EXPECT_EQ(sample.velocity, Vec3(0.0));
        EXPECT_TRUE(sample.connected);
    }
}

TEST(FollowingDevice, ReachesTheTargetWithoutOvershootAndHoldsThere) {
    FollowingDevice hand({});
    hand.aim({{0.1, 0.0, 0.0}, 0});
    double before = -1.0;
    for (Nanoseconds t = 0; t < 500 * ms; t += ms) {
        const double x = hand.read(t).position.x;
        EXPECT_GE(x, before);
        EXPECT_LE(x, 0.1);
        before = x;
    }
    const DeviceSample end = hand.read(2000 * ms);
    EXPECT_NEAR(end.position.x, 0.1, 1e-12);
    EXPECT_NEAR(end.velocity.x, 0.0, 1e-9);
}

TEST(FollowingDevice, NineTenthsOfAJumpTakeWhatTheRateSays) {
    FollowingDevice hand({.rate = 80.0});
    hand.aim({{1.0, 0.0, 0.0}, 0});
    hand.read(0);
    EXPECT_NEAR(hand.read(from_seconds(3.8897 / 80.0)).position.x, 0.9, 1e-4);
}

// Trapezoids of the velocity against the way gone: the force law's damping must see the motion that the proxy
// sees.
TEST(FollowingDevice, TheVelocityBelongsToThePosition) {
    constexpr double largest_error = 2.0 * 0.35 * 80.0 * 80.0 * 80.0 * 1e-9 / 12.0;  // (unit: meters)
    FollowingDevice hand({});
    const std::vector<DeviceSample> samples = a_second_of_wild_targets(hand);
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const Vec3 gone = samples[i].position - samples[i - 1].position;
        const Vec3 by_velocity = 0.5e-3 * (samples[i].velocity + samples[i - 1].velocity);
        EXPECT_LE(glm::length(gone - by_velocity), largest_error);
    }
}

TEST(FollowingDevice, JumpsOfTheTargetAreNoJumpsOfTheHand) {
    FollowingDevice hand({});
    const std::vector<DeviceSample> samples = a_second_of_wild_targets(hand);
    constexpr double largest_jump = 0.35;  // across the cube of targets (unit: meters)
    for (std::size_t i = 1; i < samples.size(); ++i) {
        EXPECT_LE(glm::length(samples[i].position - samples[i - 1].position),
                  largest_jump * 80.0 / std::exp(1.0) * 1e-3);
    }
}

TEST(FollowingDevice, TheSameTargetsAtTheSameTicksAreTheSameHandToTheLastBit) {
    FollowingDevice one({});
    FollowingDevice other({});
    const auto a = a_second_of_wild_targets(one);
    const auto b = a_second_of_wild_targets(other);
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a[i].position, b[i].position);
        ASSERT_EQ(a[i].velocity, b[i].velocity);
    }
}

TEST(FollowingDevice, ButtonsAreThereAtTheNextTick) {
    FollowingDevice hand({});
    hand.aim({Vec3(0.0), 5});
    EXPECT_EQ(hand.read(0).buttons, 5u);
    hand.aim({Vec3(0.0), 0});
    EXPECT_EQ(hand.read(ms).buttons, 0u);
}

TEST(FollowingDevice, ReadingNeitherAllocatesNorLocks) {
    FollowingDevice hand({});
    testing::AuditScope audit;
    for (Nanoseconds t = 0; t < 50 * ms; t += ms) {
        hand.aim({Vec3(0.01), 1});
        hand.read(t);
        hand.write(t, Vec3(0.0));
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.locks() + audit.system_calls(), 0u) << audit.describe();
}

}  // namespace
}  // namespace tactus::following_device_test
