// The files of a recording, and what it says of those that cannot be written.
#include "world/recording.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::recording_test {
namespace {

// The messages of a recording are longer than what a string holds in itself.
class Recordings : public testing::Test {
protected:
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::unique_ptr<Recording> open(const std::string& csv, const std::string& trace) {
        return Recording::open({csv, trace, 1.0}, [this](const std::string& what) { said.push_back(what); });
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::vector<std::string> said;

private:
    std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / "recordings";
};

TEST_F(Recordings, OneWithoutOneOfItsFilesKeepsItsProblem) {
    const auto first = open(path("rows.csv"), "");
    ASSERT_TRUE(first);
    EXPECT_EQ(first->problem(), "");
    const auto second = open(path("rows.csv"), path("trace.json"));
    ASSERT_TRUE(second) << "its trace can be written";
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("is being written by another recording"), std::string::npos);
    EXPECT_EQ(second->problem(), said[0]);
}

TEST_F(Recordings, OneWithoutFilesIsNone) {
    const auto first = open(path("rows.csv"), "");
    EXPECT_FALSE(open(path("rows.csv"), ""));
    EXPECT_FALSE(open(path(""), ""));
    ASSERT_EQ(said.size(), 2u);
    EXPECT_NE(said[0].find("is being written by another recording"), std::string::npos);
    EXPECT_NE(said[1].find("cannot be written"), std::string::npos);
    EXPECT_TRUE(open(path("other.csv"), "")) << "what was refused holds no path";
}

}  // namespace
}  // namespace tactus::recording_test
