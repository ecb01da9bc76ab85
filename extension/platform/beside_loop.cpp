#include "platform/beside_loop.hpp"

#include <utility>

#include "platform/clock.hpp"
#include "platform/this_thread.hpp"

namespace tactus {

void CrowdedOut::burst(Nanoseconds worked, Nanoseconds lasted) {
    if (bursts_back_ > 0) {
        --bursts_back_;
        return;
    }
    worked_ += worked;
    lasted_ += lasted;
    if (++bursts_ == judged) {
        bursts_back_ = 2 * worked_ < lasted_ ? turn_back : 0;
        bursts_ = 0;
        worked_ = lasted_ = 0;
    }
}

void BesideLoop::begin_burst() {
    if (std::exchange(is_off_, crowded_.keeps_off()) != crowded_.keeps_off()) {
        keep_off_last_processor(is_off_);
    }
    began_ = monotonic_now();
    worked_before_ = thread_time();
}

void BesideLoop::end_burst() {
    crowded_.burst(thread_time() - worked_before_, monotonic_now() - began_);
}

}  // namespace tactus
