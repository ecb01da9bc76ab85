// Drivers by vendors' libraries, against stand-ins with the same C symbols. Time is real; nobody looks at how
// much.
#include <gtest/gtest.h>

#include <functional>
#include <glm/geometric.hpp>

#include "devices/vendors/force_dimension_driver.hpp"
#include "devices/vendors/openhaptics_driver.hpp"
#include "shared/driven_device.hpp"
#include "stand_ins/stand_ins.hpp"

namespace tactus::vendor_drivers_linux_test {
namespace {

template <typename StandIn>
StandIn& stand_in(std::initializer_list<const char*> names, const char* function) {
    static RuntimeLibrary library;
    StandIn* (*get)() = nullptr;
    EXPECT_TRUE(library.load(names, function) && library.find({{function, get}}));
    return *get();
}
stand_ins::ForceDimension& dhd() {
    return stand_in<stand_ins::ForceDimension>({"libdhd.so"}, "stand_in_force_dimension");
}
stand_ins::OpenHaptics& hd() {
    return stand_in<stand_ins::OpenHaptics>({"libHD.so"}, "stand_in_openhaptics");
}

bool is_connected(const DeviceSample& sample) {
    return sample.connected;
}

void put(std::atomic<double> (&values)[3], double x, double y, double z) {
    values[0] = x;
    values[1] = y;
    values[2] = z;
}
Vec3 values_of(const std::atomic<double> (&values)[3]) {
    return {values[0].load(), values[1].load(), values[2].load()};
}

TEST(ForceDimension, PlacesAndForcesAreInOurAxes) {
    put(dhd().position, 0.01, 0.02, 0.03);
    DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
    EXPECT_TRUE(tick_until(device, {1.0, 2.0, 3.0}, [](const DeviceSample& sample) {
        return sample.connected && values_of(dhd().force) == Vec3(3.0, 1.0, 2.0);
    }));
    EXPECT_EQ(device.read(0).position, Vec3(0.02, 0.03, 0.01));
    EXPECT_EQ(device.health().id, "omega.3-0");
    EXPECT_EQ(dhd().wrong_calls, 0);
}

TEST(ForceDimension, AWristIsTurnedAndTwistedInOurAxes) {
    dhd().has_wrist = true;
    DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
    device.twist({0.01, 0.02, 0.03});
    EXPECT_TRUE(tick_until(device, {1.0, 2.0, 3.0}, [](const DeviceSample& sample) {
        return sample.connected && values_of(dhd().torque) == Vec3(0.03, 0.01, 0.02) &&
               values_of(dhd().force) == Vec3(3.0, 1.0, 2.0);
    }));
    // About their x, which is our z: our x goes to our y.
    EXPECT_LT(glm::distance(device.read(0).rotation * Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0)), 1e-12);
    EXPECT_TRUE(device.capabilities().rotates);
    EXPECT_GT(device.capabilities().max_torque, 0.0);
    EXPECT_TRUE(wait_until([] { return values_of(dhd().torque) == Vec3(0.0); })) << "the loop has stopped";
    EXPECT_EQ(dhd().wrong_calls, 0);
    dhd().has_wrist = false;
}

// Where the whole process is frozen, nobody but the device can.
TEST(ForceDimension, ItsFirmwareLetsGoAfterTwoMilliseconds) {
    DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
    ASSERT_TRUE(tick_until(device, Vec3(0.0), is_connected));
    EXPECT_EQ(dhd().watchdog, 16);
    EXPECT_EQ(device.capabilities().max_torque, 0.0);
}

// By the driver itself, or by the watchdog where the driver is late, too.
TEST(ForceDimension, AStalledLoopLetsTheHandGo) {
    DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
    ASSERT_TRUE(
        tick_until(device, {1.0, 0.0, 0.0}, [](const auto&) { return values_of(dhd().force).y == 1.0; }));
    EXPECT_TRUE(wait_until([] { return values_of(dhd().force) == Vec3(0.0); }));
}

// The library hangs under a force until the watchdog has stopped the device. On a busy machine the driver may
// have ended that force by itself just before, which leaves nothing to stop: then it is given anew.
bool is_stopped_under(DriverDevice& device, const Vec3& asked) {
    const auto is_given = [](const auto&) { return values_of(dhd().force) != Vec3(0.0); };
    const auto is_free = [](const auto&) { return values_of(dhd().force) == Vec3(0.0); };
    for (int i = 0; i < 5 && tick_until(device, asked, is_given); ++i) {
        dhd().hangs = true;
        if (tick_until(device, asked, is_free) && dhd().braked && !dhd().forces_on) {
            return true;
        }
        dhd().hangs = false;
    }
    return false;
}

TEST(ForceDimension, ALibraryThatHangsIsStoppedByTheWatchdog) {
    DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
    ASSERT_TRUE(
        tick_until(device, {1.0, 0.0, 0.0}, [](const auto&) { return values_of(dhd().force).y == 1.0; }));
    EXPECT_TRUE(is_stopped_under(device, {1.0, 0.0, 0.0}));
    dhd().hangs = false;
    EXPECT_TRUE(
        tick_until(device, {1.0, 0.0, 0.0}, [](const auto&) { return values_of(dhd().force).y == 1.0; }));
    EXPECT_GE(device.health().let_go, 1u);
}

// dhdStop() switches the forces off, so that they have to be switched on again, and the force grows from
// nothing.
TEST(ForceDimension, AfterTheWatchdogItsForceIsSwitchedOnAndGrows) {
    DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
    const Vec3 asked(0.0, 0.0, 8.0);
    const auto is_given = [](const auto&) { return values_of(dhd().force).x == 8.0; };
    ASSERT_TRUE(tick_until(device, asked, is_given));
    dhd().wrong_calls = 0;
    ASSERT_TRUE(is_stopped_under(device, asked));
    dhd().most_step = 0.0;
    dhd().hangs = false;
    ASSERT_TRUE(tick_until(device, asked, is_given));
    EXPECT_LE(dhd().most_step, 4.0 + 1e-9) << "4 N/ms";
    EXPECT_EQ(dhd().wrong_calls, 0);
    EXPECT_TRUE(wait_until([&] { return device.health().displayed.force == Vec3(0.0); }));
}

// The watchdog stopped it between the look and the force: it was taken for a device that has gone.
TEST(ForceDimension, AStopBetweenALookAndItsForceIsNoLoss) {
    dhd().has_wrist = true;
    for (int round = 0; round < 3; ++round) {
        DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
        const Vec3 asked(8.0, 0.0, 0.0);
        const auto is_given = [](const auto&) { return values_of(dhd().force).y == 8.0; };
        ASSERT_TRUE(tick_until(device, asked, is_given));
        dhd().wrong_calls = 0;
        dhd().most_step = 0.0;
        dhd().overtaken = "dhdSetForce";
        ASSERT_TRUE(tick_until(device, asked, [](const auto&) { return dhd().overtaken == nullptr; }));
        EXPECT_TRUE(tick_until(device, asked, is_given));
        EXPECT_LE(dhd().most_step, 4.0 + 1e-9) << "4 N/ms";
        EXPECT_EQ(device.health().times_lost, 0u);
        EXPECT_EQ(dhd().wrong_calls, 0);
    }
    dhd().has_wrist = false;
}

// A second stop came while the forces were switched on after the first: they stayed on.
TEST(ForceDimension, AStopWhileForcesAreSwitchedOnCounts) {
    DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
    const Vec3 asked(8.0, 0.0, 0.0);
    const auto is_given = [](const auto&) { return values_of(dhd().force).y == 8.0; };
    ASSERT_TRUE(tick_until(device, asked, is_given));
    dhd().wrong_calls = 0;
    dhd().most_step = 0.0;
    ASSERT_TRUE(is_stopped_under(device, asked));
    dhd().stale_forces = 0;
    dhd().overtaken = "dhdEnableForce";
    dhd().hangs = false;
    ASSERT_TRUE(tick_until(device, asked, [](const auto&) { return dhd().overtaken == nullptr; }));
    EXPECT_TRUE(tick_until(device, asked, is_given));
    EXPECT_LE(dhd().stale_forces, 1) << "which is taken away at once";
    EXPECT_FALSE(dhd().is_stale);
    EXPECT_LE(dhd().most_step, 4.0 + 1e-9) << "4 N/ms";
    EXPECT_EQ(device.health().times_lost, 0u);
    EXPECT_EQ(dhd().wrong_calls, 0);
}

// The library's own window is 20 ms, and a hand that stops has its velocity for as long.
TEST(ForceDimension, TheWindowOfItsVelocityIsSetAndDeclared) {
    {
        DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
        ASSERT_TRUE(tick_until(device, Vec3(0.0), is_connected));
        EXPECT_EQ(dhd().velocity_window, 2);
        EXPECT_EQ(device.capabilities().velocity_smoothed, 0.001) << "half of it, to first order";
    }
    dhd().fails = "dhdConfigLinearVelocity";
    DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
    ASSERT_TRUE(tick_until(device, Vec3(0.0), is_connected));
    EXPECT_EQ(dhd().velocity_window, 20);
    EXPECT_EQ(device.capabilities().velocity_smoothed, 0.01);
    dhd().fails = nullptr;
}

TEST(ForceDimension, ALoopThatIsTooSlowIsGivenNoForceAndAReason) {
    DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
    device.set_pace({10 * one_tick, true});
    dhd().most_step = 0.0;
    ASSERT_TRUE(tick_until(device, {1.0, 0.0, 0.0}, is_connected));
    ASSERT_TRUE(
        tick_until(device, {1.0, 0.0, 0.0}, [&](const auto&) { return device.health().readings > 20; }));
    EXPECT_EQ(dhd().most_step, 0.0);
    EXPECT_NE(device.health().text.find("'tick_rate'"), std::string::npos) << device.health().text;
    device.set_pace({one_tick, true});
    EXPECT_TRUE(
        tick_until(device, {1.0, 0.0, 0.0}, [](const auto&) { return values_of(dhd().force).y == 1.0; }));
    EXPECT_EQ(device.health().text, "");
}

// Before the loop's first tick, too: its reading was due at a time below zero, for which no kernel waits.
TEST(ForceDimension, ALoopThatIsTooSlowHasTheDeviceBeforeItsFirstTick) {
    DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
    device.set_pace({10 * one_tick, true});
    EXPECT_TRUE(wait_until([&] { return device.health().readings > 5; }));
    EXPECT_NE(device.health().text.find("'tick_rate'"), std::string::npos) << device.health().text;
}

// The owner waits no longer than for a tenth of a second; what the thread uses lives on.
TEST(ForceDimension, ALibraryThatHangsIsLeftBehindAndThatIsSaid) {
    static std::string told;
    DriverDevice::when_left_behind([](const std::string& text) { told = text; });
    {
        DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
        ASSERT_TRUE(
            tick_until(device, {1.0, 0.0, 0.0}, [](const auto&) { return values_of(dhd().force).y == 1.0; }));
        dhd().hangs = true;
        ASSERT_TRUE(tick_until(device, {1.0, 0.0, 0.0},
                               [](const auto&) { return values_of(dhd().force) == Vec3(0.0); }));
        // Only a destructor that returns lets the library go on.
    }
    EXPECT_NE(told.find("omega.3-0"), std::string::npos) << told;
    DriverDevice::when_left_behind(nullptr);
    dhd().hangs = false;
    EXPECT_TRUE(wait_until([] { return !dhd().is_open; })) << "then it closes";
    EXPECT_EQ(values_of(dhd().force), Vec3(0.0));
}

TEST(ForceDimension, ComesBackAfterItWasUnplugged) {
    DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
    ASSERT_TRUE(tick_until(device, Vec3(0.0), is_connected));
    dhd().unplugged = true;
    ASSERT_TRUE(tick_until(device, Vec3(0.0), [](const DeviceSample& sample) { return !sample.connected; }));
    EXPECT_TRUE(wait_until([&] { return device.health().text.find("plug") != std::string::npos; }));
    dhd().unplugged = false;
    EXPECT_TRUE(tick_until(device, Vec3(0.0), is_connected));
}

// Whichever call it is: no force, what the library says is said, and it goes on by itself.
TEST(ForceDimension, ALibraryOfWhichOneCallFailsGivesNoForce) {
    dhd().has_wrist = true;
    for (const char* function :
         {"dhdGetPosition", "dhdGetLinearVelocity", "dhdGetOrientationFrame", "dhdSetForce"}) {
        DriverDevice device(std::make_unique<ForceDimensionDriver>(""));
        const auto is_given = [](const auto&) { return values_of(dhd().force).y == 1.0; };
        ASSERT_TRUE(tick_until(device, {1.0, 0.0, 0.0}, is_given)) << function;
        dhd().fails = function;
        EXPECT_TRUE(tick_until(device, {1.0, 0.0, 0.0}, [&](const DeviceSample& sample) {
            return !sample.connected && values_of(dhd().force) == Vec3(0.0) &&
                   device.health().text.find("communication error") != std::string::npos;
        })) << function;
        dhd().fails = nullptr;
        EXPECT_TRUE(tick_until(device, {1.0, 0.0, 0.0}, is_given)) << function;
    }
    dhd().has_wrist = false;
}

TEST(ForceDimension, OneDeviceIsHadByOneDriver) {
    dhd().wrong_calls = 0;
    auto one = std::make_unique<DriverDevice>(std::make_unique<ForceDimensionDriver>(""));
    ASSERT_TRUE(tick_until(*one, Vec3(0.0), is_connected));
    DriverDevice two(std::make_unique<ForceDimensionDriver>(""));
    EXPECT_TRUE(
        wait_until([&] { return two.health().text.find("another HapticDevice") != std::string::npos; }));
    EXPECT_TRUE(
        tick_until(*one, {1.0, 0.0, 0.0}, [](const auto&) { return values_of(dhd().force).y == 1.0; }));
    EXPECT_EQ(dhd().wrong_calls, 0);
    one.reset();
    EXPECT_TRUE(tick_until(two, Vec3(0.0), is_connected)) << "and the other one when it is free";
}

TEST(ForceDimension, ADeviceInUseAndAnotherOneAreSaid) {
    dhd().in_use = true;
    DriverDevice taken(std::make_unique<ForceDimensionDriver>(""));
    EXPECT_TRUE(wait_until([&] { return taken.health().text.find("already opened") != std::string::npos; }));
    dhd().in_use = false;
    EXPECT_TRUE(tick_until(taken, Vec3(0.0), is_connected));
}

TEST(OpenHaptics, PlacesTurnsAndForcesComeThroughItsFrames) {
    put(hd().position, 10.0, 20.0, 30.0);
    hd().buttons = 2;
    DriverDevice device(std::make_unique<OpenHapticsDriver>(""));
    EXPECT_TRUE(tick_until(device, {0.5, 1.0, 1.5}, [](const DeviceSample& sample) {
        return sample.connected && values_of(hd().force) == Vec3(0.5, 1.0, 1.5);
    }));
    const DeviceSample sample = device.read(0);
    EXPECT_LT(glm::distance(sample.position, Vec3(0.01, 0.02, 0.03)), 1e-12);
    EXPECT_LT(glm::distance(sample.rotation * Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0)), 1e-12);
    EXPECT_EQ(sample.buttons, 2u);
    EXPECT_EQ(device.capabilities().max_force, 3.3);
    EXPECT_NEAR(device.capabilities().radius, 0.035, 1e-12);
    EXPECT_EQ(device.health().id, "Touch 0815");
    EXPECT_EQ(hd().wrong_calls, 0);
}

