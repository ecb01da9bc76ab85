#include "network/sample_stream.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <limits>

#include "network/plausibility.hpp"

namespace tactus {
namespace {

constexpr double all_lost = 1e-4;  // the share of samples that may be lost with all of their repeats
constexpr std::uint32_t least_repeats = 2;

std::uint32_t repeats_for(double lost) {
    if (lost <= 0.0) {
        return least_repeats;
    }
    const double packets = std::ceil(std::log(all_lost) / std::log(std::min(lost, 0.9)));
    return std::max(least_repeats, static_cast<std::uint32_t>(packets) - 1);
}

// One that may not be sent must not keep the others of its packet back.
bool is_plausible(const OperatorSample& sample) {
    const auto within = [](const Vec3& value, double most) {
        return glm::all(glm::lessThanEqual(glm::abs(value), Vec3(most)));  // false for what is no number
    };
    return within(sample.position, plausible::max_position) &&
           within(sample.velocity, plausible::max_speed) &&
           within(sample.position_in_object, plausible::max_position) &&
           within(sample.force, std::numeric_limits<double>::max()) &&
           (!sample.has_turn || within(sample.spin, plausible::max_angular_speed));
}

}  // namespace

SampleStream::SampleStream(const SampleStreamSettings& settings)
    : settings_(settings),
      pointers_(std::max(1u, settings.max_pointers)),
      repeats_(least_repeats),
      affordable_(least_repeats) {}

void SampleStream::add(const OperatorSample& sample) {
    if (sample.pointer >= pointers_.size() || !is_plausible(sample)) {
        return;
    }
    Pointer& pointer = pointers_[sample.pointer];
    std::shift_right(pointer.samples.begin(), pointer.samples.end(), 1);
    pointer.samples[0] = sample;
    pointer.samples[0].force = glm::clamp(sample.force, -plausible::max_force, plausible::max_force);
    const auto most = static_cast<std::uint32_t>(pointer.samples.size());
    pointer.count = std::min(pointer.count + 1, most);
    pointer.waiting = std::min(pointer.waiting + 1, most);
}

void SampleStream::end_tick(Endpoint& link, Nanoseconds now) {
    pace_.adapt(link, now);
    // Where a queue is the trouble, repeats make it longer.
    const std::uint32_t wanted = repeats_for(link.statistics().lost_there);
    repeats_ = pace_.queues() ? 0 : std::min({settings_.max_repeats, wanted, affordable_});
    if (++tick_ % pace_.stride() == 0) {
        keep_to_budget(send(link));
    }
}

void SampleStream::restart() {
    for (Pointer& pointer : pointers_) {
        pointer.count = pointer.waiting = 0;
    }
    pace_.restart();
    repeats_ = affordable_ = least_repeats;
}

// One more or less of each sample than last time.
void SampleStream::keep_to_budget(const Sent& sent) {
    if (sent.samples == 0) {
        return;
    }
    const double seconds = to_seconds(settings_.period) * pace_.stride();
    const double allowed = settings_.max_bits_per_s / 8.0 * seconds * sent.pointers;
    const auto bytes = static_cast<double>(sent.bytes);
    const double of_a_sample = bytes / sent.samples;
    if (bytes > allowed) {
        affordable_ -= affordable_ > 0 ? 1 : 0;
    } else if (bytes + of_a_sample * pace_.stride() * sent.pointers <= allowed) {
        affordable_ = std::min(affordable_ + 1, settings_.max_repeats);
    }
}

// Samples of earlier packets in one of `stride` ticks. Who asks whether sending less helps sends half as many
// packets, and none of them is larger for it.
std::uint32_t SampleStream::older() const {
    if (pace_.asks()) {
        return repeats_ > 0 ? pace_.stride() / 2 * (repeats_ - 1) : 0;
    }
    return repeats_ * pace_.stride();
}

SampleStream::Sent SampleStream::send(Endpoint& link) {
    const std::uint64_t bytes_before = link.statistics().bytes_sent;
    const std::uint64_t packets_before = link.statistics().packets_sent;
    Sent sent;
    OperatorSamples message;
    message.period = settings_.period;
    for (Pointer& pointer : pointers_) {
        if (pointer.waiting == 0) {
            continue;
        }
        const std::uint32_t wanted = std::min(pointer.count, pointer.waiting + older());
        const bool goes_apart =
            message.count > 0 && message.samples[0].has_turn != pointer.samples[0].has_turn;
        if (goes_apart || message.count + wanted > OperatorSamples::max_count) {
            send_message(link, message);
        }
        const auto room = std::min<std::uint32_t>(wanted, OperatorSamples::max_count);
        std::copy_n(pointer.samples.begin(), room, message.samples.begin() + message.count);
        message.count = static_cast<std::uint8_t>(message.count + room);
        pointer.waiting = 0;
        ++sent.pointers;
        sent.samples += room;
    }
    send_message(link, message);
    const LinkStatistics& now = link.statistics();
    sent.bytes = now.bytes_sent - bytes_before + (now.packets_sent - packets_before) * link.overhead();
    return sent;
}

// What does not fit at its longest goes in two.
void SampleStream::send_message(Endpoint& link, OperatorSamples& message) const {
    if (message.count > 0 && !link.send(message) && message.count > 1) {
        OperatorSamples half = message;
        half.count = message.count / 2;
        std::copy(message.samples.begin() + half.count, message.samples.begin() + message.count,
                  message.samples.begin());
        message.count = static_cast<std::uint8_t>(message.count - half.count);
        link.send(half);
        link.send(message);
    }
    message.count = 0;
}

}  // namespace tactus
