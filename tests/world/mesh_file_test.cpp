#include "world/mesh_file.hpp"

#include <gtest/gtest.h>

namespace tactus::mesh_file_test {
namespace {

TEST(MeshFile, ANameIsNoWayOutOfTheFolder) {
    EXPECT_TRUE(is_mesh_name("cube"));
    EXPECT_TRUE(is_mesh_name("..cube.."));
    for (const char* const way : {"", "../cube", "a/b", "a\\b", "C:cube"}) {
        EXPECT_FALSE(is_mesh_name(way)) << way;
    }
}

TEST(MeshFile, ATooLargeFileIsNotRead) {
    EXPECT_EQ(problem_of_size("a.obj", std::int64_t{1} << 30), "");
    EXPECT_EQ(problem_of_size("a.obj", (std::int64_t{1} << 30) + 1),
              "a.obj: the file has 1073741825 bytes, the limit is 1073741824: split it into several meshes");
}

TEST(MeshFile, ReadsWhatItHoldsOrNamesTheFile) {
    const auto read = read_mesh_file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    ASSERT_NE(read.mesh, nullptr) << read.error;
    EXPECT_EQ(read.mesh->triangles.size(), 1u);
    EXPECT_EQ(read.error, "");
    for (const char* const wrong : {"", "v 0 0 0\nf 1 2 3\n", "f x\n"}) {
        const auto refused = read_mesh_file("a.obj", wrong);
        EXPECT_EQ(refused.mesh, nullptr);
        EXPECT_EQ(refused.error.rfind("a.obj: ", 0), 0u) << refused.error;
    }
}

}  // namespace
}  // namespace tactus::mesh_file_test
