// What the Falcon's driver does with a played one, in figures; in real time.
#pragma once

#include "shared/driver_figures.hpp"

namespace tactus::shared {

// Of so many start-ups with this share of transfers failing: those after which the hand was there.
int starts_ok(int starts, double failing);

// Sustained, in so many seconds.
ExchangeFigures falcon_exchanges(double seconds);

// From a button at the device to the force that the loop takes away for it, back at the device.
struct RoundTrips {
    double p50_ms = 0.0;
    double p99_ms = 0.0;
};
RoundTrips falcon_round_trips(int times);

// Of so many times that the cable was pulled under force and put back: those after which the force was there
// again.
int replugs_ok(int replugs);

// See tick_over_path: with the Falcon's driver.
double falcon_tick_over_path(double seconds);

// From the last sign of life to the packet that takes the force away.
struct StallFigures {
    int stalls = 0;
    int ok = 0;  // within 2 ms
    double max_ms = 0.0;
    double p99_ms = 0.0;
};

// The loop that writes forces stops.
StallFigures stall_loop(int stalls);
// The thread that talks to the device stops, in whatever it was just doing.
StallFigures stall_driver(int stalls);

}  // namespace tactus::shared
