// 3D Systems' Touch and Touch X (once SensAble's Phantom), by OpenHaptics' HDAPI.
//
// Threads: see driver.hpp. The library ticks by itself: what may be asked and said within its frame is only
// copied there, by serve(), on its own thread, which is the one that looks at the forces.
#pragma once

#include "devices/device_claim.hpp"
#include "devices/driver.hpp"
#include "devices/runtime_library.hpp"
#include "realtime/triple_buffer.hpp"

namespace tactus {

class OpenHapticsDriver final : public Driver {
public:
    // `id`: the name that the device has in the maker's own set-up; empty: its default device.
    explicit OpenHapticsDriver(std::string id) : wanted_(std::move(id)) {}
    ~OpenHapticsDriver() override { close(); }

    std::string open(const std::atomic<bool>& stop) override;
    void close() override;
    Exchange exchange(ForceSlot& forces, Nanoseconds until, DriverReading& reading) override;
    void let_go() override;
    bool is_paced() const override { return true; }
    DeviceCapabilities capabilities() const override { return capabilities_; }
    std::string id() const override { return id_; }
    std::string advice() const override;

private:
    struct Error {
        unsigned code;
        int internal;
        unsigned device;
    };
    struct Functions {
        unsigned (*init_device)(const char*) = nullptr;
        void (*disable_device)(unsigned) = nullptr;
        void (*make_current)(unsigned) = nullptr;
        void (*begin_frame)(unsigned) = nullptr;
        void (*end_frame)(unsigned) = nullptr;
        void (*enable)(unsigned) = nullptr;
        void (*get_doubles)(unsigned, double*) = nullptr;
        void (*get_integers)(unsigned, int*) = nullptr;
        const char* (*get_string)(unsigned) = nullptr;
        void (*set_doubles)(unsigned, const double*) = nullptr;
        void (*start_scheduler)() = nullptr;
        void (*stop_scheduler)() = nullptr;
        unsigned long (*schedule)(unsigned (*)(void*), void*, unsigned short) = nullptr;
        void (*unschedule)(unsigned long) = nullptr;
        Error (*get_error)() = nullptr;
        unsigned (*check_calibration)() = nullptr;
        void (*update_calibration)(unsigned) = nullptr;
    };
    struct Frame {
        DeviceSample sample;
        unsigned calibration = 0;
        Nanoseconds at = 0;  // the beginning of the frame
    };

    std::string load();
    std::string problem_of(const Error& error) const;
    void read_capabilities();
    std::string add_to_scheduler();
    bool gives_force() const;
    void start_scheduler();
    void stop_scheduler();
    static unsigned serve(void* driver);
    void serve_frame();

    std::string wanted_, id_;
    DeviceClaim claim_;
    RuntimeLibrary library_;
    Functions hd_;
    unsigned device_ = ~0u;
    unsigned long task_ = 0;
    DeviceCapabilities capabilities_;
    TripleBuffer<Frame> frames_;
    Frame served_;  // the scheduler's thread
    WakeSignal served_signal_;
    std::atomic<ForceSlot*> forces_{nullptr};
    std::atomic<bool> is_stopped_{false};  // by let_go()
    std::atomic<unsigned> fault_{0};       // that a frame has met
    unsigned calibration_ = 0;             // I/O thread
};

}  // namespace tactus
