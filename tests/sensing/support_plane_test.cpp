#include "sensing/discovery/support_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "shared/depth_scenes.hpp"

namespace tactus {
namespace {

using shared::camera_above_table;
using shared::DepthScene;

struct TableView {
    Pose camera = camera_above_table(0.85, 0.8);
    DepthBuffer exact;

    TableView() { shared::draw_scene({}, DepthScene{kinect_camera(320, 240), camera, {}}, exact); }
    Vec3 up() const { return direction_to_local(camera, {0.0, 1.0, 0.0}); }
    double height() const { return camera.position.y; }
    PlaneSearch search() const {
        PlaneSearch search;
        search.up = up();
        return search;
    }
};

DepthNoise calibrated() {
    DepthNoise noise;
    noise.error_share = 0.0;
    return noise;
}

TEST(SupportPlane, IsFoundInNoiseToATenthOfAMillimeter) {
    const TableView view;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const auto fit = find_plane(noisy_image(view.exact, calibrated(), seed, 0), {}, view.search());
        ASSERT_TRUE(fit);
        EXPECT_NEAR(fit->plane.distance(), view.height(), 1e-4);
        EXPECT_GT(glm::dot(fit->plane.normal(), view.up()), std::cos(1e-3));
        EXPECT_LT(fit->residual, 0.003);
        EXPECT_GT(fit->share, 0.9);
    }
}

TEST(SupportPlane, IsFollowedWhereTheCameraMoves) {
    const TableView view;
    const auto fit = find_plane(noisy_image(view.exact, calibrated(), 1, 0), {}, view.search());
    ASSERT_TRUE(fit);
    DepthBuffer moved;
    const Pose camera = camera_above_table(0.853, 0.803);
    shared::draw_scene({}, DepthScene{kinect_camera(320, 240), camera, {}}, moved);
    const auto followed = follow_plane(noisy_image(moved, calibrated(), 2, 0), {}, fit->plane, 0.08);
    ASSERT_TRUE(followed);
    EXPECT_NEAR(followed->plane.distance(), camera.position.y, 1e-4);
}

TEST(SupportPlane, HeightsOverItAreLinearInDepth) {
    const ImagePlane plane{Vec3(0.2, -1.1, -0.7)};
    const DepthCamera camera = kinect_camera(320, 240);
    const HeightOverImage height = height_over_image(camera, plane);
    for (const double u : {0.0, 100.0, 319.0}) {
        for (const double v : {0.0, 200.0}) {
            for (const double depth : {0.5, 1.5}) {
                const Vec3 point = depth * ray_through(camera, u, v);
                EXPECT_NEAR(depth * (height.a * u + height.b * v + height.c) + height.d,
                            glm::dot(plane.normal(), point) + plane.distance(), 1e-12);
            }
        }
    }
    EXPECT_NEAR(glm::dot(plane.normal(), plane.m), -1.0 / plane.distance(), 1e-12);
}

TEST(SupportPlane, AWallIsNone) {
    const TableView view;
    PlaneSearch search = view.search();
    search.up = Vec3(0.0, 0.0, 1.0);  // as if the camera looked at a wall
    const Vec3 level = view.up();
    ASSERT_LT(glm::dot(level, search.up), std::cos(search.max_tilt));
    EXPECT_FALSE(find_plane(noisy_image(view.exact, calibrated(), 1, 0), {}, search));
}

TEST(SupportPlane, NoDepthHasNone) {
    const TableView view;
    const DepthCamera camera = kinect_camera(320, 240);
    DepthImage empty{camera, std::vector<std::uint16_t>(pixel_count(camera)), 0};
    EXPECT_FALSE(find_plane(empty, {}, view.search()));
    EXPECT_FALSE(follow_plane(empty, {}, ImagePlane{}, 0.08));
    empty.depth_mm[5000] = 900;  // one pixel is no plane either
    EXPECT_FALSE(find_plane(empty, {}, view.search()));
}

}  // namespace
}  // namespace tactus
