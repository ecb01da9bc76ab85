#include "sensing/image/depth_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::depth_noise_test {
namespace {

constexpr int width = 160, height = 120;

DepthBuffer wall(double depth) {
    DepthBuffer buffer;
    buffer.clear(kinect_camera(width, height));
    std::ranges::fill(buffer.depth, static_cast<float>(depth));
    return buffer;
}

// The left half is nearer than the right one, or farther.
DepthBuffer two_walls(double left, double right) {
    DepthBuffer buffer = wall(right);
    for (std::size_t i = 0; i < buffer.depth.size(); ++i) {
        buffer.depth[i] = static_cast<float>(i % width < width / 2 ? left : right);
    }
    return buffer;
}

DepthNoise none() {
    DepthNoise noise;
    noise.random = noise.step = noise.edge_jitter = noise.hole_share = noise.baseline = noise.error_share =
        0.0;
    return noise;
}

struct Spread {
    double mean = 0.0, deviation = 0.0, holes = 0.0;
};

Spread spread_of(const DepthImage& image) {
    double sum = 0.0, squares = 0.0, seen = 0.0;
    for (const std::uint16_t depth : image.depth_mm) {
        sum += depth;
        squares += static_cast<double>(depth) * depth;
        seen += depth != 0;
    }
    const double mean = sum / seen;
    return {mean, std::sqrt(squares / seen - mean * mean),
            1.0 - seen / static_cast<double>(image.depth_mm.size())};
}

TEST(DepthNoise, WithoutAnyTheImageIsExact) {
    const DepthBuffer exact = two_walls(0.8, 1.3);
    EXPECT_EQ(noisy_image(exact, none(), 1, 0).depth_mm, to_image(exact, 0).depth_mm);
}

TEST(DepthNoise, TheSameSeedGivesTheSameImage) {
    const DepthBuffer exact = two_walls(0.8, 1.3);
    EXPECT_EQ(noisy_image(exact, {}, 7, 0).depth_mm, noisy_image(exact, {}, 7, 0).depth_mm);
    EXPECT_NE(noisy_image(exact, {}, 7, 0).depth_mm, noisy_image(exact, {}, 8, 0).depth_mm);
}

TEST(DepthNoise, ChanceGrowsWithDepthAsMeasured) {
    DepthNoise noise = none();
    noise.random = 1.0;
    for (const auto& [depth, sigma_mm] : {std::pair{0.85, 1.585}, {1.3, 2.739}, {2.0, 6.064}}) {
        const Spread spread = spread_of(noisy_image(wall(depth), noise, 3, 0));
        EXPECT_NEAR(spread.mean, 1000.0 * depth, 0.1 * sigma_mm);
        // Rounding to whole millimeters adds 1/12.
        EXPECT_NEAR(spread.deviation, std::sqrt(sigma_mm * sigma_mm + 1.0 / 12.0), 0.03 * sigma_mm);
    }
}

TEST(DepthNoise, DepthComesInStepsOfDisparity) {
    DepthNoise noise = none();
    noise.step = 1.0 / 345.0;
    noise.random = 1.0;
    for (const std::uint16_t depth : noisy_image(wall(2.0), noise, 3, 0).depth_mm) {
        const double disparity = 345.0 / (1e-3 * depth);
        EXPECT_NEAR(disparity, std::round(disparity), 0.05);
    }
}

TEST(DepthNoise, TheErrorIsAShareOfDepth) {
    DepthNoise noise = none();
    noise.error_share = -0.01;
    EXPECT_EQ(noisy_image(wall(0.8), noise, 3, 0).depth_mm.front(), 792);
}

TEST(DepthNoise, OnlyPixelsBesideAnEdgeJitter) {
    DepthNoise noise = none();
    noise.edge_jitter = 0.4;
    const DepthImage image = noisy_image(two_walls(0.8, 1.3), noise, 3, 0);
    int strayed = 0;
    for (int i = 0; i < width * height; ++i) {
        const int u = i % width;
        const int told = image.depth_mm[static_cast<std::size_t>(i)];
        const bool as_it_is = told == (u < width / 2 ? 800 : 1300);
        strayed += !as_it_is;
        EXPECT_TRUE(as_it_is || (u >= width / 2 - 2 && u < width / 2 + 2));
    }
    EXPECT_GT(strayed, 5);
}

TEST(DepthNoise, HolesHaveTheirShare) {
    DepthNoise noise = none();
    noise.hole_share = 0.1;
    EXPECT_NEAR(spread_of(noisy_image(wall(0.8), noise, 3, 0)).holes, 0.1, 0.01);
}

TEST(DepthNoise, NothingIsSeenOfWhatIsTooNear) {
    EXPECT_EQ(spread_of(noisy_image(wall(0.3), none(), 3, 0)).holes, 1.0);
}

TEST(DepthNoise, NothingIsSeenOfASurfaceFromTheSide) {
    DepthNoise noise = none();
    const auto holes_at = [&noise](double angle) {
        DepthBuffer buffer = wall(1.0);
        for (std::size_t i = 0; i < buffer.depth.size(); ++i) {
            const double side = ray_through(buffer.camera, static_cast<double>(i % width), 0.0).x;
            // A plane through (0, 0, -1), turned about the vertical.
            buffer.depth[i] = static_cast<float>(1.0 / (1.0 + side * std::tan(angle)));
            buffer.depth[i] = buffer.depth[i] > 0.4f && buffer.depth[i] < 4.0f ? buffer.depth[i] : 100.0f;
        }
        const DepthImage image = noisy_image(buffer, noise, 3, 0);
        return image.depth_mm[60 * width + 80] == 0;
    };
    EXPECT_FALSE(holes_at(1.2));
    EXPECT_TRUE(holes_at(1.5));
}

// Left of a nearer object lies its shadow, as wide as the difference of disparities.
TEST(DepthNoise, WhatTheProjectorDoesNotReachIsDark) {
    DepthNoise noise = none();
    noise.baseline = 0.075;
    const DepthBuffer exact = two_walls(1.3, 0.8);
    const DepthImage image = noisy_image(exact, noise, 3, 0);
    const double wide = exact.camera.focal_x * noise.baseline * (1.0 / 0.8 - 1.0 / 1.3);
    for (int u = 0; u < width; ++u) {
        const double before_edge = width / 2 - u;
        const bool dark = image.depth_mm[static_cast<std::size_t>(u)] == 0;
        if (std::abs(before_edge - wide) > 1.5) {
            EXPECT_EQ(dark, before_edge > 0.0 && before_edge < wide) << u;
        }
    }
    EXPECT_EQ(spread_of(noisy_image(two_walls(0.8, 1.3), noise, 3, 0)).holes, 0.0);
}

TEST(DepthNoise, NoDepthIsFartherOffThanItSays) {
    DepthNoise noise = none();
    noise.random = 1.0;
    noise.step = 1.0 / 345.0;
    const double most = 1000.0 * largest_error(noise, 1.1) + 0.5;
    for (const std::uint16_t depth : noisy_image(wall(1.1), noise, 3, 0).depth_mm) {
        EXPECT_NEAR(depth, 1100.0, most);
    }
}

TEST(DepthNoise, NothingStaysNothing) {
    DepthBuffer empty;
    empty.clear(kinect_camera(width, height));
    EXPECT_EQ(spread_of(noisy_image(empty, {}, 3, 0)).holes, 1.0);
    std::ranges::fill(empty.depth, std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(spread_of(noisy_image(empty, {}, 3, 0)).holes, 1.0);
}

}  // namespace
}  // namespace tactus::depth_noise_test
