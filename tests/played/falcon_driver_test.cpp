// The Falcon's driver against one that is played below libusb: nothing of it knows. Time is real here; what
// is waited for may come late, and no test looks at how late.
#include <gtest/gtest.h>

#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <string>

#include "devices/driver_device.hpp"
#include "devices/falcon/falcon_driver.hpp"
#include "devices/scan.hpp"
#include "platform/sleep.hpp"
#include "played/played_stall.hpp"
#include "played/played_usb.hpp"

namespace tactus::falcon_driver_test {
namespace {

using shared::PlayedFalcon;
using shared::PlayedUsb;
using Phase = DriverHealth::Phase;

constexpr Nanoseconds ms = 1'000'000;

FalconSettings with_firmware(std::string id = {}) {
    FalconSettings settings;
    settings.firmware = PlayedFalcon::firmware();
    settings.id = std::move(id);
    return settings;
}

std::unique_ptr<DriverDevice> falcon(FalconSettings settings = with_firmware()) {
    return std::make_unique<DriverDevice>(std::make_unique<FalconDriver>(std::move(settings)));
}

// A loop that asks for this force a thousand times a second, until something has come true; false: it has
// not.
bool tick_until(DriverDevice& device, const Vec3& force,
                const std::function<bool(const DeviceSample&)>& done) {
    SleepTimer timer;
    const Nanoseconds end = monotonic_now() + 20'000 * ms;
    for (Nanoseconds now = monotonic_now(); now < end; now = monotonic_now()) {
        const DeviceSample sample = device.read(now);
        if (done(sample)) {
            return true;
        }
        device.write(now, force);
        timer.sleep_until(now + ms);
    }
    return false;
}

bool is_connected(const DeviceSample& sample) {
    return sample.connected;
}

// Text of the device's state, once it says something with these words.
bool says(const DriverDevice& device, const std::string& words) {
    SleepTimer timer;
    for (int i = 0; i < 3'000; ++i) {
        if (device.health().text.find(words) != std::string::npos) {
            return true;
        }
        timer.sleep_until(monotonic_now() + 10 * ms);
    }
    ADD_FAILURE() << "it says: " << device.health().text;
    return false;
}

TEST(PlayedFalcon, StartsIsHomedAndFollowsTheHand) {
    PlayedUsb usb({});
    usb.plug();
    const auto device = falcon();
    ASSERT_TRUE(tick_until(*device, Vec3(0.0), is_connected)) << device->health().text;
    EXPECT_EQ(device->health().id, "usb1-1");
    usb.mean({0.02, -0.01, 0.01});
    usb.press(5);
    EXPECT_TRUE(tick_until(*device, Vec3(0.0), [&usb](const DeviceSample& sample) {
        return sample.buttons == 5 && glm::distance(sample.position, Vec3(0.02, -0.01, 0.01)) < 1e-3 &&
               glm::distance(sample.position, usb.hand()) < 1e-3;
    }));
    EXPECT_TRUE(
        tick_until(*device, Vec3(0.0), [&usb](const auto&) { return usb.leds() == falcon_led_green; }));
    EXPECT_EQ(device->capabilities().max_force, falcon_capabilities().max_force);
    EXPECT_EQ(device->health().phase, Phase::running);
}

TEST(PlayedFalcon, IsFoundWhileItIsPluggedInAndNotOpened) {
    PlayedUsb usb({});
    EXPECT_TRUE(plugged_devices().empty());
    usb.plug();
    const std::vector<PluggedDevice> found = plugged_devices();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].kind, DriverKind::falcon);
    EXPECT_EQ(found[0].id, "usb1-1");
    // Whoever opens it finds it free.
    const auto device = falcon(with_firmware(found[0].id));
    EXPECT_TRUE(tick_until(*device, Vec3(0.0), is_connected)) << device->health().text;
}

TEST(PlayedFalcon, TheHandFeelsTheForceThatWasAskedFor) {
    PlayedUsb usb({});
    usb.plug();
    const auto device = falcon();
    ASSERT_TRUE(tick_until(*device, Vec3(0.0), is_connected));
    const Vec3 wanted(1.5, -2.0, 1.0);
    // The hand gives way by force over stiffness, 12 mm: the direction has to be right there, too.
    EXPECT_TRUE(tick_until(*device, wanted,
                           [&](const DeviceSample&) { return glm::distance(usb.force(), wanted) < 0.05; }))
        << usb.force().x << " " << usb.force().y << " " << usb.force().z;
}

// By the loop, within its limits: see Session.AnArmIsCarriedWhereAForceMayBeGiven.
TEST(PlayedFalcon, SaysWhatItsArmWeighs) {
    PlayedUsb usb({});
    usb.plug();
    FalconSettings settings = with_firmware();
    settings.weight = 1.0;
    const auto device = falcon(settings);
    ASSERT_TRUE(tick_until(*device, Vec3(0.0), is_connected));
    EXPECT_EQ(device->capabilities().weight, 1.0);
}

