#include "core/geometry/touch_shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "shared/meshes.hpp"

namespace tactus::touch_shape_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string error_of(const Shape& shape, const Pose& pose = {}) {
    const PlacedShape placed{shape, pose};
    const TouchShapeResult result = make_touch_shape({&placed, 1});
    EXPECT_EQ(result.shape == nullptr, !result.error.empty());
    return result.error;
}

TEST(TouchShape, EverySoundShapeIsAccepted) {
    const auto sphere = std::make_shared<const TriangleMesh>(shared::icosphere(1, 1.0));
    const auto heights = std::make_shared<const std::vector<float>>(std::vector<float>{0, 1, 2, 3, 4, 5});
    for (const Shape& shape : {Shape(SphereShape{}), Shape(BoxShape{}), Shape(CapsuleShape{}),
                               Shape(CylinderShape{}), Shape(PlaneShape{}), Shape(ConvexHullShape{sphere}),
                               Shape(MeshShape{sphere}), Shape(HeightFieldShape{3, 2, Vec3(1.0), heights})}) {
        EXPECT_EQ(error_of(shape), "");
    }
}

TEST(TouchShape, ABodyWithoutAShapeIsToldToGetOne) {
    const TouchShapeResult result = make_touch_shape({});
    EXPECT_EQ(result.shape, nullptr);
    EXPECT_NE(result.error.find("add a CollisionShape3D"), std::string::npos) << result.error;
}

TEST(TouchShape, RefusesSizesThatAreNoLengths) {
    for (const double bad : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
        EXPECT_NE(error_of(SphereShape{bad}).find("above 0"), std::string::npos);
        EXPECT_NE(error_of(BoxShape{Vec3(1.0, bad, 1.0)}).find("above 0"), std::string::npos);
        EXPECT_NE(error_of(CapsuleShape{bad, 0.5}).find("above 0"), std::string::npos);
        EXPECT_NE(error_of(CylinderShape{0.5, bad}).find("above 0"), std::string::npos);
    }
    EXPECT_NE(error_of(CapsuleShape{0.5, -0.1}), "");
    EXPECT_EQ(error_of(CapsuleShape{0.5, 0.0}), "");
}

TEST(TouchShape, RefusesAPlaneWithoutADirection) {
    EXPECT_NE(error_of(PlaneShape{Vec3(0.0), 0.0}), "");
    EXPECT_NE(error_of(PlaneShape{Vec3(nan, 0.0, 0.0), 0.0}), "");
    EXPECT_NE(error_of(PlaneShape{Vec3(0.0, 1.0, 0.0), nan}), "");
}

TEST(TouchShape, RefusesAMissingMesh) {
    EXPECT_NE(error_of(MeshShape{}).find("no mesh"), std::string::npos);
    EXPECT_NE(error_of(ConvexHullShape{}), "");
}

TEST(TouchShape, RefusesAMeshWithABadVertexByItsNumber) {
    TriangleMesh mesh = shared::box(Vec3(1.0));
    mesh.vertices[5].y = nan;
    EXPECT_NE(error_of(MeshShape{std::make_shared<const TriangleMesh>(mesh)}).find("vertex 5"),
              std::string::npos);
}

TEST(TouchShape, RefusesAHeightFieldOfTheWrongSizeOrTooHigh) {
    const auto heights = std::make_shared<const std::vector<float>>(std::vector<float>{0, 1, 2, 3});
    EXPECT_EQ(error_of(HeightFieldShape{2, 2, Vec3(1.0), heights}), "");
    EXPECT_NE(error_of(HeightFieldShape{3, 2, Vec3(1.0), heights}), "");
    EXPECT_NE(error_of(HeightFieldShape{1, 4, Vec3(1.0), heights}), "");
    EXPECT_NE(error_of(HeightFieldShape{2, 2, Vec3(1.0), nullptr}), "");
    const auto bad = std::make_shared<const std::vector<float>>(std::vector<float>{0, 2e9f, 2, 3});
    EXPECT_NE(error_of(HeightFieldShape{2, 2, Vec3(1.0), bad}).find("beyond 1e9"), std::string::npos);
}

