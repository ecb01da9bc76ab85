#include "core/geometry/obj_text.hpp"

#include <gtest/gtest.h>

#include <clocale>

namespace tactus {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

TEST(ObjText, ReadsVerticesAndTriangles) {
    const ObjResult result = read_obj_text("v 0 0 0\nv 1.5 0 0\nv 0 -2e-3 +4\nf 1 2 3\n");
    ASSERT_EQ(result.error, "");
    ASSERT_EQ(result.mesh.vertices.size(), 3u);
    EXPECT_EQ(result.mesh.vertices[1], Vec3(1.5, 0.0, 0.0));
    EXPECT_EQ(result.mesh.vertices[2], Vec3(0.0, -2e-3, 4.0));
    ASSERT_EQ(result.mesh.triangles.size(), 1u);
    EXPECT_EQ(result.mesh.triangles[0], (Triangle{0, 1, 2}));
}

TEST(ObjText, SplitsAPolygonIntoAFan) {
    const ObjResult result = read_obj_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0 0\nf 1 2 3 4 5");
    ASSERT_EQ(result.error, "");
    ASSERT_EQ(result.mesh.triangles.size(), 3u);
    EXPECT_EQ(result.mesh.triangles[0], (Triangle{0, 1, 2}));
    EXPECT_EQ(result.mesh.triangles[1], (Triangle{0, 2, 3}));
    EXPECT_EQ(result.mesh.triangles[2], (Triangle{0, 3, 4}));
}

TEST(ObjText, TakesTheVertexOfEveryKindOfCorner) {
    const ObjResult result = read_obj_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2//1 3/1\n");
    ASSERT_EQ(result.error, "");
    EXPECT_EQ(result.mesh.triangles[0], (Triangle{0, 1, 2}));
}

TEST(ObjText, CountsNegativeIndicesBackFromTheNewestVertex) {
    const ObjResult result = read_obj_text("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 5 5 5\n");
    ASSERT_EQ(result.error, "");
    EXPECT_EQ(result.mesh.triangles[0], (Triangle{1, 2, 3}));
}

TEST(ObjText, PassesOverCommentsCarriageReturnsAndWhatItDoesNotKnow) {
    const ObjResult result = read_obj_text(
        "# a comment\r\nmtllib x.mtl\r\no thing\r\nv\t0  0 0 # origin\r\nv 1 0 0 1.0\r\nv 0 1 0\r\ns "
        "off\r\nf 1 2 3\r\nl 1 2\r\n");
    ASSERT_EQ(result.error, "");
    EXPECT_EQ(result.mesh.vertices.size(), 3u);
    EXPECT_EQ(result.mesh.triangles.size(), 1u);
}

TEST(ObjText, NamesTheLineOfAWordThatIsNoNumber) {
    EXPECT_EQ(read_obj_text("v 0 0 0\nv 1 zwei 3\n").error, "line 2: 'zwei' is not a number");
    EXPECT_EQ(read_obj_text("v 1 2\n").error, "line 1: a vertex needs three numbers");
    EXPECT_EQ(read_obj_text("v 1 2,5 3\n").error, "line 1: '2,5' is not a number");
}

TEST(ObjText, NamesTheLineOfAVertexThatDoesNotExist) {
    EXPECT_EQ(read_obj_text("v 0 0 0\nf 1 1 2\n").error,
              "line 2: vertex 2 does not exist: there are 1 so far");
    EXPECT_EQ(read_obj_text("v 0 0 0\nf 1 1 0\n").error,
              "line 2: vertex 0 does not exist: there are 1 so far");
    EXPECT_EQ(read_obj_text("v 0 0 0\nf 1 1 -2\n").error,
              "line 2: vertex -2 does not exist: there are 1 so far");
    EXPECT_EQ(read_obj_text("v 0 0 0\nf 1 1 x\n").error, "line 2: 'x' does not name a vertex");
}

TEST(ObjText, RefusesAFaceOfTwoCorners) {
    EXPECT_EQ(read_obj_text("v 0 0 0\nv 1 0 0\nf 1 2\n").error,
              "line 3: a face needs at least three corners");
}

TEST(ObjText, GivesAnEmptyMeshForEmptyText) {
    const ObjResult result = read_obj_text("");
    EXPECT_EQ(result.error, "");
    EXPECT_TRUE(result.mesh.triangles.empty());
}

TEST(ObjText, ReadsTheSameNumbersInALocaleWithDecimalCommas) {
    const std::string before = std::setlocale(LC_NUMERIC, nullptr);
    std::setlocale(LC_NUMERIC, "de_DE.UTF-8");
    const ObjResult result = read_obj_text("v 0.25 1.5 -2.75\n");
    std::setlocale(LC_NUMERIC, before.c_str());
    ASSERT_EQ(result.error, "");
    EXPECT_EQ(result.mesh.vertices[0], Vec3(0.25, 1.5, -2.75));
}

}  // namespace
}  // namespace tactus
