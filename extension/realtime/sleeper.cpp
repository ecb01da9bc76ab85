#include "realtime/sleeper.hpp"

#include <algorithm>

#include "platform/clock.hpp"
#include "platform/processor.hpp"

namespace tactus {

Nanoseconds Sleeper::wait_until(Nanoseconds deadline) {
    const Nanoseconds wake_up = deadline - oversleep_;
    Nanoseconds now = monotonic_now();
    if (now < wake_up) {
        timer_.sleep_until(wake_up);
        now = monotonic_now();
        learn(now - wake_up);
    }
    while (now < deadline) {
        relax_processor();
        now = monotonic_now();
    }
    return now;
}

// A running quantile: with a step up three times the step down, three of four sleeps end within the estimate.
// Unlike a mean it is deaf to the rare sleep that ends milliseconds late, which no look-out could make up
// for.
void Sleeper::learn(Nanoseconds overslept) {
    constexpr Nanoseconds step_down = 300;
    constexpr Nanoseconds step_up = 3 * step_down;
    const Nanoseconds step = overslept > oversleep_ ? step_up : -step_down;
    oversleep_ = std::clamp<Nanoseconds>(oversleep_ + step, 0, settings_.spin_limit);
}

}  // namespace tactus
