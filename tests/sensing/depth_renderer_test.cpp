#include "sensing/image/depth_renderer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "shared/meshes.hpp"
#include "shared/random_values.hpp"

namespace tactus::depth_renderer_test {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

// Depth of the first triangle that the ray of a pixel meets: every one is asked (Moeller, Trumbore).
double slow_depth(const PosedMesh& posed, const Vec3& ray) {
    double nearest = never;
    for (const auto& [i, j, k] : posed.mesh->triangles) {
        const Vec3 a = to_parent(posed.pose, posed.mesh->vertices[i]);
        const Vec3 ab = to_parent(posed.pose, posed.mesh->vertices[j]) - a;
        const Vec3 ac = to_parent(posed.pose, posed.mesh->vertices[k]) - a;
        const Vec3 p = glm::cross(ray, ac);
        const double determinant = glm::dot(ab, p);
        const double u = glm::dot(-a, p) / determinant;
        const Vec3 q = glm::cross(-a, ab);
        const double v = glm::dot(ray, q) / determinant;
        const double depth = glm::dot(ac, q) / determinant;
        if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && depth > 0.0) {
            nearest = std::min(nearest, depth);
        }
    }
    return nearest;
}

Pose in_front(double depth, const Quat& rotation = {1.0, 0.0, 0.0, 0.0}) {
    return {{0.0, 0.0, -depth}, rotation};
}

TEST(DepthRenderer, EveryPixelHasTheDepthOfItsRay) {
    const DepthCamera camera = kinect_camera(80, 60);
    const TriangleMesh mesh = shared::icosphere(2, 0.2);
    shared::RandomValues random(11);
    DepthRenderer renderer;
    DepthBuffer buffer;
    int seen = 0;
    for (int turn = 0; turn < 5; ++turn) {
        const PosedMesh posed{&mesh, {random.in_box(0.2) + Vec3(0.0, 0.0, -0.8), random.rotation()}};
        renderer.render(camera, {&posed, 1}, buffer);
        for (int v = 0; v < camera.height; ++v) {
            for (int u = 0; u < camera.width; ++u) {
                const double expected = slow_depth(posed, ray_through(camera, u, v));
                const float drawn = buffer.depth[static_cast<std::size_t>(v * camera.width + u)];
                if (std::isfinite(expected)) {
                    ASSERT_NEAR(drawn, expected, 1e-6) << u << ", " << v;
                    ++seen;
                } else {
                    ASSERT_EQ(drawn, std::numeric_limits<float>::infinity()) << u << ", " << v;
                }
            }
        }
    }
    EXPECT_GT(seen, 1000);
}

TEST(DepthRenderer, TheNearerMeshIsSeenWhateverTheOrder) {
    const TriangleMesh mesh = shared::box(Vec3(0.1));
    const PosedMesh near{&mesh, in_front(0.8)};
    const PosedMesh far{&mesh, in_front(1.5)};
    DepthRenderer renderer;
    DepthBuffer buffer;
    const DepthCamera camera = kinect_camera(64, 48);
    const std::size_t middle = 24 * 64 + 32;
    renderer.render(camera, std::array{near, far}, buffer);
    EXPECT_EQ(buffer.seen[middle], 0);
    EXPECT_NEAR(buffer.depth[middle], 0.7, 1e-6);
    renderer.render(camera, std::array{far, near}, buffer);
    EXPECT_EQ(buffer.seen[middle], 1);
    EXPECT_NEAR(buffer.depth[middle], 0.7, 1e-6);
    EXPECT_EQ(buffer.seen[0], DepthBuffer::no_mesh);
}

