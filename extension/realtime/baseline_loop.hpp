// What this machine can do at best: a bare loop that only sleeps, beside the loop under measurement, at the
// same time.
//
// It asks for the same scheduling and the same processor and waits in the same way, half a period apart so
// that the two never wait for each other, and its tick is empty. What its periods scatter is the machine's
// doing; only what the loop under measurement scatters more is its own.
#pragma once

#include <string>

#include "realtime/tick_loop.hpp"

namespace tactus {

class BaselineLoop {
public:
    // `measured`: the settings of the loop that runs beside it. Empty text, or why it could not start.
    std::string start(const TickLoopSettings& measured);
    void stop() { loop_.stop(); }

    const TickStatistics& statistics() const { return loop_.statistics(); }
    TickStatistics& statistics() { return loop_.statistics(); }

private:
    TickLoop loop_;
};

}  // namespace tactus
