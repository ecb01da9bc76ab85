#include "devices/force_slot.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// Steps of running quantiles that ninety-nine of a hundred values do not exceed (unit: nanoseconds).
constexpr Nanoseconds quantile_down = 200;
constexpr Nanoseconds quantile_up = 99 * quantile_down;
constexpr Nanoseconds least_lead = 20'000;

// A force that returns takes no longer steps than those of a device that is asked a thousand times a second.
constexpr Nanoseconds longest_return_step = 1'000'000;

Vec3 towards(const Vec3& from, const Vec3& to, double step) {
    const Vec3 change = to - from;
    const double length = glm::length(change);
    return length <= step ? to : from + change * (step / length);
}

}  // namespace

void ForceSlot::begin(const DeviceCapabilities& device, bool is_paced) {
    const bool has_rate = is_paced && device.rate > 0.0;
    declared_ = period_ = has_rate ? from_seconds(1.0 / device.rate) : 0;
    exchange_.store(declared_, std::memory_order_relaxed);
    read_.store(0, std::memory_order_release);
    is_too_slow_.store(false, std::memory_order_relaxed);
    slew_ = device.max_slew;
    torque_slew_ = device.max_torque_slew;
    displayed_ = given_ = {};
    given_at_ = 0;
    returns_ = true;
    end_ = 0;
    switch_on(0);
}

// While the loop writes; else drivers read as seldom as they like.
void ForceSlot::heard(Nanoseconds read_at, Nanoseconds now) {
    const Nanoseconds before = read_.exchange(read_at, std::memory_order_acq_rel);
    heard_.store(now, std::memory_order_release);
    if (before != 0 && read_at > before && written_.load(std::memory_order_acquire) > before) {
        measure_period(read_at - before);
    }
}

void ForceSlot::measure_period(Nanoseconds from_reading_to_reading) {
    const Nanoseconds step = from_reading_to_reading > period_ ? quantile_up : -quantile_down;
    period_ = std::clamp(period_ + step, declared_, longest_exchange);
    const Nanoseconds tick = tick_.load(std::memory_order_acquire);
    const bool goes_in_step = declared_ == 0 && period_ <= tick * 3 / 2;
    exchange_.store(goes_in_step ? 0 : period_, std::memory_order_relaxed);
    const bool was_too_slow = is_too_slow_.load(std::memory_order_relaxed);
    is_too_slow_.store(period_ >= (was_too_slow ? longest_exchange * 4 / 5 : longest_exchange),
                       std::memory_order_relaxed);
}

Vec3 ForceSlot::living(Nanoseconds now) {
    const bool is_new = commands_.refresh();
    const ForceCommand& command = commands_.front();
    const ForceLife life = this->life();
    const Nanoseconds heard = heard_.load(std::memory_order_acquire);
    const bool is_safe = tick_.load(std::memory_order_acquire) > 0 && command.written_at != 0 &&
                         !is_too_slow_.load(std::memory_order_relaxed);
    const Nanoseconds end = std::min(command.written_at + life.written, heard + life.heard);
    const bool lives = lives_ = is_safe && now <= end;
    if (is_new) {
        aim_reading(command);
    }
    // In this order, and taken() before due(): of a look and a watchdog at the same time one sees the other.
    looked_.store(now);
    if (is_taken_.exchange(false)) {
        displayed_ = given_ = {};
        returns_ = true;
    } else if (!lives && displayed_ != Wrench{}) {
        cut(now > command.written_at + life.written ? ForceCut::loop_silent : ForceCut::device_silent);
    }
    const Wrench wanted = lives ? Wrench{command.force, command.torque} : Wrench{};
    if (!lives) {
        displayed_ = given_ = {};
        returns_ = true;
    } else if (returns_) {
        // From what the device has: not every look is followed by a packet.
        const Nanoseconds since = now - given_at_;
        const double seconds = to_seconds(std::clamp<Nanoseconds>(since, 1, longest_return_step));
        displayed_.force = towards(given_.force, wanted.force, slew_ * seconds);
        displayed_.torque = towards(given_.torque, wanted.torque, torque_slew_ * seconds);
        returns_ = displayed_ != wanted;
    } else {
        displayed_ = wanted;
    }
    end_ = displayed_ != Wrench{} ? end : 0;
    watch();
    return displayed_.force;
}

