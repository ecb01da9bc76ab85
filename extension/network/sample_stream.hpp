// What an operator sends of its hands: one packet a tick for all of its pointers, or fewer packets of several
// ticks when the network cannot take so many, each with as many older samples as losses ask for.
//
// Of older samples so many are repeated that all packets with a sample are lost at most once in ten thousand
// times, were losses independent: some where nothing is lost, since a loss is known only later. A hand that
// moves unevenly takes more bytes: of its samples no more are repeated than the budget has room for. No
// tick's sample is left out by sending fewer packets (pace.hpp).
//
// Belongs to whoever ticks; allocates nothing after its constructor.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "network/pace.hpp"

namespace tactus {

struct SampleStreamSettings {
    std::uint32_t max_repeats = OperatorSamples::max_count - 1;  // older samples in a packet
    std::uint32_t max_pointers = 8;                              // > 0
    Nanoseconds period = 1'000'000;                              // of a tick, > 0
    // Of a pointer, with all that IP, UDP and a seal add; what it has to say anew is always said.
    double max_bits_per_s = 1.45e6;
};

class SampleStream {
public:
    explicit SampleStream(const SampleStreamSettings& settings);

    void set_max_repeats(std::uint32_t repeats) { settings_.max_repeats = repeats; }

    // A pointer's sample of this tick; pointers beyond `max_pointers` are left out. None need be added where
    // nothing is to be said (deadband).
    void add(const OperatorSample& sample);

    // Once a tick, after the last add(): sends what is due.
    void end_tick(Endpoint& link, Nanoseconds now);

    // The far side is another one: nothing before counts.
    void restart();

    std::uint32_t ticks_a_packet() const { return pace_.stride(); }
    std::uint32_t repeats() const { return repeats_; }

private:
    struct Pointer {
        std::array<OperatorSample, OperatorSamples::max_count> samples{};  // newest first
        std::uint32_t count = 0;
        std::uint32_t waiting = 0;  // of them have not been sent yet
    };

    // What a tick has sent.
    struct Sent {
        std::uint32_t pointers = 0, samples = 0;
        std::size_t bytes = 0;  // with all that is added on the way
    };

    std::uint32_t older() const;
    Sent send(Endpoint& link);
    void send_message(Endpoint& link, OperatorSamples& message) const;
    void keep_to_budget(const Sent& sent);

    SampleStreamSettings settings_;
    std::vector<Pointer> pointers_;
    Pace pace_{PaceSettings{0.1, 8}};
    std::uint32_t repeats_ = 0;
    std::uint32_t affordable_ = 0;  // repeats
    std::uint64_t tick_ = 0;
};

}  // namespace tactus
