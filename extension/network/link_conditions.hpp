// What a network does to what passes: the settings of a LinkEmulator, as plain values.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/types.hpp"

namespace tactus {

enum class JitterShape : std::uint8_t {
    uniform,     // delay + evenly between -jitter and +jitter
    normal,      // delay + a normal deviate, standard deviation `jitter`
    heavy_tail,  // delay + a Pareto deviate of mean `jitter`: never early, seldom very late
    trace,       // as the trace says, one entry a datagram, over and over, on top of delay
};

enum class Way : std::uint8_t { to_teleoperator, to_operator };

// The 64 bits of splitmix64's output function (Steele, Lea and Flood 2014): near numbers get far apart.
constexpr std::uint64_t scattered(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

// The seed of one way's emulator: the two ways of a seed have nothing in common, nor have those of another
// seed.
constexpr std::uint64_t luck_of(std::uint64_t seed, Way way) {
    return scattered(0x9e3779b97f4a7c15u * (2 * seed + (way == Way::to_operator ? 1 : 0)) + 1);
}

// Delays of a recorded network, one a datagram.
struct DelayTrace {
    static constexpr Nanoseconds lost = -1;

    std::vector<Nanoseconds> delays;  // each >= 0, or `lost`; not empty
};

struct DelayTraceResult {
    DelayTrace trace;
    std::string error;  // empty, or which line is wrong
};

// One delay a line (unit: milliseconds), or the word "lost"; "#" begins a comment. Off the loop.
DelayTraceResult parse_delay_trace(std::string_view text);

// Losses that come in bursts: the model of Gilbert and Elliott. Between two datagrams the network turns bad
// or good again by chance.
struct BurstLoss {
    double enter = 0.0;       // chance to turn bad, 0 … 1; 0: never
    double leave = 1.0;       // chance to turn good again, 0 … 1; 1 / leave is the mean length of a burst
    double loss_while = 1.0;  // share lost while bad, 0 … 1
};

// A burst model that loses `share` (0 … 1) of all datagrams, `length` (>= 1) in a row on average.
BurstLoss bursts(double share, double length);

struct LinkConditions;

// What of the conditions is not as it reads: a delay that cannot be below 0, an order that makes the way
// longer, bursts too short for what they are to lose. Whole sentences without their full stop; none where all
// is. `burst_share` and `burst_length`: what bursts() was asked for.
std::vector<std::string> notes_on(const LinkConditions& conditions, double burst_share, double burst_length);

// A clock that is wrong: reads `offset` ahead at `origin` and gains `drift` seconds a second.
struct ClockSkew {
    Nanoseconds origin = 0;
    Nanoseconds offset = 0;
    double drift = 0.0;  // (dimensionless), -1e-3 … 1e-3; a bad crystal has 1e-4

    // What the wrong clock shows at `time` of the right one.
    Nanoseconds shown_at(Nanoseconds time) const {
        return time + offset + static_cast<Nanoseconds>(drift * static_cast<double>(time - origin));
    }
};

struct LinkConditions {
    Nanoseconds delay = 0;   // one way, >= 0
    Nanoseconds jitter = 0;  // see JitterShape, >= 0; no delay gets negative
    JitterShape shape = JitterShape::uniform;
    const DelayTrace* trace = nullptr;  // for the shape of that name; not owned, not altered while in use
    bool keep_order = false;            // jitter lets nothing overtake, as in a queue

    double loss = 0.0;         // share lost independently, 0 … 1
    BurstLoss burst;           // on top of `loss`
    double duplication = 0.0;  // share that arrives twice, each with a delay of its own, 0 … 1
    double reordering = 0.0;   // share held back by `reorder_by`, so that later ones overtake, 0 … 1
    Nanoseconds reorder_by = 10'000'000;  // >= 0

    // The rate of the narrowest place (unit: bits a second, with the headers that Link::overhead() counts);
    // 0: no limit. What would have to wait there longer than `max_waiting` is lost.
    double rate = 0.0;
    Nanoseconds max_waiting = 200'000'000;
};

}  // namespace tactus
