// A driver on a thread of its own, as a device of the loop. It is looked for until it is there, and again when it has
// gone.
//
// Threads: read(), write() and capabilities() belong to the haptic thread and never wait: places and forces pass
// through slots of which the newest counts. The constructor, the destructor and health() belong to the owner; the
// destructor waits for the driver to close.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "devices/driver.hpp"

namespace tactus {

struct DriverHealth {
    enum class Phase { searching, waiting_for_user, running };
    Phase phase = Phase::searching;
    std::string text;              // what is wrong and what to do, or what the user has to do; else empty
    std::string id;                // of the device that is open
    std::uint64_t readings = 0;    // since it was opened
    std::uint64_t times_lost = 0;  // since the driver was made
};

class DriverDevice final : public Device {
public:
    explicit DriverDevice(std::unique_ptr<Driver> driver);
    ~DriverDevice() override;

    DeviceSample read(Nanoseconds now) override;
    void write(Nanoseconds now, const Vec3& force) override;
    DeviceCapabilities capabilities() const override { return newest_.capabilities; }

    DriverHealth health() const;

private:
    struct Reading {
        DeviceSample sample;
        DeviceCapabilities capabilities;
        Nanoseconds at = 0;
    };

    void run();
    void run_open();
    void tell(DriverHealth::Phase phase, std::string text);
    void rest(Nanoseconds span) const;

    std::unique_ptr<Driver> driver_;
    ForceSlot forces_;
    TripleBuffer<Reading> readings_;
    Reading newest_;  // haptic thread
    std::atomic<bool> stop_{false};
    std::atomic<std::uint64_t> count_{0};
    mutable std::mutex mutex_;  // of the owner and the I/O thread; the haptic thread never takes it
    DriverHealth health_;
    std::thread thread_;
};

}  // namespace tactus
