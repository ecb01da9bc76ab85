#include "network/pace.hpp"

#include <algorithm>
#include <utility>

namespace tactus {
namespace {

// So much that waits on the way is a queue (unit: nanoseconds).
constexpr double queue = 20e6;
constexpr Nanoseconds max_double_after = 32 * nanoseconds_per_second;
// Who congests the way so soon after more was sent has asked for too much.
constexpr Nanoseconds shows_after = 2'500'000'000;

// The share lost is smoothed: so long it takes to tell of a change.
constexpr Nanoseconds loss_shows_after = nanoseconds_per_second;
// Half as much was sent. Where the way is too narrow, a share L lost becomes 2 L - 1, or 0. It has not helped
// where more than this of L is still lost,
constexpr double still_lost = 0.75;
// and where less than this times 1 - L comes: where L is near 1 it falls by little, and twice as much comes.
constexpr double more_comes = 1.4;
constexpr double lost_more = 1.3;    // than is lost anyway
constexpr double hardly_lost = 0.5;  // of what is much

}  // namespace

void Pace::adapt(Endpoint& link, Nanoseconds now) {
    const QueueFigures& way = link.statistics().queue_there;
    const double lost = link.statistics().lost_there;
    queues_ = way.is_longer_than(queue, stride_ > 1 || tried_more_);
    // What was asked before the last change tells nothing of it; a queue that empties already will be gone.
    const bool fills = queues_ && way.as_of > changed_at_ && !way.falls();
    const bool lossy = loses(lost, now);
    const bool congested = queues_ || lossy;
    congested_at_ = congested ? now : congested_at_;
    // What more has filled empties only while less is sent than before.
    // A small step is undone by doubling.
    const std::uint32_t less = tried_more_ && queues_ && settings_.tries == 2 ? 4 : 2;
    if (tried_more_ && (congested || now - changed_at_ >= shows_after)) {
        tried_more_ = false;
        patience_ = congested ? std::min(2 * patience_, max_double_after) : double_after;
    }
    if ((fills || lossy) && stride_ < settings_.max_stride) {
        lost_before_ = queues_ ? 0.0 : lost;
        stride_ = std::min(less * stride_, settings_.max_stride);
        changed_at_ = now;
    } else if (!congested && stride_ > 1 && now - std::max(congested_at_, changed_at_) >= patience_) {
        lost_before_ = 0.0;
        stride_ -= std::max(1u, stride_ / settings_.tries);
        changed_at_ = now;
        tried_more_ = true;
    }
    if (queues_ || tried_more_) {
        link.ask_often();
    }
}

// Much for so long that all of it shows, or since more is sent, and more than is lost whatever is sent. Asked
// again only once the last answer can have shown.
bool Pace::loses(double lost, Nanoseconds now) {
    if (lost <= hardly_lost * settings_.much_lost) {
        lost_before_ = lost_anyway_ = 0.0;
    }
    little_lost_at_ = lost <= settings_.much_lost ? now : little_lost_at_;
    if (now - changed_at_ < loss_shows_after) {
        return false;
    }
    if (lost_before_ > 0.0 && lost > still_lost * lost_before_ &&
        1.0 - lost < more_comes * (1.0 - lost_before_)) {
        lost_anyway_ = std::max(lost, std::exchange(lost_before_, 0.0));
        stride_ = std::max(1u, stride_ / 2);
        changed_at_ = now;
        return false;
    }
    const bool shows = tried_more_ || now - little_lost_at_ >= loss_shows_after;
    return shows && lost > std::max(settings_.much_lost, lost_more * lost_anyway_);
}

}  // namespace tactus
