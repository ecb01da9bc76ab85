#include "world/world_loop.hpp"

#include "platform/clock.hpp"

namespace tactus {

namespace {

// Well below what the rings hold.
constexpr std::int64_t ticks_at_once = 1000;

constexpr std::size_t trace_capacity = 4096;  // ticks between two drains: four seconds at 1 kHz

}  // namespace

WorldLoop::WorldLoop(Session& session, bool real_time)
    : session_(session),
      real_time_(real_time),
      epoch_of_monotonic_clock_(wall_clock_now() - monotonic_now()) {}

std::string WorldLoop::start(const TickLoopSettings& settings, bool baseline) {
    is_new_ = true;
    settings_ = settings;
    baseline_ = baseline ? std::make_unique<BaselineLoop>() : nullptr;
    std::string error = loop_.start(settings, &WorldLoop::tick_function, this, trace_.get());
    if (error.empty() && baseline_ != nullptr) {
        error = baseline_->start(settings);
    }
    return error;
}

void WorldLoop::stop() {
    if (baseline_ != nullptr) {
        baseline_->stop();
    }
    loop_.stop();
}

std::string WorldLoop::trace_ticks() {
    if (trace_ != nullptr) {
        return {};
    }
    const bool was_running = loop_.running();
    stop();
    trace_ = std::make_unique<TickTrace>(trace_capacity);
    return was_running ? start(settings_, baseline_ != nullptr) : std::string();
}

TickStatus WorldLoop::tick_function(void* self, Nanoseconds scheduled) {
    WorldLoop& loop = *static_cast<WorldLoop*>(self);
    if (loop.is_new_) {
        loop.is_new_ = false;
        loop.ahead_.store(scheduled - loop.next_time_, std::memory_order_relaxed);
    }
    return loop.tick(scheduled - loop.ahead_.load(std::memory_order_relaxed), monotonic_now() - scheduled);
}

TickStatus WorldLoop::tick(Nanoseconds now, Nanoseconds late) {
    const TickStatus status = session_.tick(now, trace_.get(), late);
    next_time_ = now + session_.settings().period;
    ticks_.store(ticks_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    return status;
}

void WorldLoop::advance(std::int64_t ticks, const std::function<void()>& between) {
    for (std::int64_t done = 0; done < ticks; ++done) {
        const Nanoseconds now = next_time_;
        if (trace_ != nullptr) {
            trace_->begin_stepped_tick(now, monotonic_now());
        }
        const TickStatus status = tick(now, 0);
        stepped_status_ |= status;
        if (trace_ != nullptr) {
            trace_->end_tick(monotonic_now(), status);
        }
        if (done % ticks_at_once == ticks_at_once - 1) {
            between();
        }
    }
}

Nanoseconds WorldLoop::epoch() const {
    return real_time_ ? ahead_.load(std::memory_order_relaxed) + epoch_of_monotonic_clock_ : 0;
}

}  // namespace tactus
