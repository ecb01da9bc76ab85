#include "shared/processor_stalls.hpp"

#include <algorithm>

#include "platform/clock.hpp"
#include "platform/realtime_thread.hpp"
#include "platform/sleep.hpp"

namespace tactus::shared {

namespace {

constexpr Nanoseconds beat = 200'000;
constexpr Nanoseconds late_after = 100'000;
constexpr int before_watchdogs = 72;

}  // namespace

ProcessorStalls::ProcessorStalls() {
    for (int i = 0; i < static_cast<int>(std::thread::hardware_concurrency()); ++i) {
        Witness& witness = *witnesses_.emplace_back(std::make_unique<Witness>());
        witness.due = monotonic_now() + 10 * beat;
        witness.thread = std::thread([this, &witness, i] { run(witness, i); });
    }
}

ProcessorStalls::~ProcessorStalls() {
    end_ = true;
    for (const auto& witness : witnesses_) {
        witness->thread.join();
    }
}

bool ProcessorStalls::any_since(Nanoseconds time) const {
    const Nanoseconds now = monotonic_now();
    return std::any_of(witnesses_.begin(), witnesses_.end(), [&](const auto& witness) {
        return witness->late_at >= time || now > witness->due + late_after;
    });
}

void ProcessorStalls::run(Witness& witness, int processor) const {
    RealtimeRequest request;
    request.fifo_priority = before_watchdogs;
    request.lock_memory = false;
    request.cpu = processor;
    const RealtimeReport granted = make_thread_realtime(request);
    SleepTimer timer;
    while (!end_) {
        timer.sleep_until(witness.due);
        const Nanoseconds now = monotonic_now();
        if (now > witness.due + late_after) {
            witness.late_at = now;
        }
        witness.due = now + beat;
    }
    release_realtime(granted);
}

}  // namespace tactus::shared
