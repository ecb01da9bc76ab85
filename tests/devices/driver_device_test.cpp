#include "devices/driver_device.hpp"

#include <atomic>
#include <memory>

#include "shared/driven_device.hpp"
#include "support/process.hpp"

namespace tactus::driver_device_test {
namespace {

// Gone under a force, and slow to close.
class GoesUnderForce final : public Driver {
public:
    static constexpr Nanoseconds closing = 200 * one_tick;

    explicit GoesUnderForce(std::atomic<Nanoseconds>& used) : used_(used) {}

    std::string open(const std::atomic<bool>&) override { return {}; }
    void close() override {
        const Nanoseconds before = testing::process_time();
        SleepTimer().sleep_until(monotonic_now() + closing);
        used_ = testing::process_time() - before;
    }
    Exchange exchange(ForceSlot& forces, Nanoseconds, DriverReading& reading) override {
        SleepTimer().sleep_until(monotonic_now() + one_tick);
        reading.sample.connected = true;
        reading.at = monotonic_now();
        return forces.living(monotonic_now()) == Vec3(0.0) ? Exchange::reading : Exchange::lost;
    }
    DeviceCapabilities capabilities() const override { return {}; }
    std::string id() const override { return "slow"; }

private:
    std::atomic<Nanoseconds>& used_;
};

// One that looks again and again has the processor of the loop, before the loop.
TEST(DriverDevice, TheWatchdogSleepsWhileADeviceThatHasGoneIsClosed) {
    std::atomic<Nanoseconds> used{0};
    DriverDevice device(std::make_unique<GoesUnderForce>(used));
    tick_until(device, {0.0, 1.0, 0.0}, [&](const DeviceSample&) { return used != 0; });
    EXPECT_LT(used, GoesUnderForce::closing / 2);
}

// What a device feels, whose driver is so late with a force that the watchdog has taken it away already, and
// then hangs.
struct LateForce {
    std::atomic<bool> is_given{false}, has_hung{false}, may_go_on{false};
    std::atomic<int> taken_away{0};
};

class GivesLateAndHangs final : public Driver {
public:
    explicit GivesLateAndHangs(LateForce& force) : force_(force) {}

    std::string open(const std::atomic<bool>&) override { return {}; }
    void close() override {}
    void let_go() override {
        force_.is_given = false;
        ++force_.taken_away;
    }
    Exchange exchange(ForceSlot& forces, Nanoseconds, DriverReading& reading) override {
        reading.sample.connected = true;
        reading.at = monotonic_now();
        if (force_.has_hung && !force_.may_go_on) {
            wait_until([this] { return force_.may_go_on.load(); });
        } else if (forces.living(monotonic_now()) != Vec3(0.0) && !force_.has_hung) {
            wait_until([this] { return force_.taken_away > 0; });
            force_.is_given = true;
            force_.has_hung = true;
        }
        SleepTimer().sleep_until(monotonic_now() + one_tick);
        return Exchange::reading;
    }
    DeviceCapabilities capabilities() const override { return {}; }
    std::string id() const override { return "late"; }

private:
    LateForce& force_;
};

TEST(DriverDevice, AForceThatComesAfterTheWatchdogIsTakenAwayAgain) {
    LateForce force;
    DriverDevice device(std::make_unique<GivesLateAndHangs>(force));
    tick_until(device, {0.0, 1.0, 0.0}, [&](const DeviceSample&) { return force.has_hung.load(); });
    EXPECT_TRUE(wait_until([&] { return !force.is_given; }));
    EXPECT_EQ(device.health().let_go, 1u) << "one silence is counted once";
    force.may_go_on = true;
}

}  // namespace
}  // namespace tactus::driver_device_test
