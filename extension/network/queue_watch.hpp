// Whether what goes to the far side queues up on its way: a request for the time takes longer there than the
// least that it has taken of late. What the two clocks differ by is in both, and falls out.
//
// A queue keeps back all that comes; chance does not. So the least of the last three counts, and what chance
// makes of one of them is known from how the way bends (its second difference): a queue that fills or empties
// steadily makes none.
//
// A queue that is full loses what comes next, the requests too. So one that was found last is taken to be
// there still, as long as no request is answered.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/math/types.hpp"

namespace tactus {

struct QueueFigures {
    bool known = false;     // false: all else is 0
    double waiting = 0.0;   // (unit: nanoseconds)
    double trend = 0.0;     // of that, from one request to the next (unit: nanoseconds)
    double chance = 0.0;    // (unit: nanoseconds)
    Nanoseconds as_of = 0;  // when the newest of them was asked, in the session's time

    // What is spread evenly lies within 3.6 `chance` above the least, and three in a row of what is normal
    // are beyond 5.5 once in 10⁵ requests. Where a queue is expected, because more is being sent than before
    // or because there was one, it is told of earlier: by chance that is normal, in two of a thousand.
    bool is_longer_than(double nanoseconds, bool expected) const {
        return known && waiting > std::max(nanoseconds, (expected ? 4.0 : 5.5) * chance);
    }
    // It empties already.
    bool falls() const { return trend < -2e6; }
};

class QueueWatch {
public:
    // A request: `sent` on this side's clock, `arrived` on the far side's; `asked_at` in the session's time.
    void add(Nanoseconds sent, Nanoseconds arrived, Nanoseconds asked_at) {
        const Nanoseconds way = arrived - sent;
        if (count_ == 0 || asked_at - stretch_began_ >= stretch) {
            least_before_ = count_ == 0 ? way : least_;
            least_ = way;
            stretch_began_ = asked_at;
        }
        least_ = std::min(least_, way);
        const Nanoseconds least = std::min(least_, least_before_);
        if (count_ >= 2) {
            const auto bend = static_cast<double>(way - 2 * ways_[0] + ways_[1]);
            // The first ones are averaged: what begins at 0 would take chance for a queue.
            const double share = std::max(smoothing, 1.0 / static_cast<double>(count_ - 1));
            figures_.chance += share * (0.5 * std::abs(bend) - figures_.chance);
        }
        if (count_ == 0) {
            ways_.fill(way);
        }
        figures_.known = true;
        const auto waiting = static_cast<double>(std::min({way, ways_[0], ways_[1]}) - least);
        figures_.trend = waiting - figures_.waiting;
        figures_.waiting = waiting;
        figures_.as_of = asked_at;
        ways_ = {way, ways_[0]};
        ++count_;
    }

    // Once a tick: no answer has come since. `round_trip`: what one takes to come (unit: nanoseconds).
    void wait(Nanoseconds now, Nanoseconds round_trip) {
        if (figures_.known && now - figures_.as_of > round_trip + silence) {
            figures_.as_of = now;
            figures_.trend = 0.0;
        }
    }

    // One of the clocks was set, or the far side is another one.
    void forget() { *this = {}; }

    const QueueFigures& figures() const { return figures_; }

private:
    // The least of two such stretches counts, so that a way that has become longer is known as such in time.
    static constexpr Nanoseconds stretch = 5 * nanoseconds_per_second;
    static constexpr double smoothing = 1.0 / 32.0;
    // Five requests, where none is asked for often.
    static constexpr Nanoseconds silence = nanoseconds_per_second / 2;

    QueueFigures figures_;
    std::array<Nanoseconds, 2> ways_{};  // the last ones, newest first
    Nanoseconds least_ = 0, least_before_ = 0;
    Nanoseconds stretch_began_ = 0;
    std::uint64_t count_ = 0;
};

}  // namespace tactus