TEST(OpenHaptics, SixMotorsGiveATorque) {
    hd().has_six_motors = true;
    DriverDevice device(std::make_unique<OpenHapticsDriver>(""));
    device.twist({0.01, 0.02, 0.03});
    // A torque may arrive before the first reading does, with which the device says what it can.
    EXPECT_TRUE(tick_until(device, {0.5, 1.0, 1.5}, [](const DeviceSample& sample) {
        return sample.connected && glm::distance(values_of(hd().torque), Vec3(10.0, 20.0, 30.0)) < 1e-9;
    }));
    EXPECT_NEAR(device.capabilities().max_torque, 0.188, 1e-12);
    EXPECT_TRUE(wait_until([] { return values_of(hd().torque) == Vec3(0.0); })) << "the loop has stopped";
    hd().has_six_motors = false;
    EXPECT_EQ(hd().wrong_calls, 0);
}

TEST(OpenHaptics, AStalledLoopLetsTheHandGo) {
    DriverDevice device(std::make_unique<OpenHapticsDriver>(""));
    ASSERT_TRUE(
        tick_until(device, {1.0, 0.0, 0.0}, [](const auto&) { return values_of(hd().force).x == 1.0; }));
    EXPECT_TRUE(wait_until([] { return values_of(hd().force) == Vec3(0.0); }));
}

