// Hard cases by the number: each seed makes a mesh (soups, slivers down to zero area, wedges from 0.5 to
// 179.5 degrees, thin plates, T-junctions, sheets that share an edge, closed and open, sizes 1e-3 to 1e3, up
// to 1e4 from the origin; one in fifty has up to a million triangles within reach), a hand (slow, at 100 m/s,
// jumping, pressing), friction or none, and a proxy. In some the body tumbles, in some it deforms by up to
// ten radii at once, in some others appear where the proxy is, jump and vanish, in some it is squeezed until
// it has no room. Every tick is watched by code that shares nothing with the proxy.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tactus::shared {

struct StressCounts {
    std::uint64_t cases = 0;
    std::uint64_t ticks = 0;
    std::uint64_t contact_ticks = 0;
    std::uint64_t penetrations = 0;  // the proxy nearer to a triangle than its radius
    std::uint64_t passes = 0;        // on another side of a closed or unbounded surface than it started on
    std::uint64_t nans = 0;
    // Short of the place that exact descent reaches from where it is by more than a thousandth of the radius,
    // without having moved by as much in the tick. Checked now and then and whenever the proxy reports to be
    // unfinished.
    std::uint64_t stuck_ticks = 0;
    // Said to be finished, and as far from that place.
    std::uint64_t false_ends = 0;
    // On a crest, where a hair decides which way descent leads: no place is right, none is held against it.
    std::uint64_t balanced_ticks = 0;
    // Said to be squeezed or let out where nothing moves and nothing has come.
    std::uint64_t false_excuses = 0;
    std::uint64_t judge_faults = 0;      // a bound by which the judge spared itself a look did not hold
    std::uint64_t unfinished_ticks = 0;  // reported by the proxy: it goes on in the next tick
    std::uint64_t excused_ticks = 0;     // a body has come, or leaves no room: not held against the proxy
    std::uint64_t checked_ticks = 0;     // held against exact descent
    std::uint64_t friction_ticks = 0, moving_ticks = 0, dense_ticks = 0;
    std::uint64_t deformations = 0, appearances = 0, squeezes = 0;
    double error_max =
        0.0;  // over the checked and finished ticks that do not balance, over the radius (dimensionless)
    // How far a tick of a case in which only the hand moves has led away from it, over the radius
    // (dimensionless).
    double thrown_max = 0.0;
    double longest_tick_us = 0.0;  // of processor time, 0 where not timed (unit: microseconds)
    std::uint64_t longest_tick_seed = 0;
    std::vector<std::string> failures;  // the first few, each with its seed, tick and numbers

    void add(const StressCounts& other);
};

struct StressOptions {
    int ticks = 2'000;   // a case
    bool dense = false;  // with the large meshes, which take seconds to make
    bool timed = false;
    bool deforming = true;
};

// The same seed and options give the same case on every machine.
void run_stress_case(std::uint64_t seed, const StressOptions& options, StressCounts& counts);

}  // namespace tactus::shared
