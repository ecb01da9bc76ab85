// What the far side says of its bodies besides where they are: how surely they are seen, and what touch has
// taught. Said when it has changed, and now and then again: some of it is lost. Belongs to whoever ticks.
#pragma once

#include <vector>

#include "session/channel.hpp"
#include "session/session_loop.hpp"
#include "session/touch_learner.hpp"

namespace tactus {

class EstimateTeller {
public:
    explicit EstimateTeller(std::size_t max_bodies) : told_(max_bodies) {}

    // Another start of the operator: it knows nothing.
    void restart();
    // The operator has built it, perhaps anew.
    void described(SessionHandle body);

    // Once a tick. `touch`: null where nothing is touched here.
    void tell(SessionLoop& loop, Channel& channel, const TouchLearner* touch, Nanoseconds now);

private:
    struct Told {
        ObjectEstimate estimate;
        Nanoseconds at = 0;  // 0: never
    };

    std::vector<Told> told_;  // by body
    Nanoseconds looked_at_ = 0;
    std::size_t next_ = 0;  // body to begin with
};

}  // namespace tactus
