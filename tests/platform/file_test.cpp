#include "platform/file.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace tactus::file_test {
namespace {

TEST(File, IsFoundByItsNameInUtf8) {
    const std::string folder = ::testing::TempDir() + "tactus_\xc3\x9f/\xe8\xa7\xa6";
    make_folder_of(folder + "/a.csv");
    const std::filesystem::path expected(std::u8string(folder.begin(), folder.end()));
    EXPECT_TRUE(std::filesystem::is_directory(expected));
    std::FILE* const file = open_file(folder + "/a.csv", "wb");
    ASSERT_NE(file, nullptr);
    std::fclose(file);
    EXPECT_TRUE(std::filesystem::exists(expected / "a.csv"));
    std::filesystem::remove_all(expected.parent_path());
}

TEST(File, InAFolderThatCannotBeMadeIsNone) {
    const std::string taken = ::testing::TempDir() + "tactus_taken";
    std::FILE* const file = open_file(taken, "wb");
    ASSERT_NE(file, nullptr);
    std::fclose(file);
    make_folder_of(taken + "/below/a.csv");
    EXPECT_EQ(open_file(taken + "/below/a.csv", "wb"), nullptr);
    std::filesystem::remove(taken);
}

}  // namespace
}  // namespace tactus::file_test
