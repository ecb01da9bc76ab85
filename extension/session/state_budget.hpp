// What a side may send of its bodies that keeps to a rate: their states, and how many of them at a time.
//
// A bucket of bits fills with the rate and is emptied by what is sent. It holds what states of one packet, or
// 20 ms of the rate, take: what was not needed is not caught up with.
#pragma once

#include <algorithm>
#include <cstddef>

#include "network/messages.hpp"

namespace tactus {

// A side keeps to no less (unit: bits per second).
inline constexpr double least_body_rate = 50e3;

class StateBudget {
public:
    // Once a round of `seconds`. `rate`: bits a second, > 0.
    void earn(double rate, double seconds) {
        constexpr double saved = 0.02;  // (unit: seconds)
        const double packet = ObjectStates::max_count * bits_a_state_;
        credit_ = std::min(credit_ + rate * seconds, std::max(rate * saved, packet));
    }
    // States that may be sent by now.
    std::size_t room() const { return credit_ > 0.0 ? static_cast<std::size_t>(credit_ / bits_a_state_) : 0; }
    // So many states took so many bits, with all headers.
    void sent(std::size_t states, double bits) {
        constexpr double share = 0.1;  // of the newest packet in the mean
        credit_ -= bits;
        bits_a_state_ += share * (bits / static_cast<double>(states) - bits_a_state_);
    }
    double bits_a_state() const { return bits_a_state_; }

private:
    double credit_ = 0.0;          // (unit: bits)
    double bits_a_state_ = 600.0;  // in the mean
};

}  // namespace tactus
