#include "core/mesh/obj_file.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace tactus::obj_file_test {
namespace {

using namespace std::string_literals;

const std::string triangle = "# a thing\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

std::string said(const std::string& bytes) {
    return read_obj_file(bytes).error;
}

// Each unit in two bytes, with its mark.
std::string utf16(const std::u16string& text, bool is_little) {
    std::string bytes = is_little ? "\xFF\xFE"s : "\xFE\xFF"s;
    for (const char16_t unit : text) {
        const auto low = static_cast<char>(unit & 0xffu), high = static_cast<char>(unit >> 8u);
        bytes += is_little ? std::string{low, high} : std::string{high, low};
    }
    return bytes;
}

TEST(ObjFile, IsReadAsItsText) {
    const ObjResult result = read_obj_file(triangle);
    EXPECT_EQ(result.error, "");
    EXPECT_EQ(result.mesh.triangles.size(), 1u);
    EXPECT_EQ(read_obj_file("\xEF\xBB\xBF" + triangle).mesh.triangles.size(), 1u);
    EXPECT_EQ(said("v 0 0 0\nv 1 zwei 3\n"), "line 2: 'zwei' is not a number");
}

TEST(ObjFile, Utf16IsRead) {
    for (const bool is_little : {true, false}) {
        const ObjResult result = read_obj_file(utf16(
            u"# gr\u00fcn \u4e2d \U0001F600\r\nv 0 0 0\r\nv 1 0 0\r\nv 0 1.5 0\r\nf 1 2 3\r\n", is_little));
        ASSERT_EQ(result.error, "");
        ASSERT_EQ(result.mesh.vertices.size(), 3u);
        EXPECT_EQ(result.mesh.vertices[2].y, 1.5);
        EXPECT_EQ(result.mesh.triangles.size(), 1u);
    }
    EXPECT_EQ(as_utf8(utf16(u"a\u00fc\u4e2d\U0001F600", true)), "a\xC3\xBC\xE4\xB8\xAD\xF0\x9F\x98\x80");
    EXPECT_EQ(as_utf8("\xFF\xFE\x00\xD8"s), " ") << "half a pair is no character";
    EXPECT_EQ(as_utf8("\xFF\xFE\x41"s), "") << "half a unit is none";
    EXPECT_EQ(said(utf16(u"v 1 x 2\n", true)), "line 1: 'x' is not a number");
}

TEST(ObjFile, WhatIsNoneSaysWhatItIs) {
    const auto speaks_of = [](const std::string& bytes, const std::string& word) {
        const std::string error = said(bytes);
        EXPECT_NE(error.find(word), std::string::npos) << error;
        EXPECT_TRUE(read_obj_file(bytes).mesh.triangles.empty());
    };
    speaks_of("", "it is empty");
    speaks_of(" \r\n\t\n", "it is empty");
    speaks_of("\xFF\xFE\0\0v\0\0\0"s, "UTF-32");
    speaks_of("\0\0\xFE\xFF\0\0\0v"s, "UTF-32");
    speaks_of("\x1F\x8B\x08\0 and so on"s, "gzip");
    speaks_of("PK\x03\x04", "ZIP");
    speaks_of("version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 12\n", "Git LFS");
    speaks_of("\n <!DOCTYPE HTML>\n<html></html>", "web page");
    speaks_of("<html>v 0 0 0</html>", "web page");
    speaks_of("solid part\n  facet normal 0 0 1\n outer loop\nvertex 0 0 0\n", "STL");
    speaks_of(std::string(80, ' ') + "\x02\0\0\0"s + std::string(100, '\x01'), "STL");
    speaks_of("ply\nformat ascii 1.0\n", "PLY");
    speaks_of("glTF\x02\0\0\0"s, "glTF");
    speaks_of(
        "\x7f"
        "ELF\x02\x01\0\0"s,
        "no text");
}

TEST(ObjFile, TheFirstLineThatIsNotUnderstoodIsNamed) {
    EXPECT_EQ(said("# points\n\n0.5 1 2\n3 4 5\n"),
              "line 3: '0.5 1 2' is not understood: an OBJ file has lines 'v x y z' and 'f 1 2 3'");
    EXPECT_NE(said("{\"mesh\": 1}\n").find("line 1: '{\"mesh\": 1}'"), std::string::npos);
    EXPECT_LT(said(std::string(100'000, 'x')).size(), 200u);
    EXPECT_EQ(said("v 0 0 0\nv 1 0 0\nvn 0 0 1\n"), "") << "it only has no triangles";
    // Between what is understood, other lines are passed over.
    EXPECT_EQ(said("strange 1\n" + triangle), "");
}

TEST(ObjFile, LimitsHoldBeforeAnythingIsConverted) {
    ObjLimits limits;
    limits.bytes = 10;
    EXPECT_NE(read_obj_file(utf16(u"v 0 0 0\nv 1 0 0\n", true), limits).error.find("the limit is 10"),
              std::string::npos);
}

}  // namespace
}  // namespace tactus::obj_file_test
