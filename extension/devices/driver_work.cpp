#include "devices/driver_work.hpp"

#include <algorithm>
#include <utility>

#include "platform/clock.hpp"
#include "platform/shared_library.hpp"
#include "platform/sleep.hpp"

namespace tactus {

namespace {

// Between two looks for a device that is not there (unit: nanoseconds).
constexpr Nanoseconds between_openings = 200'000'000;

// A device that says nothing for so long is closed and looked for again (unit: nanoseconds).
constexpr Nanoseconds lost_after = 500'000'000;

constexpr Nanoseconds exchange_time = 5'000'000;

// Between two times that the watchdog takes the same force away (unit: nanoseconds).
constexpr Nanoseconds taken_again = 1'000'000;

const std::string too_slow =
    "the device gives no force: it answers fewer than " +
    std::to_string(nanoseconds_per_second / longest_exchange) +
    " times a second; give it a port of its own on this machine, and close what takes the processor's time";

constexpr Nanoseconds part_of_rest = 10'000'000;

// What decides how stiff a wall may be: the delay that the device declares, or a longer one that is measured,
// in steps of half a millisecond (unit: seconds). It does not shrink while the device is open, so that walls
// do not waver.
double longer_delay(double known, Nanoseconds measured) {
    constexpr Nanoseconds step = 500'000;
    return std::max(known, to_seconds((measured + step / 2) / step * step));
}

RealtimeRequest realtime_request(int priority, int cpu) {
    RealtimeRequest request;
    request.fifo_priority = priority;
    request.lock_memory = false;
    request.cpu = cpu;
    request.keep_awake = false;
    return request;
}

// The loop's own priority is 70, and it may not wait for a driver.
const RealtimeRequest of_driver = realtime_request(69, any_processor);
// Before the loop, so that one that never sleeps is watched as well; on its processor, which does not sleep
// either: elsewhere a timer may have to wake one first, which takes up to half a millisecond where that is a
// virtual one. Of the loop's time it takes a few microseconds a millisecond.
const RealtimeRequest of_watchdog = realtime_request(71, last_processor);

}  // namespace

// `shared`: a std::shared_ptr of its own, so that what the thread uses lives as long as the thread.
template <void (DriverWork::*work)(), const RealtimeRequest& request>
void DriverWork::enter(void* shared) {
    const std::unique_ptr<std::shared_ptr<DriverWork>> held(
        static_cast<std::shared_ptr<DriverWork>*>(shared));
    DriverWork& self = **held;
    const RealtimeReport granted = make_thread_realtime(request);
    (self.*work)();
    release_realtime(granted);
    self.at_work_.fetch_sub(1, std::memory_order_acq_rel);
}

// Without a watchdog nothing is driven.
void DriverWork::start(const std::shared_ptr<DriverWork>& work) {
    keep_this_library();
    const auto begin = [&work](Thread& thread, const char* name, void (*enter)(void*)) {
        auto held = std::make_unique<std::shared_ptr<DriverWork>>(work);
        work->at_work_.fetch_add(1, std::memory_order_acq_rel);
        std::string problem = thread.start(name, enter, held.get());
        if (problem.empty()) {
            static_cast<void>(held.release());  // the thread has it now
        } else {
            work->at_work_.fetch_sub(1, std::memory_order_acq_rel);
        }
        return problem;
    };
    std::string problem =
        begin(work->watchdog_, "tactus-watchdog", enter<&DriverWork::keep_watch, of_watchdog>);
    if (problem.empty()) {
        problem = begin(work->io_, "tactus-device", enter<&DriverWork::run, of_driver>);
    }
    if (!problem.empty()) {
        work->tell(DriverHealth::Phase::searching, "no thread for the device: " + problem);
    }
}

// The watchdog keeps watch until the driver has closed: a force may be on until then.
bool DriverWork::end(Nanoseconds at_most) {
    stop_.store(true, std::memory_order_release);
    forces_.wake_driver();
    SleepTimer timer;
    const auto wait_for = [&](int threads, Nanoseconds until) {
        while (at_work_.load(std::memory_order_acquire) > threads && monotonic_now() < until) {
            timer.sleep_until(monotonic_now() + 200'000);
        }
        return at_work_.load(std::memory_order_acquire) <= threads;
    };
    const Nanoseconds until = monotonic_now() + at_most;
    const bool has_closed = wait_for(1, until);
    end_watch_.store(true, std::memory_order_release);
    forces_.end_wait();
    if (has_closed && wait_for(0, until + at_most / 9)) {
        io_.join();
        watchdog_.join();
        return true;
    }
    io_.leave();
    watchdog_.leave();
    return false;
}

void DriverWork::set_pace(const LoopPace& pace) {
    forces_.set_pace(pace);
    const std::lock_guard lock(health_mutex_);
    no_force_ = why_no_force(pace);
}

bool DriverWork::refresh(Reading& newest) {
    const bool is_new = readings_.refresh();
    if (is_new) {
        newest = readings_.front();
    }
    return is_new;
}

DriverHealth DriverWork::health() {
    const std::lock_guard lock(health_mutex_);
    DriverHealth health = health_;
    if (health.phase == DriverHealth::Phase::running && health.text.empty()) {
        health.text = no_force_.empty() && forces_.is_too_slow() ? too_slow : no_force_;
    }
    health.readings = count_.load(std::memory_order_relaxed);
    health.let_go = let_go_.load(std::memory_order_relaxed);
    health.displayed = forces_.displayed().wrench;
    health.cuts = forces_.cuts();
    return health;
}

void DriverWork::tell(DriverHealth::Phase phase, std::string text) {
    const std::lock_guard lock(health_mutex_);
    health_.phase = phase;
    health_.text = std::move(text);
    health_.id = phase == DriverHealth::Phase::searching ? std::string() : driver_->id();
}

void DriverWork::rest(Nanoseconds span) const {
    SleepTimer timer;
    for (Nanoseconds slept = 0; slept < span && !stop_.load(std::memory_order_acquire);
         slept += part_of_rest) {
        timer.sleep_until(monotonic_now() + part_of_rest);
    }
}

void DriverWork::run() {
    while (!stop_.load(std::memory_order_acquire)) {
        std::string problem;
        if (open(problem)) {
            run_open();
            const std::string why = driver_->why_lost();
            problem = "the device has gone" + (why.empty() ? why : " (" + why + ")") +
                      ": plug it in again, it goes on by itself";
            const std::lock_guard lock(health_mutex_);
            ++health_.times_lost;
        }
        close();
        tell(DriverHealth::Phase::searching, std::move(problem));
        rest(between_openings);
    }
}

bool DriverWork::open(std::string& problem) {
    problem = driver_->open(stop_);
    const std::lock_guard lock(open_mutex_);
    is_open_ = problem.empty();
    return is_open_;
}

void DriverWork::close() {
    {
        const std::lock_guard lock(open_mutex_);
        is_open_ = false;
        forces_.rest();
    }
    driver_->close();
}

void DriverWork::run_open() {
    count_.store(0, std::memory_order_relaxed);
    Reading reading;
    reading.capabilities = driver_->capabilities();
    forces_.begin(reading.capabilities, driver_->is_paced());
    DriverReading said;
    Nanoseconds heard = monotonic_now();
    std::string told = "-";
    while (!stop_.load(std::memory_order_acquire)) {
        const Driver::Exchange done = driver_->exchange(forces_, monotonic_now() + exchange_time, said);
        const Nanoseconds now = monotonic_now();
        if (done == Driver::Exchange::reading) {
            heard = reading.heard = now;
            reading.sample = said.sample;
            reading.at = said.at;
            reading.capabilities.delay = longer_delay(reading.capabilities.delay, forces_.lag());
            readings_.publish(reading);
            forces_.heard(said.at, now);
            count_.fetch_add(1, std::memory_order_relaxed);
        } else if (done == Driver::Exchange::lost || now - heard > lost_after) {
            break;
        }
        if (std::string advice = driver_->advice(); advice != told) {
            told = advice;
            const bool is_ready = advice.empty();
            tell(is_ready ? DriverHealth::Phase::running : DriverHealth::Phase::waiting_for_user,
                 std::move(advice));
        }
    }
    // What has been read last is no longer where the hand is.
    reading.sample.connected = false;
    reading.sample.velocity = Vec3(0.0);
    readings_.publish(reading);
}

// Each round sleeps, or takes away what was due: at its priority, a round that does neither would take the
// loop's processor away for as long as nothing changes. As long as the driver has not looked since, the force
// is taken away again and again: an I/O thread that was late may have given it just after, and hang now.
void DriverWork::keep_watch() {
    SleepTimer timer;
    Nanoseconds taken = 0, next = 0;  // the look after which a force was taken away, and when it is again
    while (!end_watch_.load(std::memory_order_acquire)) {
        forces_.wait_for_force();
        const ForceSlot::Due due = forces_.due();
        if (due.looked_at == 0) {
            continue;
        }
        const Nanoseconds at = due.looked_at == taken ? next : due.at;
        if (monotonic_now() <= at) {
            timer.sleep_until(at + 1);
            continue;
        }
        const std::lock_guard lock(open_mutex_);
        const ForceSlot::Due now_due = forces_.due();
        if (now_due.looked_at != due.looked_at || (now_due.at > at && due.looked_at != taken)) {
            continue;  // it has been renewed
        }
        // The driver may look at any moment: it begins at nothing then, or has looked before and goes on.
        forces_.taken();
        if (forces_.due().looked_at != due.looked_at) {
            continue;
        }
        if (is_open_) {
            if (due.looked_at != taken) {
                forces_.note_taken(monotonic_now());
                let_go_.fetch_add(1, std::memory_order_relaxed);
            }
            driver_->let_go();
            forces_.taken();
        }
        taken = due.looked_at;
        next = monotonic_now() + taken_again;
    }
}

}  // namespace tactus
