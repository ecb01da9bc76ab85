#include "network/pace.hpp"

#include <algorithm>

namespace tactus {
namespace {

// A way that takes so much longer than it did has a queue (unit: nanoseconds).
constexpr double queue = 30e6;
// Of the way's jitter: so much is no queue.
constexpr double times_jitter = 4.0;
constexpr Nanoseconds halve_every = 400'000'000;
constexpr Nanoseconds max_double_after = 32 * nanoseconds_per_second;
// Who congests the way so soon after more was sent has asked for too much.
constexpr Nanoseconds shows_after = 1'500'000'000;

}  // namespace

void Pace::adapt(const LinkStatistics& link, Nanoseconds now) {
    const ClockFigures& clock = link.clock;
    const double queued = clock.mean_delay - static_cast<double>(clock.least_delay);
    queues_ = clock.known && queued > std::max(queue, times_jitter * clock.jitter);
    const bool congested = queues_ || link.lost_there > much_lost_;
    congested_at_ = congested ? now : congested_at_;
    if (tried_more_ && (congested || now - changed_at_ >= shows_after)) {
        tried_more_ = false;
        patience_ = congested ? std::min(2 * patience_, max_double_after) : double_after;
    }
    if (congested && stride_ < max_stride && now - changed_at_ >= halve_every) {
        stride_ *= 2;
        changed_at_ = now;
    } else if (!congested && stride_ > 1 && now - std::max(congested_at_, changed_at_) >= patience_) {
        stride_ /= 2;
        changed_at_ = now;
        tried_more_ = true;
    }
}

}  // namespace tactus
