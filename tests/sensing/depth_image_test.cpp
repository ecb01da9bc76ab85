#include "sensing/image/depth_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tactus::depth_image_test {
namespace {

DepthImage slanted_image(const DepthCamera& camera) {
    DepthImage image{camera, std::vector<std::uint16_t>(pixel_count(camera)), 0};
    for (std::size_t i = 0; i < image.depth_mm.size(); ++i) {
        image.depth_mm[i] = static_cast<std::uint16_t>(800 + i % 7);
    }
    return image;
}

TEST(DepthImage, ThereAndBackThroughAPixel) {
    const DepthCamera camera = kinect_camera(320, 240);
    for (const double u : {0.0, 17.25, 160.0, 319.0}) {
        for (const double v : {0.0, 99.5, 239.0}) {
            const PixelPlace place = seen_at(camera, 1.7 * ray_through(camera, u, v));
            EXPECT_NEAR(place.u, u, 1e-10);
            EXPECT_NEAR(place.v, v, 1e-10);
            EXPECT_NEAR(place.depth, 1.7, 1e-12);
        }
    }
}

// Right, up and towards the camera make a right-handed frame, as in Godot.
TEST(DepthImage, TheFrameIsGodots) {
    const DepthCamera camera = kinect_camera(320, 240);
    const Vec3 middle = ray_through(camera, 160.0, 120.0);
    const Vec3 right = ray_through(camera, 161.0, 120.0) - middle;
    const Vec3 up = ray_through(camera, 160.0, 119.0) - middle;
    EXPECT_EQ(middle, Vec3(0.0, 0.0, -1.0));
    EXPECT_GT(right.x, 0.0);
    EXPECT_GT(up.y, 0.0);
    EXPECT_GT(glm::cross(right, up).z, 0.0);
}

TEST(DepthImage, TheAngleOfViewIsThatOfTheWholeImage) {
    const DepthCamera camera = camera_of_view(320, 240, 1.0, 0.8);
    EXPECT_NEAR(ray_through(camera, 0.0, 120.0).x, -std::tan(0.5), 1e-12);
    EXPECT_NEAR(ray_through(camera, 160.0, 240.0).y, -std::tan(0.4), 1e-12);
}

TEST(DepthImage, MillimetersAreRounded) {
    DepthBuffer buffer;
    buffer.clear({4, 1, 1.0, 1.0, 2.0, 0.5});
    buffer.depth = {0.8504f, 0.8506f, 65.6f, std::numeric_limits<float>::infinity()};
    EXPECT_EQ(to_image(buffer, 0).depth_mm, (std::vector<std::uint16_t>{850, 851, 0, 0}));
}

TEST(DepthImage, ASoundOneHasNoFault) {
    EXPECT_EQ(check_image(slanted_image(kinect_camera(320, 240))), "");
}

TEST(DepthImage, WhatNothingCanBeFoundInIsSaid) {
    const DepthCamera camera = kinect_camera(32, 24);
    DepthImage empty{camera, std::vector<std::uint16_t>(pixel_count(camera)), 0};
    EXPECT_NE(check_image(empty).find("no depth"), std::string::npos);

    DepthImage constant{camera, std::vector<std::uint16_t>(pixel_count(camera), 900), 0};
    EXPECT_NE(check_image(constant).find("same depth"), std::string::npos);
    constant.depth_mm[5] = 0;  // a hole makes no difference
    EXPECT_NE(check_image(constant).find("same depth"), std::string::npos);

    DepthImage cut = slanted_image(camera);
    cut.depth_mm.pop_back();
    EXPECT_NE(check_image(cut).find("767 pixels where 768"), std::string::npos);
}

TEST(DepthImage, ACameraThatMakesNoSenseIsSaid) {
    const DepthImage sound = slanted_image(kinect_camera(32, 24));
    const auto fault_of = [&sound](auto change) {
        DepthImage image = sound;
        change(image.camera);
        return check_image(image);
    };
    EXPECT_NE(fault_of([](DepthCamera& camera) { camera.width = -32; }), "");
    EXPECT_NE(fault_of([](DepthCamera& camera) { camera.width = 1 << 30; }), "");
    EXPECT_NE(fault_of([](DepthCamera& camera) { camera.focal_x = 0.0; }), "");
    EXPECT_NE(fault_of([](DepthCamera& camera) { camera.focal_y = std::nan(""); }), "");
    EXPECT_NE(fault_of([](DepthCamera& camera) { camera.center_x = INFINITY; }), "");
}

}  // namespace
}  // namespace tactus::depth_image_test
