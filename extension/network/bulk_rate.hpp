// How fast a side sends what can wait, the descriptions, so that it queues up before nothing that cannot.
//
// The rate rises until requests for the time find a queue (queue_watch.hpp), and is halved then; while what
// they find may be chance it stays. What a rate does shows in requests that were sent a while after it, and
// is known when three of them have been answered: after T. A rise by the share g makes at most g T of queue
// until then, so at first g is what makes 20 ms of it, and once a queue has been met an eighth.
#pragma once

#include <cstddef>

#include "network/endpoint.hpp"

namespace tactus {

class BulkRate {
public:
    // Bytes a second: what the narrowest way has room for, where it begins, and the most.
    static constexpr double min_rate = 5e3, first_rate = 16e3, max_rate = 2e6;

    // Once a tick. `wanted`: there is something to be sent; `most`: the rate is no higher, but min_rate at
    // least (unit: bytes per second).
    void adapt(Endpoint& link, Nanoseconds now, bool wanted, double most = max_rate);

    bool may_send() const { return credit_ > 0.0; }
    void sent(std::size_t bytes) { credit_ -= static_cast<double>(bytes); }

    // A queue is its own doing, and it can still send less.
    bool can_yield() const { return wanted_ && rate_ > min_rate; }
    double rate() const { return rate_; }

private:
    static constexpr double first_credit = 1024.0;  // (unit: bytes)

    void rise(const Endpoint& link);

    double rate_ = first_rate;  // (unit: bytes per second)
    double credit_ = first_credit;
    Nanoseconds last_ = 0;
    Nanoseconds changed_at_ = 0;
    bool wanted_ = false;
    bool used_up_ = false;  // since the last change
    bool met_a_queue_ = false;
    bool ticked_ = false;
};

}  // namespace tactus
