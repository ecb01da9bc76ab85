#include "devices/driver_device.hpp"

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

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

// Has to be shown once where it is.
class NeedsItsUser final : public Driver {
public:
    explicit NeedsItsUser(const std::atomic<bool>& is_shown) : is_shown_(is_shown) {}

    std::string open(const std::atomic<bool>&) override { return {}; }
    void close() override {}
    Exchange exchange(ForceSlot&, Nanoseconds, DriverReading& reading) override {
        SleepTimer().sleep_until(monotonic_now() + one_tick);
        reading.sample.connected = is_shown_;
        reading.at = monotonic_now();
        return Exchange::reading;
    }
    DeviceCapabilities capabilities() const override { return {}; }
    std::string id() const override { return "lost"; }
    std::string advice() const override { return is_shown_ ? "" : "show it where it is, once more"; }

private:
    const std::atomic<bool>& is_shown_;
};

// It said that it is running, where arguments are computed from the right.
TEST(DriverDevice, WaitsForItsUserUntilNothingIsLeftToDo) {
    std::atomic<bool> is_shown{false};
    DriverDevice device(std::make_unique<NeedsItsUser>(is_shown));
    device.set_pace({100 * one_tick, true});
    EXPECT_TRUE(wait_until([&] { return device.health().phase == DriverHealth::Phase::waiting_for_user; }));
    EXPECT_EQ(device.health().text, "show it where it is, once more");
    is_shown = true;
    EXPECT_TRUE(wait_until([&] { return device.health().phase == DriverHealth::Phase::running; }));
    EXPECT_NE(device.health().text.find("gives no force"), std::string::npos) << device.health().text;
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

// Where a vendor's library does not return from.
enum class Call { open, exchange, close, let_go, count };
constexpr const char* names_of_calls[] = {"open", "exchange", "close", "let_go"};

struct Hanging {
    Call call = Call::open;
    std::atomic<bool> has_hung{false}, may_go_on{false}, is_gone{false};
};

class HangsInACall final : public Driver {
public:
    explicit HangsInACall(std::shared_ptr<Hanging> hanging) : hanging_(std::move(hanging)) {}
    ~HangsInACall() override { hanging_->is_gone = true; }

    std::string open(const std::atomic<bool>&) override {
        hang_in(Call::open);
        return {};
    }
    void close() override { hang_in(Call::close); }
    void let_go() override { hang_in(Call::let_go); }
    // A force that has been looked at and is not renewed: the watchdog takes it away.
    Exchange exchange(ForceSlot& forces, Nanoseconds, DriverReading& reading) override {
        SleepTimer().sleep_until(monotonic_now() + one_tick);
        reading.sample.connected = true;
        reading.at = monotonic_now();
        if (forces.living(monotonic_now()) != Vec3(0.0)) {
            hang_in(Call::exchange);
            if (hanging_->call == Call::let_go) {
                wait_until([this] { return hanging_->has_hung.load(); });
            }
        }
        return Exchange::reading;
    }
    DeviceCapabilities capabilities() const override { return {}; }
    std::string id() const override { return "hanging"; }

private:
    void hang_in(Call call) {
        if (hanging_->call == call && !hanging_->may_go_on) {
            hanging_->has_hung = true;
            wait_until([this] { return hanging_->may_go_on.load(); });
        }
    }

    std::shared_ptr<Hanging> hanging_;
};

// Far from what a call that hangs would take here (longest_wait), and from a tenth of a second alike.
constexpr Nanoseconds soon = 2'000 * one_tick;

std::unique_ptr<DriverDevice> hanging_device(const std::shared_ptr<Hanging>& hanging) {
    auto device = std::make_unique<DriverDevice>(std::make_unique<HangsInACall>(hanging));
    if (hanging->call == Call::close) {
        tick_until(*device, {0.0, 1.0, 0.0}, [](const DeviceSample& sample) { return sample.connected; });
    } else {
        tick_until(*device, {0.0, 1.0, 0.0}, [&](const DeviceSample&) { return hanging->has_hung.load(); });
    }
    return device;
}

TEST(DriverDevice, ACallThatHangsKeepsItsOwnerForATenthOfASecondAtMost) {
    static std::string told;
    DriverDevice::when_left_behind([](const std::string& text) { told = text; });
    for (int call = 0; call < static_cast<int>(Call::count); ++call) {
        const auto hanging = std::make_shared<Hanging>();
        hanging->call = static_cast<Call>(call);
        auto device = hanging_device(hanging);
        told.clear();
        const Nanoseconds before = monotonic_now();
        device.reset();
        EXPECT_LT(monotonic_now() - before, soon) << names_of_calls[call];
        EXPECT_TRUE(hanging->has_hung) << names_of_calls[call];
        EXPECT_FALSE(hanging->is_gone) << names_of_calls[call] << ": its thread still uses it";
        EXPECT_NE(told.find("does not return from a call"), std::string::npos) << names_of_calls[call];
        hanging->may_go_on = true;
        EXPECT_TRUE(wait_until([&] { return hanging->is_gone.load(); })) << names_of_calls[call];
    }
    DriverDevice::when_left_behind(nullptr);
}

TEST(DriverDevice, AnOwnerOfDevicesOfWhichNoneReturnsLeavesThemAll) {
    std::vector<std::shared_ptr<Hanging>> hanging;
    std::vector<std::unique_ptr<DriverDevice>> devices;
    for (int call = 0; call < static_cast<int>(Call::count); ++call) {
        hanging.push_back(std::make_shared<Hanging>());
        hanging.back()->call = static_cast<Call>(call);
        devices.push_back(hanging_device(hanging.back()));
    }
    const Nanoseconds before = monotonic_now();
    devices.clear();
    EXPECT_LT(monotonic_now() - before, soon);
    for (const auto& one : hanging) {
        one->may_go_on = true;
        EXPECT_TRUE(wait_until([&] { return one->is_gone.load(); }));
    }
}

#if GTEST_HAS_DEATH_TEST

// The system ends the threads that hang with the process.
TEST(DriverDeviceDeathTest, AProgramQuitsWhileACallHangs) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    for (const Call call : {Call::open, Call::exchange, Call::close}) {
        const auto quit = [call] {
            DriverDevice::when_left_behind(
                [](const std::string& text) { std::fprintf(stderr, "%s\n", text.c_str()); });
            const auto hanging = std::make_shared<Hanging>();
            hanging->call = call;
            hanging_device(hanging).reset();
            std::exit(hanging->may_go_on ? 1 : 7);
        };
        const Nanoseconds before = monotonic_now();
        EXPECT_EXIT(quit(), ::testing::ExitedWithCode(7), "Its thread is left behind");
        EXPECT_LT(monotonic_now() - before, longest_wait / 2) << static_cast<int>(call);
    }
}

#endif

}  // namespace
}  // namespace tactus::driver_device_test
