// Hard cases by the number: each seed makes a mesh (soups, slivers down to zero area, wedges from 0.5 to
// 179.5 degrees, thin plates, T-junctions, sheets that share an edge, closed and open, sizes 1e-3 to 1e3, up
// to 1e4 from the origin), a hand (slow, at 100 m/s, jumping, pressing) and a proxy, and watches every tick.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tactus::shared {

struct StressCounts {
    std::uint64_t ticks = 0;
    std::uint64_t contact_ticks = 0;
    std::uint64_t penetrations = 0;  // the proxy nearer to a triangle than its radius
    std::uint64_t passes = 0;        // on another side of a closed or unbounded surface than it started on
    std::uint64_t nans = 0;
    // Short of the place that exact descent reaches from where it is by more than a thousandth of the radius,
    // without having moved by as much in the tick. Checked now and then and whenever the proxy reports to be
    // unfinished.
    std::uint64_t stuck_ticks = 0;
    std::uint64_t unfinished_ticks = 0;  // reported by the proxy: it goes on in the next tick
    std::uint64_t checked_ticks = 0;     // held against exact descent
    double error_max = 0.0;  // over the checked and finished ticks, over the radius (dimensionless)
    std::vector<std::string> failures;  // the first few, each with its seed, tick and numbers
};

// The same seed and number of ticks give the same case on every machine.
void run_stress_case(std::uint64_t seed, int ticks, StressCounts& counts);

}  // namespace tactus::shared