TEST(OpenHaptics, AServoThreadThatHangsIsStoppedByTheWatchdog) {
    DriverDevice device(std::make_unique<OpenHapticsDriver>(""));
    ASSERT_TRUE(
        tick_until(device, {1.0, 0.0, 0.0}, [](const auto&) { return values_of(hd().force).x == 1.0; }));
    hd().hangs = true;
    EXPECT_TRUE(wait_until([] { return values_of(hd().force) == Vec3(0.0); }));
    hd().hangs = false;
    EXPECT_TRUE(
        tick_until(device, {1.0, 0.0, 0.0}, [](const auto&) { return values_of(hd().force).x == 1.0; }));
    EXPECT_EQ(device.health().times_lost, 0u) << "its scheduler was started again, and not the device";
}

// The watchdog stopped it again, each time before it had given a force.
TEST(OpenHaptics, ASchedulerThatStartsSlowlyStartsAllTheSame) {
    const auto is_given = [](const auto&) { return values_of(hd().force).x == 1.0; };
    for (const int milliseconds : {2, 20, 200}) {
        hd().start_time = milliseconds;
        DriverDevice device(std::make_unique<OpenHapticsDriver>(""));
        ASSERT_TRUE(tick_until(device, {1.0, 0.0, 0.0}, is_given));
        hd().hangs = true;
        EXPECT_TRUE(wait_until([] { return values_of(hd().force) == Vec3(0.0); }));
        hd().hangs = false;
        EXPECT_TRUE(tick_until(device, {1.0, 0.0, 0.0}, is_given)) << milliseconds << " ms";
        EXPECT_EQ(device.health().times_lost, 0u) << milliseconds << " ms";
    }
    hd().start_time = 0;
}

