// The way of forces from the loop to a driver, and the last stage before the device: it knows what is
// displayed. The newest force counts, for as long as the loop, the driver and the device go on (ForceLife);
// after any cut the force grows from nothing, as fast as the device's slew allows.
//
// The exchange runs in step with the loop: a reading is taken shortly before the loop looks for one, and the
// loop's write wakes the driver, which sends the force at once.
//
// Threads: write() and set_pace() belong to the haptic thread and to the owner before the first tick;
// due(), taken() and wait_for_force() to the watchdog; displayed(), cuts() and delays() to any one; the rest
// to the thread of the driver that sends forces, but heard(), which belongs to the one that reads.
#pragma once

#include <array>
#include <atomic>

#include "core/math/wrench.hpp"
#include "core/ports/device.hpp"
#include "core/safety/force_watch.hpp"
#include "platform/atomic_wait.hpp"
#include "platform/wake_signal.hpp"
#include "realtime/tick_statistics.hpp"
#include "realtime/triple_buffer.hpp"

namespace tactus {

class ForceSlot {
public:
    struct Displayed {
        Wrench wrench;
        Nanoseconds at = 0;  // on the steady clock; 0: nothing yet
    };
    using Cuts = std::array<std::uint64_t, force_cut_count>;  // by ForceCut

    // A pace that is not safe is given no force.
    void set_pace(const LoopPace& pace) {
        tick_.store(why_no_force(pace).empty() ? pace.period : 0, std::memory_order_release);
    }

    // --- haptic thread

    void write(const ForceCommand& command) {
        commands_.publish(command);
        written_.store(command.written_at, std::memory_order_release);
        written_signal_.wake();
    }

    // What the device was given last.
    Wrench displayed_to_loop() {
        to_loop_.refresh();
        return is_on_.load(std::memory_order_acquire) == 1 ? to_loop_.front() : Wrench{};
    }

    // --- driver: see above

    // The device is open, or open anew: its force begins at nothing. `is_paced`: it keeps a time of its own.
    void begin(const DeviceCapabilities& device, bool is_paced);
    // A reading that was asked for then has come.
    void heard(Nanoseconds read_at, Nanoseconds now);
    // Readings come so seldom that no force is given. Any thread.
    bool is_too_slow() const { return is_too_slow_.load(std::memory_order_relaxed); }

    // Returns when the loop has written what living() has not yet seen, one of the files is ready, or it is
    // `until`.
    void wait_for_write(Nanoseconds until, std::span<const WaitFile> files = {}) {
        written_signal_.wait_until(until, files, [this] { return is_written(); });
    }
    // The same, whatever the loop writes.
    void wait_for_files(Nanoseconds until, std::span<const WaitFile> files) {
        written_signal_.wait_until(until, files, [] { return false; });
    }
    bool is_written() const { return commands_.is_fresh(); }

    // What the device is given from now until end() at the longest (unit: newtons).
    Vec3 living(Nanoseconds now);
    // The torque that goes with it (unit: newton meters).
    const Vec3& torque() const { return displayed_.torque; }
    // Whether the loop was alive then, and the device.
    bool is_alive() const { return lives_; }
    // When what living() has returned ends, if nothing comes; 0: it is nothing, or has ended.
    Nanoseconds end() const { return end_; }
    // What living() has returned has been handed to the device.
    void given(Nanoseconds now);
    // From a reading until its force has been handed over: of a hundred, ninety-nine take no longer.
    Nanoseconds lag() const { return lag_.load(std::memory_order_relaxed); }
    // When the loop looks for a reading again, by the newest force that living() has seen; 0: unknown.
    Nanoseconds next_look() const;
    // When to take the next reading, so that it is there when the loop looks for it; 0: at once.
    Nanoseconds next_reading() const;
    // The device gives no force any more.
    void rest();

    // --- watchdog

    struct Due {
        Nanoseconds looked_at = 0;  // by the driver, last; 0: the device gives no force
        Nanoseconds at = 0;         // when the force must have been renewed or taken away
    };
    Due due() const;
    void wait_for_force() const { wait_while(is_on_, 0); }
    // The force is taken away past the driver, which begins anew.
    void taken() { is_taken_.store(true); }
    // For the owner: why, once for each silence.
    void note_taken(Nanoseconds now);
    // Wakes it, since no force will come.
    void end_wait();

    // --- owner

    // Ends wait_for_write() once.
    void wake_driver() { written_signal_.wake(); }

    Displayed displayed() {
        shown_.refresh();
        const bool is_on = is_on_.load(std::memory_order_acquire) == 1;
        return is_on ? shown_.front() : Displayed{Wrench{}, shown_.front().at};
    }
    Cuts cuts() const;
    // From a reading until its force has been handed to the device.
    const DurationHistogram& delays() const { return delays_; }

private:
    ForceLife life() const { return force_life(tick_.load(std::memory_order_acquire), exchange_); }
    void watch();
    void switch_on(std::int64_t on);
    void cut(ForceCut why);
    void aim_reading(const ForceCommand& command);
    void measure_period(Nanoseconds from_reading_to_reading);

    TripleBuffer<ForceCommand> commands_;
    TripleBuffer<Displayed> shown_;
    TripleBuffer<Wrench> to_loop_;  // of the same
    WakeSignal written_signal_;
    DurationHistogram delays_;
    std::atomic<Nanoseconds> tick_{1'000'000};  // 0: no force
    std::atomic<Nanoseconds> written_{0}, read_{0}, heard_{0}, looked_{0};
    std::atomic<std::int64_t> is_on_{0};  // 1: the device gives a force; -1: none will come
    std::atomic<bool> is_taken_{false}, is_too_slow_{false};
    std::array<std::atomic<std::uint64_t>, force_cut_count> cuts_{};

    // Of the driver: the period of the device's own, which is what it declares, or a longer one that is
    // measured; 0: it goes in step with the loop.
    std::atomic<Nanoseconds> exchange_{0};
    Nanoseconds declared_ = 0;
    Nanoseconds period_ = 0;                 // of a hundred readings, ninety-nine follow within that
    double slew_ = 0.0, torque_slew_ = 0.0;  // (units: newtons, newton meters per second)
    Wrench displayed_;                       // what living() has returned
    Wrench given_;                           // what of that the device has been given, last
    Nanoseconds given_at_ = 0;               // (on the steady clock)
    bool lives_ = false;
    bool returns_ = true;  // the force grows from nothing
    Nanoseconds end_ = 0;
    Nanoseconds measured_ = 0;  // the reading whose delay was counted last
    std::atomic<Nanoseconds> lag_{0};
    Nanoseconds lead_ = first_lead;  // of a reading before the loop looks for it

    static constexpr Nanoseconds first_lead = 200'000;
};

}  // namespace tactus
