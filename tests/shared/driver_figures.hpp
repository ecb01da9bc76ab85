// What a device does with the loop, and the loop with it, in figures; in real time.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "devices/driver_device.hpp"
#include "devices/hand_path.hpp"
#include "platform/realtime_thread.hpp"
#include "realtime/awake_processor.hpp"

namespace tactus::shared {

// The calling thread, for as long as this lives, as the loop of a world: its priority, and its processor,
// which is kept awake.
class AsLoop {
public:
    AsLoop();
    ~AsLoop();
    AsLoop(const AsLoop&) = delete;
    AsLoop& operator=(const AsLoop&) = delete;

private:
    RealtimeReport granted_;
    AwakeProcessor awake_;
};

// Sleeps in between; false: it has not come true.
bool wait_until(const std::function<bool()>& done, Nanoseconds at_most = 20'000'000'000);

// A loop of 1 kHz that asks for one force, upwards, and can be made to stop.
class Loop {
public:
    explicit Loop(DriverDevice& device) : device_(device), thread_([this] { run(); }) {}
    ~Loop();
    Loop(const Loop&) = delete;
    Loop& operator=(const Loop&) = delete;

    void ask(double newtons) { force_ = newtons; }
    // Only while the device's first button is held.
    void ask_by_button(double newtons);
    void stall(bool stalled) { stalled_ = stalled; }
    Nanoseconds last_sign() const { return last_; }
    bool is_connected() const { return connected_; }
    bool wait_for_hand() const;

private:
    void run();

    DriverDevice& device_;
    std::atomic<double> force_{0.0};
    std::atomic<bool> by_button_{false}, stalled_{false}, connected_{false}, end_{false};
    std::atomic<Nanoseconds> last_{0};
    std::thread thread_;
};

// Compute time of a session's tick at which 99 of 100 are done, with a hand behind this port, as a share of
// that with a scripted path over the same floor. `move` is told the time before each tick (unit: seconds).
double tick_over_path(Device& device, double seconds, const std::function<void(double)>& move);
// That path, and a place on it, for hands that can be led along it.
HandPath path_over_floor();
Vec3 way_over_floor(double seconds);

struct ExchangeFigures {
    double per_second = 0.0;
    double jitter_p99_ms = 0.0;  // of the time from one reading to the next, from its mean
};
ExchangeFigures exchanges(const DriverDevice& device, double seconds);

}  // namespace tactus::shared
