#include "devices/device_recording.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace tactus::device_recording_test {
namespace {

DeviceRecording read_text(const std::string& text) {
    std::FILE* file = std::tmpfile();
    std::fputs(text.c_str(), file);
    std::rewind(file);
    DeviceRecording recording = read_device_recording(file);
    std::fclose(file);
    return recording;
}

const std::string first_line = "tactus device recording 1\n";
const std::string good_line = "1p+0 0p+0 0p+0 0p+0 0p+0 0p+0 1p+0 0p+0 0p+0 0p+0 0 1\n";

TEST(DeviceRecording, GivesBackEveryBit) {
    std::mt19937_64 random(11);
    std::normal_distribution<double> any(0.0, 0.1);
    std::vector<DeviceSample> samples(200);
    for (DeviceSample& sample : samples) {
        sample.position = {any(random), any(random), any(random)};
        sample.velocity = {any(random), any(random), any(random)};
        sample.rotation = Quat(any(random), any(random), any(random), any(random));
        sample.buttons = static_cast<std::uint32_t>(random());
        sample.connected = random() % 2 == 0;
    }
    samples[0].position = {-0.0, std::numeric_limits<double>::denorm_min(),
                           -std::numeric_limits<double>::max()};

    std::FILE* file = std::tmpfile();
    ASSERT_TRUE(write_device_recording(file, samples));
    std::rewind(file);
    const DeviceRecording recording = read_device_recording(file);
    std::fclose(file);

    EXPECT_EQ(recording.error, "");
    ASSERT_EQ(recording.samples.size(), samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        EXPECT_EQ(std::memcmp(&recording.samples[i].position, &samples[i].position, sizeof(Vec3)), 0);
        EXPECT_EQ(std::memcmp(&recording.samples[i].velocity, &samples[i].velocity, sizeof(Vec3)), 0);
        EXPECT_EQ(std::memcmp(&recording.samples[i].rotation, &samples[i].rotation, sizeof(Quat)), 0);
        EXPECT_EQ(recording.samples[i].buttons, samples[i].buttons);
        EXPECT_EQ(recording.samples[i].connected, samples[i].connected);
    }
}

TEST(DeviceRecording, ReadsLinesOfEitherKindOfEnd) {
    EXPECT_EQ(read_text(first_line + good_line).samples.size(), 1u);
    std::string other_end = good_line;
    other_end.insert(other_end.size() - 1, "\r");
    EXPECT_EQ(read_text(first_line + other_end + other_end).samples.size(), 2u);
}

TEST(DeviceRecording, SaysWhichLineIsNoSample) {
    const char* const bad_lines[] = {
        "\n",
        "1p+0\n",
        "1p+0 0p+0 0p+0 0p+0 0p+0 0p+0 1p+0 0p+0 0p+0 0p+0 0 2\n",
        "1p+0 0p+0 0p+0 0p+0 0p+0 0p+0 1p+0 0p+0 0p+0 0p+0 -1 1\n",
        "1p+0 0p+0 0p+0 0p+0 0p+0 0p+0 1p+0 0p+0 0p+0 0p+0 0 1 7\n",
        "xp+0 0p+0 0p+0 0p+0 0p+0 0p+0 1p+0 0p+0 0p+0 0p+0 0 1\n",
    };
    for (const std::string bad : bad_lines) {
        const DeviceRecording recording = read_text(first_line + good_line + bad);
        EXPECT_EQ(recording.error, "line 3 is not a sample");
        EXPECT_TRUE(recording.samples.empty());
    }
    EXPECT_NE(read_text(first_line + std::string(5000, '1')).error, "");
}

TEST(DeviceRecording, RefusesWhatIsNoRecording) {
    EXPECT_NE(read_text("").error, "");
    EXPECT_NE(read_text("time,x,y,z\n").error, "");
    EXPECT_NE(read_text(first_line).error, "");
}

}  // namespace
}  // namespace tactus::device_recording_test
