// When ticks are due, as plain arithmetic without a clock: deadline k = start + k·period (thesis 4.4.4). A
// late tick leaves the deadlines where they are, so the next ones come sooner and the mean stays one period;
// none is skipped.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

class TickSchedule {
public:
    // A tick later than `rebase_after` (unit: nanoseconds) is not caught up: a laptop was closed or a
    // debugger held the process, and a hundred hurried ticks would help nobody.
    TickSchedule(Nanoseconds start, Nanoseconds period, Nanoseconds rebase_after)
        : deadline_(start), period_(period), rebase_after_(rebase_after) {}

    // When the next tick is due.
    Nanoseconds deadline() const { return deadline_; }

    // The time that was given up by moving the schedule to `now`; 0 where the schedule still holds.
    Nanoseconds rebase_if_hopeless(Nanoseconds now) {
        const Nanoseconds late = now - deadline_;
        if (late <= rebase_after_) {
            return 0;
        }
        deadline_ = now;
        return late;
    }

    void advance() { deadline_ += period_; }

private:
    Nanoseconds deadline_;
    Nanoseconds period_;
    Nanoseconds rebase_after_;
};

}  // namespace tactus
