// How often a side sends when the network cannot take more: every tick, or every second, fourth or eighth.
//
// Halved where too much is lost for a while, or where what is on its way queues up; doubled again when
// neither has been so for two seconds, or longer where that was too much the last time.
#pragma once

#include "network/endpoint.hpp"

namespace tactus {

class Pace {
public:
    static constexpr std::uint32_t max_stride = 8;

    // More than that share lost is too much. Losses tell of a way that is too narrow only where it holds up
    // little: who cannot say later what he does not say now leaves them out of account (1).
    explicit Pace(double much_lost) : much_lost_(much_lost) {}

    // Once a tick.
    void adapt(const LinkStatistics& link, Nanoseconds now);

    // The far side is another one: nothing before counts.
    void restart() { *this = Pace(much_lost_); }

    std::uint32_t stride() const { return stride_; }
    bool queues() const { return queues_; }

private:
    static constexpr Nanoseconds double_after = 2 * nanoseconds_per_second;

    double much_lost_;
    std::uint32_t stride_ = 1;
    bool queues_ = false;
    Nanoseconds congested_at_ = 0;
    Nanoseconds changed_at_ = 0;
    Nanoseconds patience_ = double_after;  // without trouble before more is tried
    bool tried_more_ = false;              // and not known yet whether it was too much
};

}  // namespace tactus
