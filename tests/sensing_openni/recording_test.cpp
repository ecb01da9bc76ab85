// Recordings as OpenNI2 itself makes them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <span>
#include <thread>

#include "scene.hpp"
#include "sensing/openni/camera.hpp"
#include "sensing/openni/recording_check.hpp"

namespace tactus {
namespace {

using testing::Scene;

namespace fs = std::filesystem;

constexpr int frames = 12;

// What is left out of a frame of 320 × 240 by the recordings' codec: its last pixels.
constexpr std::size_t lost_pixels = 16;

std::vector<std::uint16_t> without_end(const DepthImage& image) {
    return {image.depth_mm.begin(), image.depth_mm.end() - lost_pixels};
}

std::vector<std::byte> bytes_of(const fs::path& path) {
    std::vector<std::byte> bytes(fs::file_size(path));
    std::ifstream(path, std::ios::binary)
        .read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return bytes;
}

// A device and its stream, as OpenNI2's own recorder wants them.
class Recording : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        path_ = fs::temp_directory_path() / ("tactus_recording_" + std::to_string(getpid()) + ".oni");
        record();
    }
    static void TearDownTestSuite() { fs::remove(path_); }

    static void record() {
        Scene scene;
        scene.show(1);
        Camera camera(testing::openni());
        ASSERT_EQ(camera.open({.uri = scene.uri(), .record_to = path_.string()}), "");
        DepthImage image;
        for (int i = 0; i < frames; ++i) {
            scene.move(0.005 * i);
            scene.show(frame_time(i));
            ASSERT_EQ(camera.read(image, 2000), Camera::Reading::frame);
            images_.push_back(scene.image(frame_time(i)));
        }
    }
    static std::uint64_t frame_time(int number) { return 33333u * static_cast<std::uint64_t>(number + 1); }

    static inline fs::path path_;
    static inline std::vector<DepthImage> images_;
};

TEST_F(Recording, PlaysBackEveryFrameAndEnds) {
    Camera camera(testing::openni());
    ASSERT_EQ(camera.open({.uri = path_.string(), .repeats = false, .as_fast_as_read = true}), "");
    EXPECT_TRUE(camera.is_recording());
    DepthImage image;
    std::size_t next = 0;
    Camera::Reading last = Camera::Reading::frame;
    for (int i = 0; i < 100 && last != Camera::Reading::ended; ++i) {
        last = camera.read(image, 100);
        if (last != Camera::Reading::frame) {
            continue;
        }
        while (next < images_.size() && without_end(images_[next]) != without_end(image)) {
            ++next;  // the recorder may have missed the first ones
        }
        ASSERT_LT(next, images_.size()) << "a frame that was never recorded";
        ++next;
    }
    EXPECT_EQ(last, Camera::Reading::ended);
    EXPECT_EQ(next, images_.size());
}

// OpenNI2's player looks for more without a pause.
TEST_F(Recording, AtItsEndItTakesNoProcessorTime) {
    Camera camera(testing::openni());
    ASSERT_EQ(camera.open({.uri = path_.string(), .repeats = false, .as_fast_as_read = true}), "");
    DepthImage image;
    for (int i = 0; i < 100 && camera.read(image, 100) != Camera::Reading::ended; ++i) {
    }
    ASSERT_EQ(camera.read(image, 100), Camera::Reading::ended);
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t used = std::clock();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const double share = static_cast<double>(std::clock() - used) / CLOCKS_PER_SEC /
                         std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    EXPECT_LT(share, 0.5);
}

TEST_F(Recording, IsClosedAndOpenedOverAndOver) {
    DepthImage image;
    for (int round = 0; round < 30; ++round) {
        Camera camera(testing::openni());
        ASSERT_EQ(
            camera.open({.uri = path_.string(), .repeats = round % 2 == 0, .as_fast_as_read = round % 3 > 0}),
            "");
        for (int i = 0; i < round % 5; ++i) {
            ASSERT_EQ(camera.read(image, 2000), Camera::Reading::frame) << round;
        }
    }
}

TEST_F(Recording, BeginsAgainWhereItRepeats) {
    Camera camera(testing::openni());
    ASSERT_EQ(camera.open({.uri = path_.string(), .repeats = true, .as_fast_as_read = true}), "");
    DepthImage image;
    for (int i = 0; i < 3 * frames; ++i) {
        ASSERT_EQ(camera.read(image, 2000), Camera::Reading::frame) << i;
    }
}

TEST_F(Recording, WhereNoFileCanBeIsSaidSo) {
    Scene scene;
    scene.show(1);
    Camera camera(testing::openni());
    const std::string error = camera.open({.uri = scene.uri(), .record_to = "/nowhere/images.oni"});
    EXPECT_NE(error.find("cannot be recorded into '/nowhere/images.oni'"), std::string::npos) << error;
    EXPECT_EQ(camera.open({.uri = scene.uri()}), "");
}

TEST_F(Recording, ThatIsMissingIsSaidSo) {
    Camera camera(testing::openni());
    const std::string error = camera.open({"/nowhere/at_all.oni"});
    EXPECT_EQ(
        error,
        "the recording '/nowhere/at_all.oni' cannot be played: No such file or directory; name another one");
}

// OpenNI2's player would end the program.
TEST_F(Recording, ThatIsCutOffIsSaidSo) {
    const std::vector<std::byte> whole = bytes_of(path_);
    ASSERT_EQ(check_recording(whole), "");
    // The recorder leaves room behind the end.
    const std::array<std::byte, 8> end{std::byte{'N'}, std::byte{'I'}, std::byte{'R'}, std::byte{0},
                                       std::byte{0x0b}};
    const auto last = std::ranges::find_end(whole, end).begin();
    const auto needed = static_cast<std::size_t>(last - whole.begin()) + 28;
    EXPECT_EQ(check_recording(std::span(whole).first(needed)), "");
    for (std::size_t bytes = 0; bytes < needed; bytes += bytes < 4096 ? 1 : 97) {
        ASSERT_NE(check_recording(std::span(whole).first(bytes)), "") << bytes;
    }
    const fs::path damaged = path_.string() + ".damaged.oni";
    for (const std::uintmax_t bytes : {std::size_t{0}, std::size_t{300}, needed * 2 / 3, needed - 1}) {
        fs::copy_file(path_, damaged, fs::copy_options::overwrite_existing);
        fs::resize_file(damaged, bytes);
        Camera camera(testing::openni());
        const std::string error = camera.open({.uri = damaged.string()});
        EXPECT_NE(error.find("cannot be played: it is"), std::string::npos) << bytes << ": " << error;
    }
    fs::remove(damaged);
}

TEST_F(Recording, WhoseRecordsAreDamagedIsSaidSo) {
    std::vector<std::byte> bytes = bytes_of(path_);
    bytes[24] = std::byte{0};  // of the first record's magic
    EXPECT_EQ(check_recording(bytes), "it is damaged after 0 images");
    bytes = bytes_of(path_);
    bytes[0] = std::byte{'X'};
    EXPECT_EQ(check_recording(bytes), "it is not a recording by OpenNI2");
}

}  // namespace
}  // namespace tactus
