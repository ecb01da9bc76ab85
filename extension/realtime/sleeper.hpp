// Waiting for a point in time: sleep to a little before it, then look at the clock until it is there.
//
// A sleep ends late by what the machine needs to wake a processor: a few microseconds on bare metal, tens in
// a virtual machine. The sleeper learns that figure and starts as much earlier, up to a limit, since the
// look-out burns a core.
#pragma once

#include "core/math/types.hpp"
#include "platform/sleep.hpp"

namespace tactus {

struct SleepSettings {
    // The longest look-out before a deadline (unit: nanoseconds). 0: sleep only.
    Nanoseconds spin_limit = usual_lateness();
};

class Sleeper {
public:
    explicit Sleeper(const SleepSettings& settings) : settings_(settings) {}

    // Returns the time, which is at or after `deadline`. Returns at once if that has passed.
    Nanoseconds wait_until(Nanoseconds deadline);

    // How late sleeps end at present, as learnt (unit: nanoseconds).
    Nanoseconds oversleep() const { return oversleep_; }

private:
    void learn(Nanoseconds overslept);

    SleepSettings settings_;
    SleepTimer timer_;
    Nanoseconds oversleep_ = 0;
};

}  // namespace tactus
