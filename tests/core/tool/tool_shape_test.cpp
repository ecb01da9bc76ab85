#include "core/tool/tool_shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "core/tool/tool_proxy.hpp"
#include "shared/meshes.hpp"
#include "shared/slow_distance.hpp"
#include "shared/tool_figures.hpp"

namespace tactus {
namespace {

// No sphere sticks out, and no corner or middle of a triangle lies farther out than is told.
void expect_true(const TriangleMesh& mesh, const ToolShape& shape) {
    for (const ToolSphere& sphere : shape.spheres) {
        EXPECT_GE(static_cast<double>(shared::slow_distance(sphere.center, mesh)),
                  sphere.radius * (1.0 - 1e-9));
    }
    const auto outside = [&](const Vec3& point) {
        double least = 1e9;
        for (const ToolSphere& sphere : shape.spheres) {
            least = std::min(least, glm::distance(point, sphere.center) - sphere.radius);
        }
        return least;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
        EXPECT_LE(outside(mesh.vertices[a]), shape.tolerance * (1.0 + 1e-9));
        EXPECT_LE(outside((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3.0),
                  shape.tolerance * (1.0 + 1e-9));
    }
}

TEST(ToolShape, ABallIsOneSphere) {
    const ToolShapeResult made = make_tool_shape(shared::icosphere(3, 0.05), {5e-4, 100});
    ASSERT_TRUE(made.shape) << made.error;
    EXPECT_LE(made.shape->spheres.size(), 3u);
    EXPECT_LE(made.shape->tolerance, 5e-4);
    expect_true(shared::icosphere(3, 0.05), *made.shape);
}

TEST(ToolShape, ABoxAndAPegAreCoveredWithinWhatIsTold) {
    const TriangleMesh box = shared::box({0.01, 0.015, 0.025});
    const TriangleMesh peg = shared::peg_mesh(0.01, 0.02, 60, 10);
    for (const TriangleMesh* mesh : {&box, &peg}) {
        const ToolShapeResult made = make_tool_shape(*mesh, {1e-3, 1'000});
        ASSERT_TRUE(made.shape) << made.error;
        EXPECT_LE(made.shape->tolerance, 1e-3) << made.shape->spheres.size();
        expect_true(*mesh, *made.shape);
    }
}

TEST(ToolShape, WithFewSpheresTheToleranceThatIsToldIsLarger) {
    const TriangleMesh box = shared::box({0.02, 0.03, 0.05});
    const ToolShapeResult made = make_tool_shape(box, {1e-4, 60});
    ASSERT_TRUE(made.shape) << made.error;
    EXPECT_LE(made.shape->spheres.size(), 60u);
    EXPECT_GT(made.shape->tolerance, 1e-3);
    expect_true(box, *made.shape);
}

TEST(ToolShape, WhatIsNoSolidIsRefused) {
    TriangleMesh open = shared::box(Vec3(0.02));
    open.triangles.pop_back();
    EXPECT_NE(make_tool_shape(open).error.find("close it"), std::string::npos);
    TriangleMesh turned = shared::box(Vec3(0.02));
    for (auto& [a, b, c] : turned.triangles) {
        std::swap(b, c);
    }
    EXPECT_NE(make_tool_shape(turned).error.find("flip"), std::string::npos);
    TriangleMesh flat{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}}, {{0, 1, 2}, {0, 2, 1}}};
    EXPECT_NE(make_tool_shape(flat).error.find("no volume"), std::string::npos);
    EXPECT_NE(make_tool_shape(TriangleMesh{}).error, "");
    EXPECT_NE(make_tool_shape(shared::box(Vec3(0.02)), {0.0, 10}).error, "");
    EXPECT_NE(make_tool_shape(shared::box(Vec3(0.02)), {1e-3, 0}).error, "");
}

}  // namespace
}  // namespace tactus