// As HeightMapShape3D documents it, a sample that is no number is a hole.
TEST(TouchShape, CitizenAHeightFieldHasHolesWhereItHasNoHeight) {
    using Limits = std::numeric_limits<float>;
    for (const float hole :
         {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(), Limits::max(), Limits::lowest()}) {
        std::vector<float> values(25, 1.0f);
        values[12] = hole;
        const HeightFieldShape field{5, 5, Vec3(1.0), std::make_shared<const std::vector<float>>(values)};
        EXPECT_EQ(error_of(field), "");
        const TriangleMesh mesh = height_field_mesh(field);
        EXPECT_EQ(mesh.triangles.size(), 32u - 6u) << hole;
        for (const auto& triangle : mesh.triangles) {
            EXPECT_EQ(std::ranges::count(triangle, 12u), 0);
        }
        const HeightFieldShape none{
            2, 2, Vec3(1.0),
            std::make_shared<const std::vector<float>>(std::vector<float>{0, hole, hole, 1})};
        EXPECT_NE(error_of(none).find("nothing but holes"), std::string::npos);
    }
}

TEST(TouchShape, AMirroredHeightFieldIsTheMirrorImageWithItsFrontUp) {
    const auto heights = std::make_shared<const std::vector<float>>(std::vector<float>{0, 1, 2, 4, 8, 16});
    const TriangleMesh plain = height_field_mesh({3, 2, Vec3(0.5, 1.0, 2.0), heights});
    const TriangleMesh mirrored = height_field_mesh({3, 2, Vec3(-0.5, 1.0, 2.0), heights});
    ASSERT_EQ(plain.triangles.size(), mirrored.triangles.size());
    for (std::size_t i = 0; i < plain.vertices.size(); ++i) {
        EXPECT_EQ(mirrored.vertices[i], plain.vertices[i] * Vec3(-1.0, 1.0, 1.0));
    }
    for (const auto& [a, b, c] : mirrored.triangles) {
        const auto& v = mirrored.vertices;
        EXPECT_GT(glm::cross(v[b] - v[a], v[c] - v[a]).y, 0.0);
    }
    EXPECT_EQ(error_of(HeightFieldShape{3, 2, Vec3(-0.5, 1.0, 2.0), heights}), "");
    EXPECT_NE(error_of(HeightFieldShape{3, 2, Vec3(0.5, 1e20, 2.0), heights}), "");
}

TEST(TouchShape, RefusesAPoseThatIsNone) {
    EXPECT_NE(error_of(SphereShape{}, {Vec3(nan, 0.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0)}), "");
    EXPECT_NE(error_of(SphereShape{}, {Vec3(0.0), Quat(2.0, 0.0, 0.0, 0.0)}), "");
}

TEST(TouchShape, HeightFieldMeshLooksUpAndStandsOverTheOrigin) {
    const auto heights = std::make_shared<const std::vector<float>>(std::vector<float>{0, 0, 1, 0, 0, 1});
    const TriangleMesh mesh = height_field_mesh({3, 2, Vec3(2.0, 3.0, 4.0), heights});
    ASSERT_EQ(mesh.vertices.size(), 6u);
    ASSERT_EQ(mesh.triangles.size(), 4u);
    EXPECT_EQ(mesh.vertices[0], Vec3(-2.0, 0.0, -2.0));
    EXPECT_EQ(mesh.vertices[5], Vec3(2.0, 3.0, 2.0));
    for (const auto& [a, b, c] : mesh.triangles) {
        EXPECT_GT(glm::cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]).y,
                  0.0);
    }
}

TEST(TouchShape, ReachIsTheFarthestPointOfAnyPart) {
    const PlacedShape parts[] = {{SphereShape{0.5}, {Vec3(1.0, 0.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0)}},
                                 {SphereShape{0.25}, {Vec3(-2.0, 0.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0)}}};
    const TouchShapeResult result = make_touch_shape(parts);
    ASSERT_TRUE(result.shape);
    EXPECT_NEAR(result.shape->reach, 2.25, 1e-12);
}

TEST(TouchShape, RefusesAHeightFieldWithASpacingThatIsNoLength) {
    const auto heights = std::make_shared<const std::vector<float>>(std::vector<float>{0, 1, 2, 3});
    EXPECT_NE(error_of(HeightFieldShape{2, 2, Vec3(nan, 1.0, 1.0), heights}), "");
    EXPECT_NE(error_of(HeightFieldShape{2, 2, Vec3(0.0, 1.0, 1.0), heights}), "");
}

}  // namespace
}  // namespace tactus::touch_shape_test