void ForceSlot::watch() {
    switch_on(displayed_ != Wrench{} ? 1 : 0);
}

// Nothing is switched on any more after end_wait().
void ForceSlot::switch_on(std::int64_t on) {
    std::int64_t before = is_on_.load(std::memory_order_relaxed);
    while (before >= 0 && before != on &&
           !is_on_.compare_exchange_weak(before, on, std::memory_order_acq_rel)) {
    }
    if (before == 0 && on == 1) {
        wake_all(is_on_);
    }
}

void ForceSlot::given(Nanoseconds now) {
    given_ = displayed_;
    given_at_ = now;
    const ForceCommand& command = commands_.front();
    if (command.read_at != 0 && command.read_at != measured_) {
        measured_ = command.read_at;
        const Nanoseconds delay = now - command.read_at;
        delays_.add(delay);
        const Nanoseconds lag = lag_.load(std::memory_order_relaxed);
        lag_.store(std::max<Nanoseconds>(0, lag + (delay > lag ? quantile_up : -quantile_down)),
                   std::memory_order_relaxed);
    }
    shown_.publish({displayed_, now});
    to_loop_.publish(displayed_);
}

// The loop has looked: was the newest reading there?
void ForceSlot::aim_reading(const ForceCommand& command) {
    const Nanoseconds tick = tick_.load(std::memory_order_relaxed);
    const bool is_missed = command.read_at < read_.load(std::memory_order_acquire);
    lead_ = std::clamp(lead_ + (is_missed ? quantile_up : -quantile_down), least_lead,
                       std::max(least_lead, tick * 9 / 10));
}

Nanoseconds ForceSlot::next_look() const {
    const ForceCommand& command = commands_.front();
    const Nanoseconds tick = tick_.load(std::memory_order_relaxed);
    return command.looked_at == 0 || tick == 0 ? 0 : command.looked_at + tick;
}

Nanoseconds ForceSlot::next_reading() const {
    const Nanoseconds look = next_look();
    return look == 0 ? 0 : look - lead_;
}

// The thread that sends forces may still be at it: it begins anew with its next one.
void ForceSlot::rest() {
    is_taken_.store(true, std::memory_order_release);
    switch_on(0);
}

void ForceSlot::cut(ForceCut why) {
    cuts_[static_cast<std::size_t>(why)].fetch_add(1, std::memory_order_relaxed);
}

ForceSlot::Due ForceSlot::due() const {
    if (is_on_.load(std::memory_order_acquire) != 1) {
        return {};
    }
    const ForceLife life = this->life();
    const Nanoseconds looked = looked_.load();
    const Nanoseconds written = written_.load(std::memory_order_acquire);
    return {looked, std::min(written + life.written, looked + life.sent) + life.grace};
}

// Of one that the driver has not cut itself: the reason is that it was late, or that the loop was.
void ForceSlot::note_taken(Nanoseconds now) {
    const bool is_loop_silent = now > written_.load(std::memory_order_acquire) + life().written;
    cut(is_loop_silent ? ForceCut::loop_silent : ForceCut::driver_stuck);
}

void ForceSlot::end_wait() {
    is_on_.store(-1, std::memory_order_release);
    wake_all(is_on_);
}

ForceSlot::Cuts ForceSlot::cuts() const {
    Cuts cuts{};
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        cuts[i] = cuts_[i].load(std::memory_order_relaxed);
    }
    return cuts;
}

}  // namespace tactus
