// What a driver's two threads do, and all that they use: it outlives the device where one of them hangs.
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
    Wrench displayed;              // what the device was given last, in its own frame
    ForceSlot::Cuts cuts{};  // of forces that the loop asked for, by ForceCut, since the driver was made
};

class DriverWork {
public:
    struct Reading {
        DeviceSample sample;
        DeviceCapabilities capabilities;
        Nanoseconds at = 0;     // when it was taken (on the steady clock)
        Nanoseconds heard = 0;  // when it had come
    };

    explicit DriverWork(std::unique_ptr<Driver> driver) : driver_(std::move(driver)) {}
    DriverWork(const DriverWork&) = delete;
    DriverWork& operator=(const DriverWork&) = delete;

    // Owner. The threads hold what they work on until they end.
    static void start(const std::shared_ptr<DriverWork>& work);
    // False: one of the threads has not ended within `at_most`, and goes on by itself.
    bool end(Nanoseconds at_most);

    void set_pace(const LoopPace& pace);
    DriverHealth health();
    ForceSlot& forces() { return forces_; }

    // Haptic thread.
    bool refresh(Reading& newest);

private:
    template <void (DriverWork::*work)(), const RealtimeRequest& request>
    static void enter(void* shared);
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
    std::atomic<bool> stop_{false}, end_watch_{false};
    std::atomic<int> at_work_{0};  // threads
    std::atomic<std::uint64_t> count_{0};
    std::atomic<std::uint64_t> let_go_{0};
    std::mutex health_mutex_;  // of the owner and the I/O thread; the haptic thread takes neither
    DriverHealth health_;
    std::string no_force_;   // why there is none at the loop's pace
    std::mutex open_mutex_;  // of the two threads: the device is not closed under the watchdog
    bool is_open_ = false;
    Thread io_, watchdog_;
};

}  // namespace tactus
