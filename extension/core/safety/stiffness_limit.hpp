// How stiff a wall may be that a hand is pushed back from by a computer.
//
// A spring K that is read and held once in T, and whose force comes a time D late, lags behind the hand by at
// most the way of D + T/2 on average: what it gives back exceeds what it took by at most K (D + T/2) times
// the integral of v^2. A device that damps by b takes b times that integral. Damping B of the wall itself
// comes late as well and may push at the worst moment. So touch makes no energy while
//     K (D + T/2) + B <= b                      (Colgate and Schenkel 1997, with a delay)
// whatever the hand does.
#pragma once

#include <string>

namespace tactus {

struct LoopLag {
    double seconds = 0.001;  // T: of a tick, > 0
    double delay = 0.0;      // D: from a place to its force, besides the tick (unit: seconds), >= 0
};

struct Wall {
    double stiffness = 0.0;  // K (unit: newtons per meter), >= 0
    double damping = 0.0;    // B (unit: newton seconds per meter), >= 0
};

// What of a wall is safe. Damping takes a quarter of what the device has at most: stiffness is what is felt.
Wall safe_wall(const LoopLag& lag, double device_damping, const Wall& wanted);

// What of its damping a device needs to render this stiffness: K (D + T/2).
double damping_needed(double stiffness, const LoopLag& lag);

// "800 N/m is unsafe at 40 ms: 210 N/m used"; empty where nothing was taken away.
std::string explain_stiffness(double wanted, double used, const LoopLag& lag);

}  // namespace tactus
