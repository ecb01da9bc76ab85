#include "devices/path_device.hpp"

#include <gtest/gtest.h>

namespace tactus::path_device_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;

TEST(PathDevice, ItsPathBeginsWithTheFirstTick) {
    PathDevice device(CircleWave{});
    EXPECT_EQ(device.read(77'777 * ms).position, sample_path(CircleWave{}, 0).position);
    const DeviceSample later = device.read(77'777 * ms + 1'500 * ms);
    EXPECT_EQ(later.position, sample_path(CircleWave{}, 1'500 * ms).position);
    EXPECT_EQ(later.velocity, sample_path(CircleWave{}, 1'500 * ms).velocity);
}

TEST(PathDevice, ItsPathBeginsAnewWhereThatIsAskedFor) {
    PathDevice device(CircleWave{});
    device.read(0);
    device.read(1'500 * ms);
    EXPECT_EQ(device.clock().elapsed(), 1'500 * ms);
    device.clock().restart();
    EXPECT_EQ(device.clock().elapsed(), 0);
    EXPECT_EQ(device.read(1'501 * ms).position, sample_path(CircleWave{}, 0).position);
    EXPECT_EQ(device.read(1'511 * ms).position, sample_path(CircleWave{}, 10 * ms).position);
    EXPECT_EQ(device.clock().elapsed(), 10 * ms);
}

TEST(PathDevice, IsAlwaysConnectedAndFeelsNothing) {
    PathDevice device(CircleWave{});
    PathDevice pushed(CircleWave{});
    for (Nanoseconds t = 0; t < 100 * ms; t += ms) {
        const DeviceSample free_hand = device.read(t);
        EXPECT_TRUE(free_hand.connected);
        EXPECT_EQ(free_hand.position, pushed.read(t).position);
        pushed.write(t, Vec3(0.0, 100.0, 0.0));
    }
}

}  // namespace
}  // namespace tactus::path_device_test
