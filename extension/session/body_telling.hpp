// What a far side tells of its bodies: what they are, until the operator has it, and where they are. Belongs
// to whoever ticks.
#pragma once

#include "network/bulk_rate.hpp"
#include "session/channel.hpp"
#include "session/estimate_teller.hpp"
#include "session/session_loop.hpp"
#include "session/state_teller.hpp"

namespace tactus {

class BodyTelling {
public:
    explicit BodyTelling(std::size_t max_bodies) : states_(max_bodies), estimates_(max_bodies) {}

    // What the owner has announced and withdrawn.
    void take_orders(TeleopPort& port);
    void take(const DiscoveryAcknowledgement& known);
    // Another start of the operator: it knows nothing.
    void restart();

    // Last things in a tick. `newest`: the newest sample of the operator that has been applied.
    void tell_states(SessionLoop& loop, Channel& channel, SampleSequence newest, Nanoseconds now) {
        const double rate = channel.settings().body_rate;
        states_.tell(loop, channel, newest, now, yields(), discovery_.has_more() ? 0.5 * rate : rate);
    }
    const StateLoad& load() const { return states_.load(); }
    bool has_told_states() const { return states_.has_said(); }
    // `touch`: what has been learnt by touch, or null.
    void tell_estimates(SessionLoop& loop, Channel& channel, const TouchLearner* touch, Nanoseconds now) {
        estimates_.tell(loop, channel, touch, now);
    }
    void describe(Channel& channel, Nanoseconds now);
    // What queues on the way there is descriptions, which can be told more slowly.
    bool yields() const { return bulk_.can_yield(); }
    const DiscoveryCounts& counts() const { return discovery_.counts(); }
    // A hand presses nothing until this start of the operator has had all bodies that were there then, or its
    // model would lack what is pressed. Bodies that come later, or are described anew again and again, change
    // nothing of it.
    bool may_press(const Channel& channel, std::size_t hand) const {
        return (channel.settings().traditional || counts().unanswered == 0) && channel.works_together(hand);
    }

private:
    DiscoverySender discovery_;
    BulkRate bulk_;  // of discovery
    StateTeller states_;
    EstimateTeller estimates_;
};

}  // namespace tactus
