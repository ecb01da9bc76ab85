#include "sensing/discovery/mesh_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "shared/meshes.hpp"
#include "shared/random_values.hpp"

namespace tactus::mesh_field_test {
namespace {

double box_distance(const Vec3& p, const Vec3& half) {
    const Vec3 q = glm::abs(p) - half;
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

TriangleMesh inside_out(TriangleMesh mesh) {
    for (auto& triangle : mesh.triangles) {
        std::swap(triangle[1], triangle[2]);
    }
    return mesh;
}

TEST(MeshField, TellsTheDistanceOfASphere) {
    const MeshField field = MeshField::build(shared::icosphere(4, 0.05), 0.003, 0.02);
    shared::RandomValues random(3);
    for (int i = 0; i < 2000; ++i) {
        const double r = random.between(0.03, 0.068);
        EXPECT_NEAR(field.distance(r * random.direction()), r - 0.05, 2e-4);
    }
}

TEST(MeshField, IsExactOnFlatFaces) {
    const Vec3 half(0.05, 0.03, 0.04);
    const MeshField field = MeshField::build(shared::box(half), 0.003, 0.02);
    shared::RandomValues random(5);
    for (int i = 0; i < 2000; ++i) {
        // Over the middle of the upper face, nearer to it than to its edges.
        const Vec3 p(random.between(-0.03, 0.03), random.between(0.02, 0.045), random.between(-0.02, 0.02));
        EXPECT_NEAR(field.distance(p), p.y - half.y, 1e-7);
    }
}

TEST(MeshField, IsNoFartherOffThanItsCells) {
    const Vec3 half(0.05, 0.03, 0.04);
    const MeshField field = MeshField::build(shared::box(half), 0.003, 0.02);
    shared::RandomValues random(6);
    for (int i = 0; i < 5000; ++i) {
        const Vec3 p = random.in_box(1.0) * (half + Vec3(0.018));
        EXPECT_NEAR(field.distance(p), box_distance(p, half), 0.0027);
    }
}

TEST(MeshField, WindingMakesNoDifference) {
    const TriangleMesh mesh = shared::icosphere(2, 0.04);
    const MeshField one = MeshField::build(mesh, 0.004, 0.02);
    const MeshField other = MeshField::build(inside_out(mesh), 0.004, 0.02);
    shared::RandomValues random(7);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p = random.in_ball(0.055);
        EXPECT_NEAR(one.distance(p), other.distance(p), 1e-6);
        EXPECT_EQ(one.distance(p) < -0.005, other.distance(p) < -0.005);
    }
}

// A sheet has no inside: it is as far away on either side.
TEST(MeshField, AnOpenMeshHasNoInside) {
    TriangleMesh sheet;
    sheet.vertices = {{-0.05, 0.0, -0.05}, {0.05, 0.0, -0.05}, {0.05, 0.0, 0.05}, {-0.05, 0.0, 0.05}};
    sheet.triangles = {{0, 2, 1}, {0, 3, 2}};
    const MeshField field = MeshField::build(sheet, 0.003, 0.02);
    EXPECT_NEAR(field.distance({0.0, 0.01, 0.0}), 0.01, 1e-6);
    EXPECT_NEAR(field.distance({0.0, -0.01, 0.0}), 0.01, 1e-6);
}

TEST(MeshField, FarAwayTheNearestCellAnswers) {
    const MeshField field = MeshField::build(shared::icosphere(2, 0.04), 0.004, 0.02);
    EXPECT_FALSE(field.covers({1.0, 0.0, 0.0}));
    EXPECT_TRUE(field.covers({0.05, 0.0, 0.0}));
    EXPECT_GT(field.distance({1.0, 0.0, 0.0}), 0.5);
}

}  // namespace
}  // namespace tactus::mesh_field_test
