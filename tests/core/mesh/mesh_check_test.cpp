#include "core/mesh/mesh_check.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "shared/meshes.hpp"

namespace tactus::mesh_check_test {
namespace {

TriangleMesh one_triangle() {
    return {{Vec3(0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0)}, {{0, 1, 2}}};
}

// What is wrong, and what to do: both halves of the sentence.
void expect_refused(const TriangleMesh& mesh, const char* what) {
    const std::string error = check_mesh(mesh);
    EXPECT_NE(error.find(what), std::string::npos) << error;
    EXPECT_TRUE(error.find(':') != std::string::npos || error.find(';') != std::string::npos) << error;
}

TEST(MeshCheck, ASoundMeshHasNothingToSay) {
    EXPECT_EQ(check_mesh(one_triangle()), "");
    EXPECT_EQ(check_mesh(shared::icosphere(2, 1.0)), "");
}

TEST(MeshCheck, RefusesAMeshWithoutTriangles) {
    expect_refused({}, "no triangles");
    expect_refused({one_triangle().vertices, {}}, "no triangles");
}

TEST(MeshCheck, RefusesACoordinateThatIsNoNumber) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e10}) {
        TriangleMesh mesh = one_triangle();
        mesh.vertices[1].z = bad;
        expect_refused(mesh, "vertex 1");
    }
}

TEST(MeshCheck, RefusesACornerThatDoesNotExist) {
    TriangleMesh mesh = one_triangle();
    mesh.triangles.push_back({0, 1, 3});
    expect_refused(mesh, "triangle 1");
}

TEST(MeshCheck, RefusesAMeshWithoutAnyArea) {
    TriangleMesh mesh = one_triangle();
    mesh.vertices[2] = mesh.vertices[1];
    expect_refused(mesh, "area");
}

TEST(MeshCheck, RefusesAMeshTooSmallForNumbers) {
    for (const double scale : {1e-10, 1e-100, 1e-310}) {
        TriangleMesh mesh = shared::icosphere(1, 1.0);
        for (Vec3& v : mesh.vertices) {
            v *= scale;
        }
        expect_refused(mesh, "smaller than");
    }
    EXPECT_EQ(check_mesh(shared::icosphere(1, 1e-8)), "");
}

TEST(MeshCheck, RefusesAMeshScaledOutOfReach) {
    expect_refused(shared::icosphere(1, 1e20), "vertex 0");
    EXPECT_EQ(check_mesh(shared::icosphere(1, -1.0)), "");
}

TEST(MeshCheck, AcceptsSingleTrianglesWithoutArea) {
    TriangleMesh mesh = one_triangle();
    mesh.triangles.push_back({1, 1, 2});
    EXPECT_EQ(check_mesh(mesh), "");
}

}  // namespace
}  // namespace tactus::mesh_check_test
