#include "devices/driver_device.hpp"

#include <utility>

#include "platform/clock.hpp"

namespace tactus {

namespace {

// A device that says nothing for so long has frozen (unit: nanoseconds).
constexpr Nanoseconds frozen_after = 20'000'000;

// Beyond this a thread that does not end is left behind (unit: nanoseconds).
constexpr Nanoseconds longest_end = 90'000'000;

std::atomic<void (*)(const std::string&)> tell_left_behind{nullptr};

}  // namespace

DriverDevice::DriverDevice(std::unique_ptr<Driver> driver)
    : work_(std::make_shared<DriverWork>(std::move(driver))) {
    DriverWork::start(work_);
}

DriverDevice::~DriverDevice() {
    const std::string id = work_->health().id;
    const bool has_ended = work_->end(longest_end);
    if (const auto tell = tell_left_behind.load(); !has_ended && tell != nullptr) {
        tell("The library of the device '" + id +
             "' does not return from a call. Its thread is left behind, without a force; restart the program "
             "before the device is used again.");
    }
}

void DriverDevice::when_left_behind(void (*told)(const std::string&)) {
    tell_left_behind = told;
}

DeviceSample DriverDevice::read(Nanoseconds) {
    work_->refresh(newest_);
    const Nanoseconds now = monotonic_now();
    next_.read_at = newest_.at;
    next_.looked_at = now;
    displayed_ = displayed_since(std::exchange(cuts_, work_->forces().cuts()));
    DeviceSample sample = newest_.sample;
    if (now - newest_.heard > frozen_after) {
        sample.connected = false;
        sample.velocity = Vec3(0.0);
    }
    return sample;
}

DisplayedForce DriverDevice::displayed_since(const ForceSlot::Cuts& before) {
    DisplayedForce displayed{work_->forces().displayed_to_loop().force, 0};
    for (std::size_t i = 0; i < before.size(); ++i) {
        displayed.cuts |= cuts_[i] != before[i] ? 1u << i : 0u;
    }
    return displayed;
}

// The tick's own time may be a virtual one; how long a force lives does not depend on it.
void DriverDevice::write(Nanoseconds, const Vec3& force) {
    next_.force = force;
    next_.written_at = monotonic_now();
    work_->forces().write(next_);
}

}  // namespace tactus
