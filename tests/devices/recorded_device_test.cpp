#include "devices/recorded_device.hpp"

#include <gtest/gtest.h>

namespace tactus::recorded_device_test {
namespace {

DeviceSample sample_at(double x) {
    DeviceSample sample;
    sample.position = {x, 0.0, 0.0};
    sample.velocity = {1.0, 0.0, 0.0};
    sample.buttons = 3;
    sample.connected = true;
    return sample;
}

TEST(RecordedDevice, GivesOneSampleATickWhateverTheTime) {
    RecordedDevice device({sample_at(0.1), sample_at(0.2), sample_at(0.3)});
    EXPECT_EQ(device.read(0).position.x, 0.1);
    EXPECT_EQ(device.read(0).position.x, 0.2);
    const DeviceSample third = device.read(-50);
    EXPECT_EQ(third.position.x, 0.3);
    EXPECT_EQ(third.velocity.x, 1.0);
    EXPECT_EQ(third.buttons, 3u);
    EXPECT_TRUE(third.connected);
}

TEST(RecordedDevice, StaysAtItsEndAndIsGone) {
    RecordedDevice device({sample_at(0.1)});
    device.read(0);
    for (int i = 0; i < 3; ++i) {
        const DeviceSample after = device.read(1);
        EXPECT_EQ(after.position.x, 0.1);
        EXPECT_EQ(after.velocity, Vec3(0.0));
        EXPECT_EQ(after.buttons, 0u);
        EXPECT_FALSE(after.connected);
    }
}

}  // namespace
}  // namespace tactus::recorded_device_test
