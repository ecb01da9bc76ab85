// Devices of Force Dimension (omega, delta, sigma, and the Falcon with their library), by their own library.
//
// Threads: see driver.hpp. The library's calls wait for the wire.
#pragma once

#include "devices/device_claim.hpp"
#include "devices/driver.hpp"
#include "devices/runtime_library.hpp"
#include "platform/sleep.hpp"

namespace tactus {

class ForceDimensionDriver final : public Driver {
public:
    // `id` as id() gives it; empty: the first that is free.
    explicit ForceDimensionDriver(std::string id) : wanted_(std::move(id)) {}
    ~ForceDimensionDriver() override { close(); }

    std::string open(const std::atomic<bool>& stop) override;
    void close() override;
    Exchange exchange(ForceSlot& forces, Nanoseconds until, DriverReading& reading) override;
    void let_go() override;
    DeviceCapabilities capabilities() const override;
    std::string id() const override { return id_; }
    std::string why_lost() const override { return why_lost_; }

private:
    struct Functions {
        int (*device_count)() = nullptr;
        int (*open_id)(char) = nullptr;
        int (*close)(char) = nullptr;
        int (*system_type)(char) = nullptr;
        const char* (*system_name)(char) = nullptr;
        int (*enable_force)(unsigned char, char) = nullptr;
        int (*get_position)(double*, double*, double*, char) = nullptr;
        int (*get_velocity)(double*, double*, double*, char) = nullptr;
        int (*set_force)(double, double, double, char) = nullptr;
        unsigned (*get_buttons)(char) = nullptr;
        int (*set_gravity_compensation)(int, char) = nullptr;
        int (*stop)(char) = nullptr;
        const char* (*last_error)() = nullptr;
    };
    // Of those with a wrist.
    struct WristFunctions {
        int (*has_wrist)(char) = nullptr;
        int (*has_active_wrist)(char) = nullptr;
        int (*get_frame)(double (*)[3], char) = nullptr;
        int (*set_all)(double, double, double, double, double, double, double, char) = nullptr;
    };

    std::string load();
    std::string open_one(int index);
    bool set(const Vec3& force, const Vec3& torque);
    bool send(ForceSlot& forces);
    void set_velocity_window();
    bool read(DeviceSample& sample);
    Exchange lost();

    std::string wanted_, id_, why_lost_;
    DeviceClaim claim_;
    RuntimeLibrary library_;
    Functions dhd_;
    WristFunctions wrist_;
    int (*set_watchdog_)(unsigned char, char) = nullptr;    // null: this version has none
    int (*set_velocity_window_)(int, int, char) = nullptr;  // null: this version has none
    SleepTimer timer_;
    char device_ = -1;
    bool is_open_ = false;
    int type_ = 0;
    bool turns_ = false, twists_ = false;  // it has a wrist; with motors
    bool is_watched_ = false;              // by its own firmware
    double velocity_smoothed_ = 0.0;       // see DeviceCapabilities
    Nanoseconds set_at_ = 0;               // the last force
    Nanoseconds read_at_ = 0;              // the last reading
    // By let_go(): counts its begins and its ends, and is odd while dhdStop() is at work.
    std::atomic<unsigned> stops_{0};
    unsigned enabled_after_ = 0;  // stops_ when the forces were switched on
};

}  // namespace tactus
