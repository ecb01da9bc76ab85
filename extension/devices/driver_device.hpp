// A driver on a thread of its own, as a device of the loop. It is looked for until it is there, and again
// when it has gone.
//
// Threads: read(), write() and capabilities() belong to the haptic thread and never wait: places and forces
// pass through slots of which the newest counts. The constructor, the destructor and health() belong to the
// owner; the destructor waits for the driver to close. Two threads belong to the device: one talks to the
// driver, the other, the watchdog, sleeps until a force has not been renewed in time and takes it away past
// whoever is stuck.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "devices/driver.hpp"
#include "platform/realtime_thread.hpp"
#include "platform/thread.hpp"

namespace tactus {

struct DriverHealth {
    enum class Phase { searching, waiting_for_user, running };
    Phase phase = Phase::searching;
    std::string text;              // what is wrong and what to do, or what the user has to do; else empty
    std::string id;                // of the device that is open
    std::uint64_t readings = 0;    // since it was opened
    std::uint64_t times_lost = 0;  // since the driver was made
    std::uint64_t let_go = 0;      // how often the watchdog had to take a force away
};

class DriverDevice final : public Device {
public:
    explicit DriverDevice(std::unique_ptr<Driver> driver);
    ~DriverDevice() override;

    DeviceSample read(Nanoseconds now) override;
    void write(Nanoseconds now, const Vec3& force) override;
    void twist(const Vec3& torque) override { torque_ = torque; }
    DeviceCapabilities capabilities() const override { return newest_.capabilities; }

    DriverHealth health() const;

private:
    struct Reading {
        DeviceSample sample;
        DeviceCapabilities capabilities;
        Nanoseconds at = 0;
    };

    template <void (DriverDevice::*work)(), const RealtimeRequest& request>
    static void enter(void* device);
    void run();
    bool open(std::string& problem);
    void run_open();
    void close();
    void keep_watch();
    void tell(DriverHealth::Phase phase, std::string text);
    void rest(Nanoseconds span) const;

    std::unique_ptr<Driver> driver_;
    ForceSlot forces_;
    TripleBuffer<Reading> readings_;
    Reading newest_;    // haptic thread; likewise
    Vec3 torque_{0.0};  // of the next force (unit: newton meters)
    std::atomic<bool> stop_{false};
    std::atomic<std::uint64_t> count_{0};
    std::atomic<std::uint64_t> let_go_{0};
    mutable std::mutex health_mutex_;  // of the owner and the I/O thread; the haptic thread takes neither
    DriverHealth health_;
    std::mutex open_mutex_;  // of the two threads of the device: it is not closed under the watchdog
    bool is_open_ = false;
    Thread io_, watchdog_;
};

}  // namespace tactus
