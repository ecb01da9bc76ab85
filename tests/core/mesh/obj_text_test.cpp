#include "core/mesh/obj_text.hpp"

#include <gtest/gtest.h>

#include "support/comma_locale.hpp"

#include <clocale>

namespace tactus::obj_text_test {
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
    EXPECT_EQ(read_obj_text("v 0 0 0\nf 1 1 2\n").error, "line 2: vertex 2 does not exist: there are 1");
    EXPECT_EQ(read_obj_text("v 0 0 0\nf 1 1 4294967796\n").error,
              "line 2: vertex 4294967796 does not exist: there are 1 so far");
    EXPECT_EQ(read_obj_text("v 0 0 0\nf 1 1 0\n").error,
              "line 2: vertex 0 does not exist: there are 1 so far");
    EXPECT_EQ(read_obj_text("v 0 0 0\nf 1 1 -2\n").error,
              "line 2: vertex -2 does not exist: there are 1 so far");
    EXPECT_EQ(read_obj_text("v 0 0 0\nf 1 1 x\n").error, "line 2: 'x' does not name a vertex");
}

TEST(ObjText, CornersThatComeAgainAndAgainMakeOneFace) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf";
    for (int i = 0; i < 100; ++i) {
        text += " 1 2 3 4";
    }
    EXPECT_EQ(read_obj_text(text).mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(read_obj_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 1 2 3\n").mesh.triangles.size(), 1u);
    // Of faces that come before their vertices, too.
    EXPECT_EQ(read_obj_text("f 1 2 3 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").mesh.triangles.size(), 1u);
    // A corner that is passed twice, as at the bridge to a hole, is no repetition.
    const std::string square = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 2 0\nv 2 2 0\n";
    EXPECT_EQ(read_obj_text(square + "f 1 2 3 4 1 5 6 7 5\n").mesh.triangles.size(), 7u);
}

TEST(ObjText, RefusesAFaceOfTwoCorners) {
    EXPECT_EQ(read_obj_text("v 0 0 0\nv 1 0 0\nf 1 2\n").error,
              "line 3: a face needs at least three corners");
}

TEST(ObjText, ReadsByteOrderMarksContinuedLinesAndOldMacintoshLines) {
    for (const char* text :
         {"\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
          "v 0 \\\n0 0\nv 1 0 \\\r\n 0\nv 0 1 0\nf 1 \\\r2 \\\n 3"}) {
        const ObjResult result = read_obj_text(text);
        ASSERT_EQ(result.error, "");
        EXPECT_EQ(result.mesh.vertices.size(), 3u);
        ASSERT_EQ(result.mesh.triangles.size(), 1u);
        EXPECT_EQ(result.mesh.triangles[0], (Triangle{0, 1, 2}));
    }
    EXPECT_EQ(read_obj_text("v 0 0 \\\n0\r\nv 1 x 0\n").error, "line 3: 'x' is not a number");
}

TEST(ObjText, ReadsFacesThatComeBeforeTheirVertices) {
    const ObjResult result = read_obj_text("f 1 2 3 4\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -1 -2 -3\n");
    ASSERT_EQ(result.error, "");
    EXPECT_EQ(result.mesh.triangles, (std::vector<Triangle>{{3, 2, 1}, {0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(read_obj_text("f 1 2 3\nv 0 0 0\nv 1 0 0\n").error,
              "line 1: vertex 3 does not exist: there are 2");
}

TEST(ObjText, SaysWhereATextIsTooLarge) {
    const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n";
    ObjLimits limits;
    limits.bytes = text.size() - 1;
    EXPECT_EQ(read_obj_text(text, limits).error,
              "the text has 40 bytes, the limit is 39: split it into several meshes");
    limits = {};
    limits.vertices = 2;
    EXPECT_EQ(read_obj_text(text, limits).error, "line 3: more than 2 vertices: split the mesh into several");
    limits = {};
    limits.triangles = 1;
    EXPECT_EQ(read_obj_text(text, limits).error,
              "line 5: more than 1 triangles: split the mesh into several");
}

TEST(ObjText, AConcaveFaceThatWouldTakeTooLongIsAnError) {
    std::string text;
    for (int i = 0; i < 400; ++i) {
        text += "v " + std::to_string(i) + " " + std::to_string(i % 2) + " 0\n";
    }
    text += "v 400 -9 0\nv -1 -9 0\nf";
    for (int i = 1; i <= 402; ++i) {
        text += " " + std::to_string(i);
    }
    ObjLimits limits;
    EXPECT_EQ(read_obj_text(text, limits).error, "");
    limits.polygon_work = 10'000;
    EXPECT_NE(read_obj_text(text, limits).error.find("too long"), std::string::npos);
}

TEST(ObjText, GivesAnEmptyMeshForEmptyText) {
    const ObjResult result = read_obj_text("");
    EXPECT_EQ(result.error, "");
    EXPECT_TRUE(result.mesh.triangles.empty());
}

TEST(ObjText, CitizenReadsTheSameNumbersInALocaleWithDecimalCommas) {
    const testing::CommaLocale german;
    if (!testing::CommaLocale::is_in_force()) {
        GTEST_SKIP() << "no locale with decimal commas is here, and none can be made";
    }
    const ObjResult result = read_obj_text("v 0.25 1.5 -2.75\n");
    ASSERT_EQ(result.error, "");
    EXPECT_EQ(result.mesh.vertices[0], Vec3(0.25, 1.5, -2.75));
}

}  // namespace
}  // namespace tactus::obj_text_test
