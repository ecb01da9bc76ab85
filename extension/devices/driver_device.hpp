// A driver on a thread of its own, as a device of the loop. It is looked for until it is there, and again
// when it has gone.
//
// Threads: read(), write() and capabilities() belong to the haptic thread and never wait: readings and forces
// pass through slots of which the newest counts. All else belongs to the owner. Two threads belong to the
// device (driver_work.hpp): one talks to the driver, the other, the watchdog, sleeps until a force has not
// been renewed in time and takes it away past whatever is stuck.
//
// The destructor waits for the driver to close, but no longer than for a tenth of a second: a thread that
// hangs in a vendor's library is left behind with all that it uses, and the owner is told.
#pragma once

#include <memory>
#include <string>

#include "devices/driver_work.hpp"

namespace tactus {

class DriverDevice final : public Device {
public:
    explicit DriverDevice(std::unique_ptr<Driver> driver);
    ~DriverDevice() override;

    void set_pace(const LoopPace& pace) override { work_->set_pace(pace); }
    DeviceSample read(Nanoseconds now) override;
    void write(Nanoseconds now, const Vec3& force) override;
    void twist(const Vec3& torque) override { next_.torque = torque; }
    std::optional<DisplayedForce> displayed() const override { return displayed_; }
    DeviceCapabilities capabilities() const override { return newest_.capabilities; }

    DriverHealth health() const { return work_->health(); }
    // From a reading until its force has been handed to the device, since the driver was made.
    const DurationHistogram& delays() const { return work_->forces().delays(); }

    // Is called by a destructor that leaves a thread behind, with a text for people; null: nothing is.
    static void when_left_behind(void (*told)(const std::string& text));

private:
    DisplayedForce displayed_since(const ForceSlot::Cuts& before);

    std::shared_ptr<DriverWork> work_;
    DriverWork::Reading newest_;  // haptic thread; likewise
    ForceCommand next_;           // what the next write() hands over
    DisplayedForce displayed_;
    ForceSlot::Cuts cuts_{};  // up to the last read()
};

}  // namespace tactus
