#include "sensing/recording/oni_file.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "shared/oni_writer.hpp"

namespace tactus::oni_file_test {
namespace {

using shared::OniWriter;
using shared::slope_image;
using shared::slope_recording;

constexpr std::uint32_t width = 24, height = 10;

// What a file says, and each of its images that is one.
struct Played {
    std::string wrong;
    OniRecording recording;
    std::vector<DepthImage> images;

    explicit Played(const std::string& bytes) {
        std::istringstream file(bytes);
        wrong = read_oni(file, recording);
        std::vector<std::byte> memory;
        DepthImage image;
        for (std::size_t i = 0; wrong.empty() && i < recording.frames.size(); ++i) {
            if (read_oni_frame(file, recording, i, memory, image)) {
                images.push_back(image);
            }
        }
    }
};

TEST(OniFile, GivesTheImagesAndTheTimesThatWereRecorded) {
    for (const DepthCodec codec : {DepthCodec::none, DepthCodec::differences, DepthCodec::indices}) {
        const Played played(slope_recording(width, height, 3, codec));
        ASSERT_EQ(played.wrong, "");
        ASSERT_EQ(played.images.size(), 3u);
        for (int i = 0; i < 3; ++i) {
            const DepthImage& image = played.images[static_cast<std::size_t>(i)];
            EXPECT_EQ(image.depth_mm, slope_image(width, height, i));
            EXPECT_EQ(image.time_us, 33'000u * static_cast<std::uint64_t>(i + 1));
            EXPECT_EQ(image.camera, camera_of_view(width, height, 1.0, 0.8));
        }
    }
}

TEST(OniFile, OlderVersionsAreRead) {
    OniWriter writer(0);
    writer.add_camera(width, height, DepthCodec::differences);
    writer.add_image(5, slope_image(width, height, 2));
    writer.end();
    const Played played(writer.bytes());
    ASSERT_EQ(played.wrong, "");
    ASSERT_EQ(played.images.size(), 1u);
    EXPECT_EQ(played.images[0].depth_mm, slope_image(width, height, 2));
}

TEST(OniFile, MirroredAndCroppedImagesStandWhereTheyBelong) {
    OniWriter writer;
    writer.add_camera(width, height, DepthCodec::indices);
    writer.set_whole_number(OniWriter::depth_node, "xnMirror", 1);
    writer.set_whole_number(OniWriter::depth_node, "oniPixelFormat", 101);
    writer.set_crop({4, 2, 3, 2});
    writer.add_image(5, std::vector<std::uint16_t>{8000, 8004, 8005, 9000, 0, 9990});
    writer.end();
    const Played played(writer.bytes());
    ASSERT_EQ(played.images.size(), 1u) << played.wrong;
    const auto at = [&](std::size_t u, std::size_t v) { return played.images[0].depth_mm[v * width + u]; };
    EXPECT_EQ(at(width - 1 - 4, 2), 800);
    EXPECT_EQ(at(width - 1 - 5, 2), 800);
    EXPECT_EQ(at(width - 1 - 6, 2), 801);
    EXPECT_EQ(at(width - 1 - 4, 3), 900);
    EXPECT_EQ(at(width - 1 - 5, 3), 0);
    EXPECT_EQ(at(0, 0), 0);
}

TEST(OniFile, ASizeThatChangesIsThatOfTheImagesBehindIt) {
    OniWriter writer;
    writer.add_camera(width, height, DepthCodec::none);
    writer.add_image(1, slope_image(width, height, 0));
    writer.set_size(12, 5);
    writer.add_image(2, slope_image(12, 5, 1));
    writer.end();
    const Played played(writer.bytes());
    ASSERT_EQ(played.images.size(), 2u) << played.wrong;
    EXPECT_EQ(played.images[0].camera.width, 24);
    EXPECT_EQ(played.images[1].camera.width, 12);
    EXPECT_EQ(played.images[1].depth_mm, slope_image(12, 5, 1));
}

TEST(OniFile, OfSeveralCamerasTheFirstDepthCameraIsPlayed) {
    OniWriter writer;
    writer.add_node(7, 3, "JPEG");
    writer.add_camera(width, height, DepthCodec::none);
    writer.add_node(9, 2, "NONE");
    const std::vector<std::uint16_t> other = slope_image(4, 4, 0);
    writer.add_data(7, 1, std::as_bytes(std::span(other)));
    writer.add_data(9, 1, std::as_bytes(std::span(other)));
    writer.add_image(2, slope_image(width, height, 1));
    writer.end();
    const Played played(writer.bytes());
    ASSERT_EQ(played.images.size(), 1u) << played.wrong;
    EXPECT_EQ(played.images[0].time_us, 2u);
}

TEST(OniFile, WhatItCannotPlayIsSaid) {
    const auto said = [](const auto& write) {
        OniWriter writer;
        write(writer);
        writer.add_image(1, slope_image(width, height, 0));
        writer.end();
        return Played(writer.bytes()).wrong;
    };
    EXPECT_NE(said([](OniWriter&) {}).find("no depth images"), std::string::npos);
    EXPECT_NE(said([](OniWriter& writer) { writer.add_node(1, 2, "NONE"); }).find("angle of view"),
              std::string::npos);
    EXPECT_NE(said([](OniWriter& writer) {
                  writer.add_node(1, 2, "JPEG");
                  writer.add_camera(width, height, DepthCodec::none);
              }).find("compressed"),
              std::string::npos);
    EXPECT_NE(said([](OniWriter& writer) {
                  writer.add_camera(width, height, DepthCodec::none);
                  writer.set_whole_number(1, "oniPixelFormat", 200);
              }).find("millimeters"),
              std::string::npos);
    EXPECT_NE(said([](OniWriter& writer) {
                  writer.add_camera(width, height, DepthCodec::none);
                  writer.set_crop({20, 0, 5, 5});
              }).find("cut out of more"),
              std::string::npos);
    EXPECT_NE(said([](OniWriter& writer) {
                  writer.add_camera(0x7fffffff, 0x7fffffff, DepthCodec::none);
              }).find("size"),
              std::string::npos);
    EXPECT_NE(Played("").wrong.find("not a recording"), std::string::npos);
    EXPECT_NE(Played("XI10" + slope_recording(width, height, 1, DepthCodec::none).substr(4))
                  .wrong.find("not a recording"),
              std::string::npos);
}

TEST(OniFile, ThatIsCutOffIsSaidSoAtEveryByte) {
    const std::string whole = slope_recording(width, height, 2, DepthCodec::indices);
    ASSERT_EQ(Played(whole).wrong, "");
    EXPECT_EQ(Played(whole + std::string(100, '\0')).wrong, "") << "recorders leave room behind the end";
    for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
        ASSERT_NE(Played(whole.substr(0, bytes)).wrong, "") << bytes;
    }
}

// No byte of it, whatever it is, leads beyond the file or into memory that is not needed.
TEST(OniFile, WithAnyByteChangedItIsRefusedOrPlayed) {
    const std::string whole = slope_recording(width, height, 2, DepthCodec::indices);
    const std::size_t pixels = width * height;
    for (std::size_t at = 0; at < whole.size(); ++at) {
        for (const int value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
            std::string changed = whole;
            changed[at] = static_cast<char>(value);
            const Played played(changed);
            if (!played.wrong.empty()) {
                ASSERT_FALSE(played.wrong.ends_with('.')) << at;
                continue;
            }
            ASSERT_LE(played.images.size(), 2u);
            for (const DepthImage& image : played.images) {
                ASSERT_EQ(image.depth_mm.size(), pixel_count(image.camera)) << at;
            }
        }
    }
    EXPECT_EQ(Played(whole).images.front().depth_mm.size(), pixels);
}

// The largest size that is believed, with an image that is not of it.
TEST(OniFile, AnImageThatIsNotOfItsSizeIsNone) {
    OniWriter writer;
    writer.add_camera(4096, 4096, DepthCodec::differences);
    writer.add_image(1, slope_image(width, height, 0));
    writer.set_size(2, 2);
    writer.add_image(2, slope_image(width, height, 0));
    writer.end();
    const Played played(writer.bytes());
    EXPECT_EQ(played.wrong, "");
    EXPECT_EQ(played.recording.frames.size(), 2u);
    EXPECT_TRUE(played.images.empty());
}

}  // namespace
}  // namespace tactus::oni_file_test