// The library has one scheduler, which is stopped where a device comes or goes.
TEST(OpenHaptics, TwoDevicesShareTheScheduler) {
    hd().wrong_calls = 0;
    DriverDevice one(std::make_unique<OpenHapticsDriver>(""));
    ASSERT_TRUE(tick_until(one, {1.0, 0.0, 0.0}, [](const auto&) { return values_of(hd().force).x == 1.0; }));
    {
        DriverDevice two(std::make_unique<OpenHapticsDriver>("Second"));
        const auto both = [](const auto&) {
            return values_of(hd().force).x == 1.0 && values_of(hd().second_force).x == 1.0;
        };
        EXPECT_TRUE(tick_until(two, {1.0, 0.0, 0.0}, [&](const DeviceSample& sample) {
            one.read(0);
            // The second one is looked for while the first gives no force.
            one.write(0, sample.connected ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0));
            return both(sample);
        }));
    }
    EXPECT_EQ(values_of(hd().second_force), Vec3(0.0));
    EXPECT_TRUE(tick_until(one, {1.0, 0.0, 0.0}, [](const auto&) { return values_of(hd().force).x == 1.0; }));
    EXPECT_EQ(one.health().times_lost, 0u);
    EXPECT_EQ(hd().wrong_calls, 0);
}

