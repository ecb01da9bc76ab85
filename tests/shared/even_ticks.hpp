// The ticks of a loop by which a device is judged: around the others the loop or a processor stood still, so
// that a cut of the force is right.
#pragma once

#include <algorithm>

#include "core/safety/force_watch.hpp"

namespace tactus::shared {

// Of one tick (on the steady clock).
struct TickTimes {
    Nanoseconds writes = 0;   // the loop begins to write its force,
    Nanoseconds written = 0;  // has written it,
    Nanoseconds counted = 0;  // and has counted the cuts
};

class EvenTicks {
public:
    explicit EvenTicks(Nanoseconds period) : longest_(std::max(shortest_life - 100'000, period * 11 / 10)) {}

    // The last sign of life of the loop before the next tick.
    Nanoseconds last() const { return last_; }

    // Whether a cut that was counted in this tick, and not in the one before, has no good reason.
    // `stood_still`: a processor has, since last().
    bool add(const TickTimes& tick, bool stood_still) {
        const bool is_late = tick.written - last_ > longest_ || tick.counted - tick.writes > longest_;
        last_ = tick.writes;
        since_ = is_late || stood_still ? 0 : since_ + 1;
        return since_ > settled;
    }

private:
    static constexpr int settled = 10;  // ticks

    Nanoseconds longest_;  // from one sign of life of the loop to the next
    Nanoseconds last_ = 0;
    int since_ = 0;  // the last one that is not even (unit: ticks)
};

}  // namespace tactus::shared