TEST(DepthRenderer, TurnedInsideOutAMeshLooksTheSame) {
    TriangleMesh mesh = shared::icosphere(2, 0.1);
    const PosedMesh posed{&mesh, in_front(0.6)};
    DepthRenderer renderer;
    DepthBuffer outside, inside;
    renderer.render(kinect_camera(64, 48), {&posed, 1}, outside);
    for (auto& triangle : mesh.triangles) {
        std::swap(triangle[1], triangle[2]);
    }
    renderer.render(kinect_camera(64, 48), {&posed, 1}, inside);
    EXPECT_EQ(outside.seen, inside.seen);
    for (std::size_t i = 0; i < outside.depth.size(); ++i) {
        EXPECT_TRUE(outside.depth[i] == inside.depth[i] ||
                    std::abs(outside.depth[i] - inside.depth[i]) < 1e-6f);
    }
}

// A ground that begins behind the camera fills the image up to the horizon, and no farther.
TEST(DepthRenderer, WhatReachesBehindTheCameraIsCut) {
    TriangleMesh ground;
    ground.vertices = {{-1e4, -0.5, 1e4}, {1e4, -0.5, 1e4}, {1e4, -0.5, -1e4}, {-1e4, -0.5, -1e4}};
    ground.triangles = {{0, 1, 2}, {0, 2, 3}};
    const PosedMesh posed{&ground, {}};
    const DepthCamera camera = kinect_camera(64, 48);
    DepthRenderer renderer;
    DepthBuffer buffer;
    renderer.render(camera, {&posed, 1}, buffer);
    for (int v = 0; v < camera.height; ++v) {
        for (int u = 0; u < camera.width; ++u) {
            const float drawn = buffer.depth[static_cast<std::size_t>(v * camera.width + u)];
            const double below = -ray_through(camera, u, v).y;
            if (below > 1e-6) {
                ASSERT_NEAR(drawn, 0.5 / below, 1e-5 * drawn);
            } else {
                ASSERT_FALSE(std::isfinite(drawn));
            }
        }
    }
}

TEST(DepthRenderer, WhatIsBehindTheCameraIsNotSeen) {
    const TriangleMesh mesh = shared::box(Vec3(0.1));
    const PosedMesh posed{&mesh, in_front(-1.0)};
    DepthBuffer buffer;
    buffer.clear(kinect_camera(32, 24));
    EXPECT_TRUE(DepthRenderer().draw(posed, 0, buffer).is_empty());
    EXPECT_FALSE(std::ranges::any_of(buffer.depth, [](float depth) { return std::isfinite(depth); }));
}

TEST(DepthRenderer, TheBoxHoldsAllThatWasDrawn) {
    const TriangleMesh mesh = shared::icosphere(3, 0.1);
    const DepthCamera camera = kinect_camera(128, 96);
    shared::RandomValues random(5);
    DepthRenderer renderer;
    DepthBuffer buffer;
    for (int turn = 0; turn < 20; ++turn) {
        buffer.clear(camera);
        const PosedMesh posed{&mesh, {random.in_box(0.4) + Vec3(0.0, 0.0, -0.9), random.rotation()}};
        const PixelBox box = renderer.draw(posed, 3, buffer);
        for (int v = 0; v < camera.height; ++v) {
            for (int u = 0; u < camera.width; ++u) {
                const bool inside = u >= box.left && u < box.right && v >= box.top && v < box.bottom;
                const bool drawn = buffer.seen[static_cast<std::size_t>(v * camera.width + u)] == 3;
                ASSERT_TRUE(inside || !drawn);
            }
        }
    }
}

TEST(DepthRenderer, TrianglesWithoutAreaAreNotSeen) {
    TriangleMesh mesh;
    mesh.vertices = {{-0.1, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}};
    mesh.triangles = {{0, 1, 2}, {0, 0, 1}, {1, 1, 1}};
    const PosedMesh posed{&mesh, in_front(0.5)};
    DepthBuffer buffer;
    DepthRenderer().render(kinect_camera(32, 24), {&posed, 1}, buffer);
    for (const float depth : buffer.depth) {
        EXPECT_FALSE(std::isfinite(depth));
    }
}

}  // namespace
}  // namespace tactus::depth_renderer_test
