#include "devices/driver_device.hpp"

#include <utility>

#include "platform/realtime_thread.hpp"
#include "platform/sleep.hpp"

namespace tactus {

namespace {

// Between two looks for a device that is not there (unit: nanoseconds).
constexpr Nanoseconds look_again = 200'000'000;

// A device that says nothing for so long has frozen (unit: nanoseconds).
constexpr Nanoseconds frozen_after = 20'000'000;
constexpr Nanoseconds lost_after = 500'000'000;

constexpr Nanoseconds exchange_time = 5'000'000;

// What the I/O thread is given to renew a force or take it away by itself (unit: nanoseconds).
constexpr Nanoseconds grace = 50'000;

// Between two times that the watchdog takes the same force away (unit: nanoseconds).
constexpr Nanoseconds taken_again = 1'000'000;

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

template <void (DriverDevice::*work)(), const RealtimeRequest& request>
void DriverDevice::enter(void* device) {
    const RealtimeReport granted = make_thread_realtime(request);
    (static_cast<DriverDevice*>(device)->*work)();
    release_realtime(granted);
}

// Without a watchdog nothing is driven.
DriverDevice::DriverDevice(std::unique_ptr<Driver> driver) : driver_(std::move(driver)) {
    std::string problem =
        watchdog_.start("tactus-watchdog", enter<&DriverDevice::keep_watch, of_watchdog>, this);
    if (problem.empty()) {
        problem = io_.start("tactus-device", enter<&DriverDevice::run, of_driver>, this);
    }
    if (!problem.empty()) {
        tell(DriverHealth::Phase::searching, "no thread for the device: " + problem);
    }
}

DriverDevice::~DriverDevice() {
    stop_.store(true, std::memory_order_release);
    io_.join();
    forces_.end_wait();
    watchdog_.join();
}

DeviceSample DriverDevice::read(Nanoseconds) {
    if (readings_.refresh()) {
        newest_ = readings_.front();
    }
    DeviceSample sample = newest_.sample;
    if (monotonic_now() - newest_.at > frozen_after) {
        sample.connected = false;
        sample.velocity = Vec3(0.0);
    }
    return sample;
}

// The tick's own time may be a virtual one; how long a force lives does not depend on it.
void DriverDevice::write(Nanoseconds, const Vec3& force) {
    forces_.write(force, torque_, monotonic_now());
}

DriverHealth DriverDevice::health() const {
    const std::lock_guard lock(health_mutex_);
    DriverHealth health = health_;
    health.readings = count_.load(std::memory_order_relaxed);
    health.let_go = let_go_.load(std::memory_order_relaxed);
    return health;
}

void DriverDevice::tell(DriverHealth::Phase phase, std::string text) {
    const std::lock_guard lock(health_mutex_);
    health_.phase = phase;
    health_.text = std::move(text);
    health_.id = phase == DriverHealth::Phase::searching ? std::string() : driver_->id();
}

void DriverDevice::rest(Nanoseconds span) const {
    constexpr Nanoseconds part = 10'000'000;
    SleepTimer timer;
    for (Nanoseconds slept = 0; slept < span && !stop_.load(std::memory_order_acquire); slept += part) {
        timer.sleep_until(monotonic_now() + part);
    }
}

void DriverDevice::run() {
    while (!stop_.load(std::memory_order_acquire)) {
        std::string problem;
        if (open(problem)) {
            run_open();
            problem = "the device has gone: plug it in again, it goes on by itself";
            const std::lock_guard lock(health_mutex_);
            ++health_.times_lost;
        }
        close();
        tell(DriverHealth::Phase::searching, std::move(problem));
        rest(look_again);
    }
}

bool DriverDevice::open(std::string& problem) {
    problem = driver_->open(stop_);
    const std::lock_guard lock(open_mutex_);
    is_open_ = problem.empty();
    return is_open_;
}

void DriverDevice::close() {
    {
        const std::lock_guard lock(open_mutex_);
        is_open_ = false;
        forces_.rest();
    }
    driver_->close();
}

void DriverDevice::run_open() {
    count_.store(0, std::memory_order_relaxed);
    Reading reading;
    reading.capabilities = driver_->capabilities();
    Nanoseconds heard = monotonic_now();
    std::string told = "-";
    while (!stop_.load(std::memory_order_acquire)) {
        const Driver::Exchange done =
            driver_->exchange(forces_, monotonic_now() + exchange_time, reading.sample);
        const Nanoseconds now = monotonic_now();
        if (done == Driver::Exchange::reading) {
            heard = reading.at = now;
            readings_.publish(reading);
            count_.fetch_add(1, std::memory_order_relaxed);
        } else if (done == Driver::Exchange::lost || now - heard > lost_after) {
            break;
        }
        if (std::string advice = driver_->advice(); advice != told) {
            told = advice;
            tell(advice.empty() ? DriverHealth::Phase::running : DriverHealth::Phase::waiting_for_user,
                 std::move(advice));
        }
    }
    // What has been read last is no longer where the hand is.
    reading.sample.connected = false;
    reading.sample.velocity = Vec3(0.0);
    readings_.publish(reading);
}

// Each round sleeps, or takes away what was due: at its priority, a round that does neither would take the
// loop's processor away for as long as nothing changes. As long as nobody has looked since, the force is
// taken away again and again: an I/O thread that was late may have given it just after, and hang now.
void DriverDevice::keep_watch() {
    SleepTimer timer;
    Nanoseconds taken = 0, next = 0;  // what was due when a force was taken away, and when it is again
    while (!stop_.load(std::memory_order_acquire)) {
        forces_.wait_for_force();
        const Nanoseconds due = forces_.due();
        if (due <= 0) {
            continue;
        }
        const Nanoseconds at = due == taken ? next : due + grace;
        if (monotonic_now() <= at) {
            timer.sleep_until(at + 1);
            continue;
        }
        const std::lock_guard lock(open_mutex_);
        if (forces_.due() != due) {
            continue;  // somebody has looked since
        }
        if (is_open_) {
            driver_->let_go();
            let_go_.fetch_add(due != taken, std::memory_order_relaxed);
        }
        taken = due;
        next = monotonic_now() + taken_again;
    }
}

}  // namespace tactus