TEST(PlayedFalcon, AStalledLoopLetsTheHandGo) {
    PlayedUsb usb({});
    usb.plug();
    const auto device = falcon();
    ASSERT_TRUE(
        tick_until(*device, {0.0, 3.0, 0.0}, [&](const DeviceSample&) { return usb.force().y > 2.5; }));
    SleepTimer timer;
    for (int i = 0; i < 1'000 && usb.force() != Vec3(0.0); ++i) {
        timer.sleep_until(monotonic_now() + ms);
    }
    EXPECT_EQ(usb.force(), Vec3(0.0));
    EXPECT_TRUE(usb.running());
}

// Whatever its thread was just doing, and also where the force was let go of and on again a moment before.
TEST(PlayedFalcon, AStalledDriverIsLetGoOfEachTime) {
    shared::PlayedUsbSettings played;
    played.falcon.torque_time = 3'600'000 * ms;  // it is no other's doing
    PlayedUsb usb(played);
    usb.plug();
    const auto device = falcon();
    shared::RandomValues random(11);
    for (int times = 0; times < 40; ++times) {
        ASSERT_TRUE(
            tick_until(*device, {0.0, 3.0, 0.0}, [&](const DeviceSample&) { return usb.force().y > 2.5; }));
        const Nanoseconds end = monotonic_now() + static_cast<Nanoseconds>(random.between(1e6, 4e6));
        tick_until(*device, {0.0, 3.0, 0.0}, [end](const auto&) { return monotonic_now() > end; });
        const shared::StalledThread stalled("tactus-device");
        ASSERT_TRUE(tick_until(*device, {0.0, 3.0, 0.0}, [&](const auto&) { return usb.is_let_go(); }));
    }
}

TEST(PlayedFalcon, StartsWhereAThirdOfAllTransfersFail) {
    shared::PlayedUsbSettings played;
    played.failing = 0.3;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        played.seed = seed;
        PlayedUsb usb(played);
        usb.plug();
        const auto device = falcon();
        EXPECT_TRUE(tick_until(*device, Vec3(0.0), is_connected)) << device->health().text;
    }
}

TEST(PlayedFalcon, APulledCableIsNoEnd) {
    PlayedUsb usb({});
    usb.plug();
    const auto device = falcon();
    for (std::uint64_t times = 1; times <= 3; ++times) {
        ASSERT_TRUE(tick_until(*device, {0.0, 2.0, 0.0}, [&](const DeviceSample& sample) {
            return sample.connected && usb.force().y > 1.5;
        })) << device->health().text;
        usb.unplug();
        ASSERT_TRUE(tick_until(*device, {0.0, 2.0, 0.0},
                               [](const DeviceSample& sample) { return !sample.connected; }));
        ASSERT_TRUE(says(*device, "plug it in"));
        EXPECT_EQ(device->health().times_lost, times);
        usb.plug();
    }
    EXPECT_TRUE(tick_until(*device, Vec3(0.0), is_connected));
}

TEST(PlayedFalcon, TwoOfThemAreTwoHands) {
    shared::PlayedUsbSettings second;
    second.port = 2;
    PlayedUsb left({}), right(second);
    left.plug();
    right.plug();
    left.mean({-0.02, 0.0, 0.0});
    right.mean({0.02, 0.0, 0.0});
    const auto on_neither = falcon(with_firmware("usb1-9"));
    EXPECT_TRUE(says(*on_neither, "set 'device_id' to one of usb1-1, usb1-2"));
    const auto on_second = falcon(with_firmware("usb1-2"));
    EXPECT_TRUE(tick_until(*on_second, Vec3(0.0), [](const DeviceSample& sample) {
        return sample.connected && sample.position.x > 0.015;
    }));
    const auto on_first = falcon(with_firmware("usb1-1"));
    EXPECT_TRUE(tick_until(*on_first, Vec3(0.0), [](const DeviceSample& sample) {
        return sample.connected && sample.position.x < -0.015;
    }));
}

TEST(PlayedFalcon, SaysWhatIsMissing) {
    const auto nothing = falcon(FalconSettings{});
    EXPECT_TRUE(says(*nothing, "firmware"));
    const auto unplugged = falcon();
    EXPECT_TRUE(says(*unplugged, "no Falcon is plugged in"));
    PlayedUsb usb({});
    usb.set_in_use(true);
    usb.plug();
    EXPECT_TRUE(says(*unplugged, "in use"));
    usb.set_in_use(false);
    EXPECT_TRUE(tick_until(*unplugged, Vec3(0.0), is_connected));
}

TEST(PlayedFalcon, AWrongImageIsNoFalcon) {
    PlayedUsb usb({});
    usb.plug();
    FalconSettings settings = with_firmware();
    settings.firmware.back() ^= 1u;
    const auto device = falcon(settings);
    EXPECT_TRUE(says(*device, "firmware"));
    EXPECT_FALSE(device->read(0).connected);
}

}  // namespace
}  // namespace tactus::falcon_driver_test
