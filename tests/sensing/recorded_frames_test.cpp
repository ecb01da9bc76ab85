#include "sensing/recording/recorded_frames.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <system_error>

#include "shared/oni_writer.hpp"

namespace tactus::recorded_frames_test {
namespace {

namespace fs = std::filesystem;

constexpr Playback::Choice at_once{.repeats = false, .as_fast_as_read = true};

// A file that goes with this.
class Written {
public:
    explicit Written(const std::string& bytes)
        : path_(fs::temp_directory_path() /
                ("tactus_frames_" + std::to_string(std::random_device()()) + ".oni")) {
        std::ofstream(path_, std::ios::binary) << bytes;
    }
    ~Written() { fs::remove(path_); }
    std::string path() const { return path_.string(); }

private:
    fs::path path_;
};

TEST(RecordedFrames, AreReadOneAfterTheOther) {
    const Written file(shared::slope_recording(24, 10, 3, DepthCodec::indices));
    RecordedFrames frames;
    ASSERT_EQ(frames.open(file.path(), at_once), "");
    EXPECT_EQ(frames.frame_count(), 3u);
    EXPECT_NE(frames.name().find(file.path()), std::string::npos);
    DepthImage image;
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(frames.read(image, 0), FrameSource::Reading::frame);
        EXPECT_EQ(image.depth_mm, shared::slope_image(24, 10, i));
    }
    EXPECT_EQ(frames.read(image, 0), FrameSource::Reading::ended);
    EXPECT_FALSE(frames.has_our_clock());
}

TEST(RecordedFrames, WhatIsNoRecordingIsSaidSo) {
    const auto said = [](const std::string& path) { return RecordedFrames().open(path, at_once); };
    EXPECT_EQ(
        said("/nowhere/at_all.oni"),
        "the recording '/nowhere/at_all.oni' cannot be played: No such file or directory; name another one");
    EXPECT_NE(said(fs::temp_directory_path().string()).find("cannot be played"), std::string::npos);
    const std::string whole = shared::slope_recording(24, 10, 3, DepthCodec::none);
    EXPECT_NE(said(Written("").path()).find("cannot be played"), std::string::npos);
    const Written cut(whole.substr(0, whole.size() / 2));
    EXPECT_NE(said(cut.path()).find("cannot be played: it is cut off"), std::string::npos);
}

TEST(RecordedFrames, ADamagedImageIsSaidSoAndTheNextOneIsWhole) {
    shared::OniWriter writer;
    writer.add_camera(24, 10, DepthCodec::none);
    writer.add_image(1, shared::slope_image(24, 9, 0));
    writer.add_image(2, shared::slope_image(24, 10, 1));
    writer.end();
    const Written file(writer.bytes());
    RecordedFrames frames;
    ASSERT_EQ(frames.open(file.path(), at_once), "");
    DepthImage image;
    EXPECT_EQ(frames.read(image, 0), FrameSource::Reading::damaged);
    EXPECT_NE(frames.trouble().find("damaged at image 1"), std::string::npos) << frames.trouble();
    EXPECT_EQ(frames.read(image, 0), FrameSource::Reading::frame);
    EXPECT_EQ(image.time_us, 2u);
}

// The disk that it is on may go while it plays.
TEST(RecordedFrames, AFileThatBecomesShorterIsDamaged) {
    const Written file(shared::slope_recording(64, 48, 3, DepthCodec::none));
    RecordedFrames frames;
    ASSERT_EQ(frames.open(file.path(), at_once), "");
    std::error_code refused;
    fs::resize_file(file.path(), 100, refused);
    if (refused) {
        GTEST_SKIP() << "this system keeps files whole that are open";
    }
    DepthImage image;
    EXPECT_EQ(frames.read(image, 0), FrameSource::Reading::damaged);
}

}  // namespace
}  // namespace tactus::recorded_frames_test