// To look for one stops the scheduler, and with it the force of the other.
TEST(OpenHaptics, AMissingDeviceIsNotLookedForWhileAnotherGivesAForce) {
    DriverDevice one(std::make_unique<OpenHapticsDriver>(""));
    const auto is_given = [](const auto&) { return values_of(hd().force).x == 1.0; };
    ASSERT_TRUE(tick_until(one, {1.0, 0.0, 0.0}, is_given));
    DriverDevice missing(std::make_unique<OpenHapticsDriver>("Missing"));
    const auto says = [&](const char* words) {
        return missing.health().text.find(words) != std::string::npos;
    };
    // A tick that is late takes the force away, too: then the device is looked for.
    int before = hd().stops;
    EXPECT_TRUE(tick_until(one, {1.0, 0.0, 0.0}, [&](const auto&) { return says("others give no force"); }));
    const Nanoseconds end = monotonic_now() + 500 * one_tick;
    const std::uint64_t cuts = one.health().let_go;
    before = hd().stops;
    tick_until(one, {1.0, 0.0, 0.0}, [end](const auto&) { return monotonic_now() > end; });
    if (one.health().cuts == ForceSlot::Cuts{} && one.health().let_go == cuts) {
        EXPECT_EQ(hd().stops, before);
    }
    EXPECT_TRUE(tick_until(one, Vec3(0.0), [&](const auto&) { return says("'Missing'"); }));
    EXPECT_TRUE(tick_until(one, {1.0, 0.0, 0.0}, is_given));
}

