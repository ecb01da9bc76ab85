#include "devices/driver_device.hpp"

#include <utility>

#include "platform/sleep.hpp"

namespace tactus {

namespace {

// Between two looks for a device that is not there (unit: nanoseconds).
constexpr Nanoseconds look_again = 200'000'000;

// A device that says nothing for so long has frozen (unit: nanoseconds).
constexpr Nanoseconds frozen_after = 20'000'000;
constexpr Nanoseconds lost_after = 500'000'000;

constexpr Nanoseconds exchange_time = 5'000'000;

}  // namespace

DriverDevice::DriverDevice(std::unique_ptr<Driver> driver)
    : driver_(std::move(driver)), thread_([this] { run(); }) {}

DriverDevice::~DriverDevice() {
    stop_.store(true, std::memory_order_release);
    thread_.join();
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
    forces_.write(force, monotonic_now());
}

DriverHealth DriverDevice::health() const {
    const std::lock_guard lock(mutex_);
    DriverHealth health = health_;
    health.readings = count_.load(std::memory_order_relaxed);
    return health;
}

void DriverDevice::tell(DriverHealth::Phase phase, std::string text) {
    const std::lock_guard lock(mutex_);
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
        std::string problem = driver_->open(stop_);
        if (problem.empty()) {
            run_open();
            driver_->close();
            problem = "the device has gone: plug it in again, it goes on by itself";
            const std::lock_guard lock(mutex_);
            ++health_.times_lost;
        } else {
            driver_->close();
        }
        tell(DriverHealth::Phase::searching, std::move(problem));
        rest(look_again);
    }
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

}  // namespace tactus
