// Files of recordings: one writer each, and what is said where the disk takes no more.
#include "world/written_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "world/input_player.hpp"
#include "world/input_recording.hpp"
#include "world/recording.hpp"

namespace tactus::written_file_test {
namespace {

// Takes everything and has room for nothing (Linux).
constexpr const char* full = "/dev/full";

class WrittenFiles : public testing::Test {
protected:
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::unique_ptr<InputRecording> record_inputs(const std::string& to) {
        return InputRecording::open(to, {}, [this](const std::string& what) { said.push_back(what); });
    }
    std::unique_ptr<Recording> record(const std::string& csv, const std::string& trace = "") {
        return Recording::open({csv, trace, 1.0}, [this](const std::string& what) { said.push_back(what); });
    }
    bool has_said(const std::string& words) const {
        return said.size() == 1 && said[0].find(words) != std::string::npos;
    }
    std::string content(const std::string& of) const {
        std::ostringstream text;
        text << std::ifstream(of, std::ios::binary).rdbuf();
        return text.str();
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::vector<std::string> said;

private:
    std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / "written_files";
};

TEST_F(WrittenFiles, TwoWorldsDoNotRecordTheirInputsIntoOne) {
    const auto first = record_inputs(path("inputs.tactus"));
    ASSERT_TRUE(first);
    EXPECT_FALSE(record_inputs(path("other/../inputs.tactus")));
    EXPECT_TRUE(has_said("is being written by another recording"));
    first->close();
    EXPECT_TRUE(record_inputs(path("inputs.tactus"))) << "the first one has ended";
}

TEST_F(WrittenFiles, RowsDoNotReplaceInputsThatAreBeingRecorded) {
    const auto inputs = record_inputs(path("one"));
    ASSERT_TRUE(inputs);
    EXPECT_FALSE(record(path("one")));
    EXPECT_TRUE(has_said("is being written by another recording"));
}

TEST_F(WrittenFiles, RowsThatArePlayedDoNotReplaceTheirRecording) {
    record_inputs(path("inputs.tactus"))->close();
    const std::string before = content(path("inputs.tactus"));
    ASSERT_FALSE(before.empty());
    std::string error;
    EXPECT_FALSE(InputPlayer::open(path("inputs.tactus"), path("other/../inputs.tactus"), error));
    EXPECT_NE(error.find("is the recording itself"), std::string::npos) << error;
    EXPECT_EQ(content(path("inputs.tactus")), before);
    EXPECT_TRUE(InputPlayer::open(path("inputs.tactus"), path("rows.csv"), error)) << error;
}

TEST_F(WrittenFiles, AFullDiskIsToldByEachKindOfThem) {
    if (!std::filesystem::exists(full)) {
        GTEST_SKIP() << "this system has no file that is always full";
    }
    const auto rows = record(full);
    ASSERT_TRUE(rows);
    rows->drain(0);
    rows->close();
    EXPECT_TRUE(has_said("could not be written to its end"));
    EXPECT_NE(rows->problem(), "");

    said.clear();
    const auto trace = record("", full);
    ASSERT_TRUE(trace);
    trace->close();
    EXPECT_TRUE(!said.empty() && said[0].find("could not be written to its end") != std::string::npos);

    said.clear();
    const auto inputs = record_inputs(full);
    ASSERT_TRUE(inputs);
    inputs->close();
    EXPECT_TRUE(has_said("could not be written to its end"));

    record_inputs(path("inputs.tactus"))->close();
    std::string error;
    const auto played = InputPlayer::open(path("inputs.tactus"), full, error);
    ASSERT_TRUE(played) << error;
    played->play(1);
    EXPECT_NE(played->rows_problem().find("could not be written to its end"), std::string::npos);
}

}  // namespace
}  // namespace tactus::written_file_test
