// How often a side sends when the network cannot take more: every time, or every second, fourth, eighth …
//
// Halved where what is on its way queues up and goes on doing so, or where much is lost and that makes it
// less: of losses that stay as they are who sends is not the cause, and more packets are what helps. Doubled
// again when neither has been so for two seconds, or longer where that was too much the last time; what then
// queues up is halved twice. With `tries` above 2 the way back is in smaller steps, so that less queues up.
#pragma once

#include "network/endpoint.hpp"

namespace tactus {

struct PaceSettings {
    // More than that share lost is too much. Losses tell of a way that is too narrow only where it holds up
    // little: who cannot say later what he does not say now leaves them out of account (1).
    double much_lost = 1.0;
    std::uint32_t max_stride = 8;  // a power of two
    std::uint32_t tries = 2;       // one part in so many of the stride is taken back at a time, >= 2
};

class Pace {
public:
    explicit Pace(const PaceSettings& settings) : settings_(settings) {}

    // Once a tick.
    void adapt(Endpoint& link, Nanoseconds now);

    // The far side is another one: nothing before counts.
    void restart() { *this = Pace(settings_); }

    std::uint32_t stride() const { return stride_; }
    bool queues() const { return queues_; }
    // Less is sent, and it is not known yet whether less is lost by it.
    bool asks() const { return lost_before_ > 0.0; }

private:
    static constexpr Nanoseconds double_after = 2 * nanoseconds_per_second;

    bool loses(double lost, Nanoseconds now);

    PaceSettings settings_;
    std::uint32_t stride_ = 1;
    bool queues_ = false;
    Nanoseconds congested_at_ = 0;
    Nanoseconds changed_at_ = 0;
    Nanoseconds little_lost_at_ = 0;
    Nanoseconds patience_ = double_after;  // without trouble before more is tried
    bool tried_more_ = false;              // and not known yet whether it was too much
    double lost_before_ = 0.0;             // share lost when less was sent for it; 0: not so
    double lost_anyway_ = 0.0;             // share that is not made less by that
};

}  // namespace tactus
