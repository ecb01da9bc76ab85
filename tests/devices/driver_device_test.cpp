#include "devices/driver_device.hpp"

#include <atomic>
#include <memory>

#include "shared/driven_device.hpp"
#include "support/process.hpp"

namespace tactus {
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
    Exchange exchange(ForceSlot& forces, Nanoseconds, DeviceSample& sample) override {
        SleepTimer().sleep_until(monotonic_now() + one_tick);
        sample.connected = true;
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

}  // namespace
}  // namespace tactus
