#include "realtime/baseline_loop.hpp"

namespace tactus {

namespace {

TickStatus tick_nothing(void*, Nanoseconds) {
    return 0;
}

}  // namespace

std::string BaselineLoop::start(const TickLoopSettings& measured) {
    TickLoopSettings settings = measured;
    settings.phase = measured.phase + measured.period / 2;
    settings.realtime.keep_awake = false;  // the measured loop sees to that, for both
    settings.thread_name = "tactus-baseline";
    return loop_.start(settings, &tick_nothing, nullptr);
}

}  // namespace tactus