TEST(OpenHaptics, OneDeviceIsHadByOneDriver) {
    hd().wrong_calls = 0;
    DriverDevice one(std::make_unique<OpenHapticsDriver>(""));
    ASSERT_TRUE(tick_until(one, {1.0, 0.0, 0.0}, [](const auto&) { return values_of(hd().force).x == 1.0; }));
    DriverDevice two(std::make_unique<OpenHapticsDriver>(""));
    EXPECT_TRUE(
        wait_until([&] { return two.health().text.find("another HapticDevice") != std::string::npos; }));
    EXPECT_EQ(hd().wrong_calls, 0);
}

TEST(OpenHaptics, SaysThatItsStylusBelongsIntoTheInkwell) {
    hd().calibration = 0x5002;
    DriverDevice device(std::make_unique<OpenHapticsDriver>(""));
    EXPECT_TRUE(wait_until([&] { return device.health().text.find("inkwell") != std::string::npos; }));
    EXPECT_FALSE(device.read(0).connected);
    hd().calibration = 0x5000;
    EXPECT_TRUE(tick_until(device, Vec3(0.0), is_connected));
}

TEST(OpenHaptics, ADeviceThatIsNotThereIsSaidAndFoundLater) {
    hd().unplugged = true;
    DriverDevice device(std::make_unique<OpenHapticsDriver>("Left"));
    EXPECT_TRUE(wait_until([&] { return device.health().text.find("'Left'") != std::string::npos; }));
    hd().unplugged = false;
    EXPECT_TRUE(tick_until(device, Vec3(0.0), is_connected));
    EXPECT_EQ(device.health().id, "Left");
}

}  // namespace
}  // namespace tactus::vendor_drivers_linux_test
