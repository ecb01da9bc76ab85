// Both ends of a link with a delay and losses, in virtual time.
#pragma once

#include "network/link_emulator.hpp"
#include "network/memory_link.hpp"

namespace tactus::session_test {

class EmulatedLink {
public:
    // `delay`: there and back (unit: seconds).
    explicit EmulatedLink(double delay, double loss = 0.0)
        : conditions_(conditions(delay, loss)),
          at_far_(wire_.second(), conditions_, 1),
          at_near_(wire_.first(), conditions_, 2) {}

    void change(const LinkConditions& other) {
        at_far_.change(other);
        at_near_.change(other);
    }
    void lose_everything(bool lost) {
        LinkConditions other = conditions_;
        other.loss = lost ? 1.0 : conditions_.loss;
        change(other);
    }

private:
    static LinkConditions conditions(double delay, double loss) {
        LinkConditions made;
        made.delay = from_seconds(0.5 * delay);
        made.loss = loss;
        return made;
    }

    LinkConditions conditions_;
    MemoryLinkPair wire_{4096};

protected:
    LinkEmulator at_far_, at_near_;
};

}  // namespace tactus::session_test
