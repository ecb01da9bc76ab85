#include "devices/hand_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "support/realtime_audit.hpp"

namespace tactus::hand_path_test {
namespace {

constexpr Nanoseconds second = nanoseconds_per_second;

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
    EXPECT_LE(glm::length(a - b), tolerance);
}

// The velocity as the slope of the positions 1 µs to either side.
Vec3 slope(const HandPath& path, Nanoseconds time) {
    constexpr Nanoseconds h = 1'000;
    return (sample_path(path, time + h).position - sample_path(path, time - h).position) / to_seconds(2 * h);
}

KeyframePath corner(PathInterpolation interpolation) {
    return {{{0, {0.0, 0.0, 0.0}}, {second, {1.0, 0.0, 0.0}}, {3 * second, {1.0, 2.0, 0.0}}},
            interpolation,
            false};
}

KeyframePath square_loop() {
    return {{{0, {0.0, 0.0, 0.0}},
             {second, {1.0, 0.0, 0.0}},
             {2 * second, {1.0, 1.0, 0.0}},
             {4 * second, {0.0, 1.0, 0.0}},
             {5 * second, {0.0, 0.0, 0.0}}},
            PathInterpolation::catmull_rom,
            true};
}

TEST(CircleWave, IsACircleInXZ) {
    const CircleWave path{.centre = {1.0, 2.0, 3.0}, .radius = 0.3};
    for (Nanoseconds t = 0; t < 10 * second; t += second / 7) {
        const Vec3 offset = sample_path(path, t).position - path.centre;
        EXPECT_NEAR(std::hypot(offset.x, offset.z), 0.3, 1e-12);
    }
}

TEST(CircleWave, TakesTenSecondsForATurn) {
    const CircleWave path;
    expect_near(sample_path(path, 0).position, {0.25, 0.0, 0.0}, 1e-12);
    expect_near(sample_path(path, 5 * second).position, {-0.25, 0.0, 0.0}, 1e-12);
    expect_near(sample_path(path, 2'500'000'000).position - Vec3(0.0, 0.05, 0.0), {0.0, 0.0, 0.25}, 1e-12);
}

TEST(CircleWave, GoesThroughTheGroundAndUpAgainWithEachWave) {
    const CircleWave path{.centre = {0.0, 0.02, 0.0}, .amplitude = 0.05, .waves = 5};
    int down = 0;
    int up = 0;
    double before = sample_path(path, 0).position.y;
    for (Nanoseconds t = 1'000'000; t <= path.turn_time; t += 1'000'000) {
        const double y = sample_path(path, t).position.y;
        down += before >= 0.0 && y < 0.0 ? 1 : 0;
        up += before < 0.0 && y >= 0.0 ? 1 : 0;
        before = y;
    }
    EXPECT_EQ(down, 5);
    EXPECT_EQ(up, 5);
}

TEST(CircleWave, TheVelocityIsThePositionsSlope) {
    const CircleWave path{.centre = {0.1, 0.2, 0.3}, .waves = 3};
    for (Nanoseconds t = second / 3; t < 10 * second; t += second / 3) {
        expect_near(sample_path(path, t).velocity, slope(path, t), 1e-7);
    }
}

TEST(CircleWave, EveryTurnIsTheSameToTheLastBit) {
    const CircleWave path;
    const Nanoseconds t = 1'234'567'891;
    EXPECT_EQ(sample_path(path, t).position, sample_path(path, t + 1000 * path.turn_time).position);
}

TEST(CircleWave, RestsAtItsStartBeforeItBegins) {
    const CircleWave path;
    EXPECT_EQ(sample_path(path, -second).position, sample_path(path, 0).position);
    EXPECT_EQ(sample_path(path, -second).velocity, Vec3(0.0));
}

TEST(KeyframePath, LinearGoesStraightAtEvenSpeed) {
    const KeyframePath path = corner(PathInterpolation::linear);
    expect_near(sample_path(path, second / 4).position, {0.25, 0.0, 0.0}, 1e-15);
    expect_near(sample_path(path, 2 * second).position, {1.0, 1.0, 0.0}, 1e-15);
    expect_near(sample_path(path, 2 * second).velocity, {0.0, 1.0, 0.0}, 1e-15);
}

TEST(KeyframePath, BothKindsGoThroughEveryKeyframe) {
    for (const auto interpolation : {PathInterpolation::linear, PathInterpolation::catmull_rom}) {
        const KeyframePath path = corner(interpolation);
        for (const Keyframe& key : path.keyframes) {
            expect_near(sample_path(path, key.time).position, key.position, 1e-15);
        }
    }
}

TEST(KeyframePath, CatmullRomsVelocityIsThePositionsSlope) {
    for (const KeyframePath& path : {corner(PathInterpolation::catmull_rom), square_loop()}) {
        for (Nanoseconds t = second / 8; t < 2'900'000'000; t += second / 8) {
            expect_near(sample_path(path, t).velocity, slope(path, t), 1e-5);
        }
    }
}

TEST(KeyframePath, CatmullRomsVelocityIsContinuousAtKeyframesAndAcrossTheLoop) {
    const KeyframePath path = square_loop();
    for (const Keyframe& key : path.keyframes) {
        const Vec3 before = sample_path(path, key.time + 5 * second - 1).velocity;
        const Vec3 after = sample_path(path, key.time + 5 * second).velocity;
        expect_near(before, after, 1e-7);
    }
}

TEST(KeyframePath, CatmullRomOnEvenPointsOfALineIsThatLine) {
    const KeyframePath path{{{0, {0, 0, 0}}, {second, {1, 2, 3}}, {2 * second, {2, 4, 6}}},
                            PathInterpolation::catmull_rom,
                            false};
    for (Nanoseconds t = 0; t < 2 * second; t += second / 10) {
        expect_near(sample_path(path, t).position, to_seconds(t) * Vec3(1, 2, 3), 1e-14);
        expect_near(sample_path(path, t).velocity, Vec3(1, 2, 3), 1e-13);
    }
}

TEST(KeyframePath, RestsBeforeTheFirstAndAfterTheLastKeyframe) {
    const KeyframePath path = corner(PathInterpolation::catmull_rom);
    for (const auto& [time, place] :
         {std::pair{-second, Vec3(0.0)}, std::pair{9 * second, Vec3(1.0, 2.0, 0.0)}}) {
        EXPECT_EQ(sample_path(path, time).position, place);
        EXPECT_EQ(sample_path(path, time).velocity, Vec3(0.0));
    }
}

TEST(KeyframePath, ALoopBeginsAgain) {
    const KeyframePath path = square_loop();
    for (Nanoseconds t = 0; t < 5 * second; t += second / 3) {
        EXPECT_EQ(sample_path(path, t).position, sample_path(path, t + 15 * second).position);
    }
}

TEST(KeyframePath, OneKeyframeIsAPlace) {
    const KeyframePath path{.keyframes = {{second, {1.0, 2.0, 3.0}}}};
    EXPECT_EQ(problem_with(path), "");
    for (const Nanoseconds t : {Nanoseconds{0}, second, 2 * second}) {
        EXPECT_EQ(sample_path(path, t).position, Vec3(1.0, 2.0, 3.0));
        EXPECT_EQ(sample_path(path, t).velocity, Vec3(0.0));
    }
}

TEST(KeyframePath, TwoKeyframesMayLoop) {
    const KeyframePath path{{{0, {1, 0, 0}}, {second, {1, 0, 0}}}, PathInterpolation::catmull_rom, true};
    EXPECT_EQ(problem_with(path), "");
    EXPECT_EQ(sample_path(path, 7 * second / 2).position, Vec3(1, 0, 0));
}

TEST(HandPath, SaysWhatIsWrong) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(problem_with(CircleWave{}), "");
    EXPECT_EQ(problem_with(corner(PathInterpolation::linear)), "");
    EXPECT_EQ(problem_with(square_loop()), "");
    EXPECT_NE(problem_with(CircleWave{.radius = -1.0}), "");
    EXPECT_NE(problem_with(CircleWave{.amplitude = nan}), "");
    EXPECT_NE(problem_with(CircleWave{.turn_time = 0}), "");
    EXPECT_NE(problem_with(KeyframePath{}), "");
    EXPECT_NE(problem_with(KeyframePath{.keyframes = {{0, {0, nan, 0}}}}), "");
    EXPECT_NE(problem_with(KeyframePath{.keyframes = {{5, {0, 0, 0}}, {5, {1, 0, 0}}}}), "");
    EXPECT_NE(problem_with(KeyframePath{.keyframes = {{0, {0, 0, 0}}}, .loop = true}), "");
    EXPECT_NE(problem_with(KeyframePath{.keyframes = {{0, {0, 0, 0}}, {5, {1, 0, 0}}}, .loop = true}), "");
}

TEST(HandPath, KnowsHowLongItLasts) {
    EXPECT_EQ(path_duration(CircleWave{}), 10 * second);
    EXPECT_EQ(path_duration(square_loop()), 5 * second);
}

TEST(HandPath, SamplingNeitherAllocatesNorLocks) {
    const HandPath circle = CircleWave{};
    const HandPath loop = square_loop();
    testing::AuditScope audit;
    Vec3 sum{0.0};
    for (Nanoseconds t = 0; t < 10 * second; t += second / 10) {
        sum += sample_path(circle, t).position + sample_path(loop, t).position;
    }
    audit.finish();
    EXPECT_TRUE(std::isfinite(sum.x));
    EXPECT_EQ(audit.allocations() + audit.locks() + audit.system_calls(), 0u) << audit.describe();
}

TEST(HandPath, APointIsAPlaceWithinReach) {
    for (const double far :
         {2e6, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        KeyframePath path;
        path.keyframes = {{0, Vec3(0.0)}, {1'000'000'000, Vec3(far, 0, 0)}};
        EXPECT_EQ(problem_with(path), "point 1 is no place within 1,000,000 m: set it anew");
    }
}

TEST(KeyframePath, AtOneSpeedEveryPieceTakesAsLongAsItIs) {
    const KeyframePath path = at_speed({{0.0, 0.0, 0.0}, {0.3, 0.0, 0.0}, {0.0, 0.0, 0.0}}, 0.1, true);
    EXPECT_EQ(problem_with(path), "");
    EXPECT_TRUE(path.loop);
    EXPECT_EQ(path_duration(path), from_seconds(6.0));
    for (const double time : {0.5, 2.9, 5.5}) {
        EXPECT_NEAR(glm::length(sample_path(path, from_seconds(time)).velocity), 0.1, 1e-12) << time;
    }
    EXPECT_TRUE(at_speed({}, 0.1, false).keyframes.empty());
}

}  // namespace
}  // namespace tactus::hand_path_test
