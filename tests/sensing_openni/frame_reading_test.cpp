#include "sensing/openni/frame_reading.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace tactus::frame_reading_test {
namespace {

constexpr int width = 8, height = 4;

// A frame as a sound driver gives it, of a view of that size.
struct Given {
    std::vector<OniDepthPixel> pixels = std::vector<OniDepthPixel>(width * height, 900);
    OniFrame frame{};
    DepthCamera view = camera_of_view(width, height, 1.0, 0.8);
    DepthImage image{view, std::vector<std::uint16_t>(width* height, 1), 5};

    Given() {
        frame.data = pixels.data();
        frame.dataSize = static_cast<int>(pixels.size() * sizeof(OniDepthPixel));
        frame.sensorType = ONI_SENSOR_DEPTH;
        frame.timestamp = 77;
        frame.width = frame.videoMode.resolutionX = width;
        frame.height = frame.videoMode.resolutionY = height;
        frame.videoMode.pixelFormat = ONI_PIXEL_FORMAT_DEPTH_1_MM;
        frame.stride = width * static_cast<int>(sizeof(OniDepthPixel));
    }
    std::string taken(bool is_mirrored = false) { return take_frame(frame, view, is_mirrored, image); }
};

TEST(FrameReading, TakesWhatADriverGives) {
    Given given;
    given.pixels[0] = 800;
    EXPECT_EQ(given.taken(), "");
    EXPECT_EQ(given.image.depth_mm[0], 800);
    EXPECT_EQ(given.image.time_us, 77u);
    EXPECT_EQ(given.taken(true), "");
    EXPECT_EQ(given.image.depth_mm[width - 1], 800);
    given.frame.videoMode.pixelFormat = ONI_PIXEL_FORMAT_DEPTH_100_UM;
    EXPECT_EQ(given.taken(), "");
    EXPECT_EQ(given.image.depth_mm[0], 80);
}

TEST(FrameReading, ACroppedFrameStandsWhereItBelongs) {
    Given given;
    given.frame.croppingEnabled = TRUE;
    given.frame.cropOriginX = 3;
    given.frame.cropOriginY = 1;
    given.frame.width = 2;
    given.frame.height = 2;
    EXPECT_EQ(given.taken(), "");
    EXPECT_EQ(given.image.depth_mm[width + 3], 900);
    EXPECT_EQ(given.image.depth_mm[width + 5], 0);
    EXPECT_EQ(given.image.depth_mm[0], 0);
    given.frame.cropOriginX = 7;
    EXPECT_NE(given.taken(), "");
}

// A smaller one became the top left of the image: things where there are none.
TEST(FrameReading, AFrameOfAnotherSizeIsNoneAndSaysSo) {
    for (const auto& [w, h] : {std::pair{4, 2}, {4, 4}, {8, 2}, {16, 8}, {0, 0}, {-1, 4}, {0x7fffffff, 4}}) {
        Given given;
        given.frame.width = given.frame.videoMode.resolutionX = w;
        given.frame.height = given.frame.videoMode.resolutionY = h;
        EXPECT_FALSE(has_size_of(given.frame, given.view));
        const std::string said = given.taken();
        EXPECT_NE(said.find("8 × 4 were announced"), std::string::npos) << said;
        EXPECT_EQ(given.image.time_us, 5u) << "the image is as it was";
        EXPECT_EQ(given.image.depth_mm, std::vector<std::uint16_t>(width * height, 1));
    }
}

TEST(FrameReading, EachFieldMayBeWrong) {
    const std::vector<std::function<void(OniFrame&)>> faults{
        [](OniFrame& frame) { frame.data = nullptr; },
        [](OniFrame& frame) { frame.dataSize -= 1; },
        [](OniFrame& frame) { frame.dataSize = -1; },
        [](OniFrame& frame) { frame.stride = 0; },
        [](OniFrame& frame) { frame.stride = -16; },
        [](OniFrame& frame) { frame.stride = 0x7fffffff; },
        [](OniFrame& frame) { frame.videoMode.pixelFormat = ONI_PIXEL_FORMAT_RGB888; },
        [](OniFrame& frame) { frame.croppingEnabled = TRUE, frame.cropOriginX = -1; },
        [](OniFrame& frame) { frame.croppingEnabled = TRUE, frame.cropOriginY = 0x7fffffff; },
        [](OniFrame& frame) { frame.croppingEnabled = TRUE, frame.width = 0; },
    };
    for (std::size_t i = 0; i < faults.size(); ++i) {
        Given given;
        faults[i](given.frame);
        EXPECT_NE(given.taken(), "") << i;
        EXPECT_EQ(given.image.time_us, 5u) << i;
    }
}

}  // namespace
}  // namespace tactus::frame_reading_test
