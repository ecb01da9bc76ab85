// Whether a device displays the force that the loop asks for, in real time: behind every phase between the
// loop and the device, quiet or beside busy processors.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "devices/driver_device.hpp"

namespace tactus::shared {

// One that stands in for a device, below the vendor's library.
struct WatchedDevice {
    std::function<std::unique_ptr<Driver>()> driver;
    std::function<Vec3()> force;             // that its motors give just now, in our axes (unit: newtons)
    std::function<double()> take_most_step;  // of the force, since the last call (unit: newtons)
};

struct DisplayedCase {
    int phases = 32;         // of a tick, at which the device is opened
    double seconds = 10.0;   // in contact, behind each of them
    double rate = 1000.0;    // of the loop (unit: hertz)
    double newtons = 3.0;    // that are asked for
    bool is_loaded = false;  // two more threads never rest
    bool is_cut = false;     // the loop stops for 3 and 30 ms in each phase
};

struct DisplayedFigures {
    int opened = 0;                       // phases in which the device was there
    double over_asked_min = 1.0;          // mean displayed force over the asked one, of the worst phase
    std::uint64_t let_go_while_even = 0;  // cuts in even ticks
    std::uint64_t cuts = 0;
    // Only even ones are judged (shared/even_ticks.hpp).
    std::uint64_t ticks = 0, even_ticks = 0;
    double delay_p50_us = 0.0, delay_p99_us = 0.0;  // from a reading until its force was handed over
    double write_p50_us = 0.0, write_p99_us = 0.0;  // that Device::write() takes of the loop's time
    double return_step_max = 0.0;                   // of the force after the loop has stopped (unit: newtons)

    double even_share() const {
        return ticks > 0 ? static_cast<double>(even_ticks) / static_cast<double>(ticks) : 0.0;
    }
};

// Why the device gives no force at that rate of the loop (unit: hertz), as it says itself; empty: it gives
// one.
std::string refusal(const WatchedDevice& watched, double rate);

DisplayedFigures play_displayed(const WatchedDevice& watched, const DisplayedCase& c);

}  // namespace tactus::shared
