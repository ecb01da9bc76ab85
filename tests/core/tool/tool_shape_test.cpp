#include "core/tool/tool_shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "core/tool/tool_proxy.hpp"
#include "shared/meshes.hpp"
#include "shared/slow_distance.hpp"
#include "shared/tool_figures.hpp"

namespace tactus::tool_shape_test {
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

// How many groups of spheres there are that hang together.
std::size_t groups(std::span<const ToolSphere> spheres, std::span<const ToolBridge> bridges) {
    std::vector<std::size_t> group(spheres.size());
    std::iota(group.begin(), group.end(), std::size_t{0});
    const auto link = [&](std::size_t a, std::size_t b) {
        std::ranges::replace(group, std::size_t{group[a]}, std::size_t{group[b]});
    };
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            const ToolSphere &a = spheres[i], &b = spheres[k];
            if (glm::distance(a.center, b.center) <= a.radius + b.radius) {
                link(i, k);
            }
        }
    }
    for (const ToolBridge& bridge : bridges) {
        link(bridge.first, bridge.second);
    }
    std::ranges::sort(group);
    return static_cast<std::size_t>(std::ranges::unique(group).begin() - group.begin());
}

TEST(ToolShape, BridgesLinkAllSpheresAndNoneIsOneTooMany) {
    for (const double tolerance : {2e-4, 1e-3, 4e-3}) {
        for (const TriangleMesh& mesh : {shared::box({0.01, 0.015, 0.025}),
                                         shared::peg_mesh(0.01, 0.02, 60, 10), shared::icosphere(3, 0.05)}) {
            const ToolShapeResult made = make_tool_shape(mesh, {tolerance, 1'000});
            ASSERT_TRUE(made.shape) << made.error;
            const std::vector<ToolBridge> bridges = bridges_between(made.shape->spheres);
            EXPECT_EQ(groups(made.shape->spheres, bridges), 1u);
            EXPECT_EQ(groups(made.shape->spheres, {}), bridges.size() + 1);
        }
    }
    EXPECT_TRUE(bridges_between({}).empty());
}

// The farthest that any point of the surface lies outside of all spheres, on a grid of each triangle.
double measured_error(const TriangleMesh& mesh, const ToolShape& shape) {
    constexpr int steps = 24;
    double most = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        for (int i = 0; i <= steps; ++i) {
            for (int k = 0; k <= steps - i; ++k) {
                const double u = static_cast<double>(i) / steps, v = static_cast<double>(k) / steps;
                const Vec3 point =
                    u * mesh.vertices[a] + v * mesh.vertices[b] + (1.0 - u - v) * mesh.vertices[c];
                double least = 1e9;
                for (const ToolSphere& sphere : shape.spheres) {
                    least = std::min(least, glm::distance(point, sphere.center) - sphere.radius);
                }
                most = std::max(most, least);
            }
        }
    }
    return most;
}

double farthest_beyond(const TriangleMesh& mesh, const ToolShape& shape) {
    Vec3 low(1e9), high(-1e9);
    for (const Vec3& vertex : mesh.vertices) {
        low = glm::min(low, vertex);
        high = glm::max(high, vertex);
    }
    double most = -1e9;
    for (const ToolSphere& sphere : shape.spheres) {
        const Vec3 above = sphere.center + sphere.radius - high, below = low - sphere.center + sphere.radius;
        most = std::max({most, above.x, above.y, above.z, below.x, below.y, below.z});
    }
    return most;
}

// A ball about the origin with a ball of air in it.
TriangleMesh shell(double outer, double inner) {
    TriangleMesh mesh = shared::icosphere(3, outer);
    const TriangleMesh hollow = shared::icosphere(3, inner);
    const auto before = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), hollow.vertices.begin(), hollow.vertices.end());
    for (const auto& [a, b, c] : hollow.triangles) {
        mesh.triangles.push_back({before + a, before + c, before + b});
    }
    return mesh;
}

// Of thin solids the ball that is looked for may have its center beyond the far side, where it meets nothing.
TEST(ToolShape, CitizenSheetsShellsAndNeedlesAreNoLargerThanTheyLook) {
    const std::pair<TriangleMesh, ToolShapeSettings> cases[] = {
        {shared::box({0.05, 0.00075, 0.05}), {5e-3, 500}},
        {shared::box({0.15, 0.001, 0.15}), {5e-3, 500}},
        {shared::box({0.015, 0.00025, 0.075}), {5e-3, 500}},
        {shared::box({0.05, 0.00075, 0.05}), {1e-3, 4000}},
        {shared::box({0.0002, 0.0002, 0.06}), {5e-3, 500}},
        {shared::peg_mesh(0.0005, 0.1, 12, 1), {5e-3, 500}},
        {shell(0.05, 0.0495), {5e-3, 500}},
    };
    for (const auto& [mesh, settings] : cases) {
        const ToolShapeResult made = make_tool_shape(mesh, settings);
        ASSERT_TRUE(made.shape) << made.error;
        EXPECT_LE(farthest_beyond(mesh, *made.shape), 1e-9) << settings.tolerance;
        expect_true(mesh, *made.shape);
        const double measured = measured_error(mesh, *made.shape);
        EXPECT_LE(measured, made.shape->tolerance + 1e-9);
        // Measured at some points of each triangle, told for all of it.
        EXPECT_GE(measured, 0.3 * made.shape->tolerance) << "the error that is told is not the one there is";
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
}  // namespace tactus::tool_shape_test
