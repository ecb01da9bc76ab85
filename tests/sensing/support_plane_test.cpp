#include "sensing/discovery/support_plane.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "shared/depth_scenes.hpp"
#include "shared/meshes.hpp"

namespace tactus::support_plane_test {
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

std::optional<PlaneFit> find_plane(const DepthImage& image, const PlaneSearch& search) {
    const std::vector<PlaneFit> found = find_planes(image, {}, search, 1);
    return found.empty() ? std::nullopt : std::optional(found.front());
}

DepthNoise calibrated() {
    DepthNoise noise;
    noise.error_share = 0.0;
    return noise;
}

TEST(SupportPlane, IsFoundInNoiseToATenthOfAMillimeter) {
    const TableView view;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const auto fit = find_plane(noisy_image(view.exact, calibrated(), seed, 0), view.search());
        ASSERT_TRUE(fit);
        EXPECT_NEAR(fit->plane.distance(), view.height(), 1e-4);
        EXPECT_GT(glm::dot(fit->plane.normal(), view.up()), std::cos(1e-3));
        EXPECT_LT(fit->residual, 0.003);
        EXPECT_GT(fit->share, 0.9);
    }
}

TEST(SupportPlane, IsFollowedWhereTheCameraMoves) {
    const TableView view;
    const auto fit = find_plane(noisy_image(view.exact, calibrated(), 1, 0), view.search());
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

// A table of that side over a floor that lies so far below it.
DepthBuffer table_over_floor(double side, double below, const Pose& camera) {
    const std::vector<LibraryMesh> table{{"table", shared::box({0.5 * side, 0.01, 0.5 * side}), 0.0}};
    DepthBuffer exact;
    Pose over_floor = camera;
    over_floor.position.y += below;
    shared::draw_scene(
        table,
        DepthScene{kinect_camera(320, 240), over_floor, {{0, {{0.0, below - 0.01, 0.0}, {1, 0, 0, 0}}}}},
        exact);
    return exact;
}

TEST(SupportPlane, ASmallTableIsFoundBesideTheFloor) {
    const TableView view;
    for (const double side : {0.25, 0.4, 0.6}) {
        for (const double below : {0.1, 0.3, 0.5}) {
            const DepthImage image =
                noisy_image(table_over_floor(side, below, view.camera), calibrated(), 1, 0);
            const auto found = find_planes(image, {}, view.search(), 3);
            ASSERT_GE(found.size(), 2u) << side << " m, " << below << " m above the floor";
            const double nearest = std::min(found[0].plane.distance(), found[1].plane.distance());
            const double farthest = std::max(found[0].plane.distance(), found[1].plane.distance());
            EXPECT_NEAR(nearest, view.height(), 1e-3);
            EXPECT_NEAR(farthest, view.height() + below, 3e-3);
        }
    }
}

TEST(SupportPlane, OneThatIsKnownIsFoundWhateverElseIsSeenMoreOf) {
    const TableView view;
    for (const double error : {-0.01, 0.0, 0.02}) {
        DepthNoise noise = calibrated();
        noise.error_share = error;
        for (const double below : {0.1, 0.3, 0.5}) {
            const DepthImage image = noisy_image(table_over_floor(0.25, below, view.camera), noise, 2, 0);
            const auto found = find_known_plane(image, {}, ImagePlane{-view.up() / view.height()});
            ASSERT_TRUE(found) << error << ", " << below;
            EXPECT_NEAR(found->plane.distance(), (1.0 + error) * view.height(), 1e-3);
        }
    }
    // A camera that is turned by two degrees more than is known.
    const Quat off = glm::angleAxis(0.035, Vec3(1.0, 0.0, 0.0));
    const auto leaning = find_known_plane(noisy_image(view.exact, calibrated(), 3, 0), {},
                                          ImagePlane{-(off * view.up()) / view.height()});
    ASSERT_TRUE(leaning);
    EXPECT_NEAR(leaning->plane.distance(), view.height(), 1e-3);
    EXPECT_GT(leaning->share, 0.9);
    const DepthImage floor = noisy_image(view.exact, calibrated(), 2, 0);
    EXPECT_FALSE(find_known_plane(floor, {}, ImagePlane{-view.up() / (view.height() - 0.1)}));
}

TEST(SupportPlane, AWallIsNone) {
    const TableView view;
    PlaneSearch search = view.search();
    search.up = Vec3(0.0, 0.0, 1.0);  // as if the camera looked at a wall
    const Vec3 level = view.up();
    ASSERT_LT(glm::dot(level, search.up), std::cos(search.max_tilt));
    EXPECT_FALSE(find_plane(noisy_image(view.exact, calibrated(), 1, 0), search));
}

TEST(SupportPlane, NoDepthHasNone) {
    const TableView view;
    const DepthCamera camera = kinect_camera(320, 240);
    DepthImage empty{camera, std::vector<std::uint16_t>(pixel_count(camera)), 0};
    EXPECT_FALSE(find_plane(empty, view.search()));
    EXPECT_FALSE(follow_plane(empty, {}, ImagePlane{}, 0.08));
    empty.depth_mm[5000] = 900;  // one pixel is no plane either
    EXPECT_FALSE(find_plane(empty, view.search()));
}

}  // namespace
}  // namespace tactus::support_plane_test
