#include "network/bulk_rate.hpp"

#include <algorithm>

namespace tactus {
namespace {

constexpr double queue = 5e6;  // (unit: nanoseconds)
constexpr Nanoseconds shows_after = 40'000'000;
constexpr double queue_of_a_rise = 20e6;  // (unit: nanoseconds)
constexpr double max_rise = 1.0, least_rise = 0.25, gentle_rise = 0.125;
constexpr double burst = 0.004;  // of the rate that may be saved up (unit: seconds)

}  // namespace

void BulkRate::adapt(Endpoint& link, Nanoseconds now, bool wanted, double most) {
    rate_ = std::clamp(rate_, min_rate, std::max(min_rate, most));
    const double seconds = ticked_ ? to_seconds(now - last_) : 0.0;
    last_ = now;
    ticked_ = true;
    wanted_ = wanted;
    used_up_ = used_up_ || (wanted && !may_send());
    if (credit_ < burst * rate_) {
        credit_ = std::min(credit_ + seconds * rate_, burst * rate_);
    }
    if (wanted) {
        link.ask_often();
    }
    const QueueFigures& way = link.statistics().queue_there;
    if (!way.known || way.as_of <= changed_at_ + shows_after) {
        return;
    }
    if (way.is_longer_than(queue, true)) {
        met_a_queue_ = true;
        if (!way.falls()) {
            rate_ = std::max(min_rate, 0.5 * rate_);
            changed_at_ = now;
        }
    } else if (used_up_ && way.waiting <= queue) {
        rise(link);
        changed_at_ = now;
        used_up_ = false;
    }
}

void BulkRate::rise(const Endpoint& link) {
    const double until_known =
        static_cast<double>(link.statistics().clock.latest_delay + shows_after + 2 * Endpoint::often_every);
    const double share =
        met_a_queue_ ? gentle_rise : std::clamp(queue_of_a_rise / until_known, least_rise, max_rise);
    rate_ = std::min(max_rate, (1.0 + share) * rate_);
}

}  // namespace tactus
