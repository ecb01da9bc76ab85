#include "network/link_emulator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus {

// The random numbers of one datagram, the same whatever the conditions make of them.
struct LinkEmulator::Luck {
    double loss, turn, burst_loss, duplication, reordering;  // in [0, 1)
    double jitter, copy;  // of the datagram and of its copy, as a share of LinkConditions::jitter
};

namespace {

constexpr int max_at_once = 1024;
constexpr Nanoseconds beginning = std::numeric_limits<Nanoseconds>::min();

// ln x for x > 0, to the last digits. Sums and quotients are rounded alike everywhere, which a library's
// logarithm is not: the same seed is the same network on every system. With x = m 2^e and s = (m - 1) / (m +
// 1), ln m = 2 (s + s^3 / 3 + s^5 / 5 + ...), |s| < 0.172.
double natural_logarithm(double x) {
    constexpr double ln_2 = 0.693147180559945309417;
    int exponent = 0;
    double mantissa = std::frexp(x, &exponent);  // in [1/2, 1)
    if (mantissa < 0.70710678118654752440) {
        mantissa *= 2.0;
        --exponent;
    }
    const double s = (mantissa - 1.0) / (mantissa + 1.0);
    const double square = s * s;
    double sum = 0.0;
    for (int k = 21; k >= 1; k -= 2) {
        sum = sum * square + 1.0 / k;
    }
    return 2.0 * s * sum + exponent * ln_2;
}

// splitmix64 (Steele, Lea & Flood 2014), begun anew for every datagram from the seed and its number, and for
// each `stream` of numbers of which there may be any count.
class Dice {
public:
    Dice(std::uint64_t seed, std::uint64_t number, std::uint64_t stream = 0)
        : state_(seed ^ scattered(number) ^ scattered(stream)) {}

    double unit() {
        state_ += 0x9e3779b97f4a7c15u;
        return static_cast<double>(scattered(state_) >> 11) * 0x1p-53;
    }

    // Mean 0, variance 1, by the polar method (Marsaglia and Bray 1964).
    double normal() {
        for (;;) {
            const double x = 2.0 * unit() - 1.0;
            const double y = 2.0 * unit() - 1.0;
            const double square = x * x + y * y;
            if (square > 0.0 && square < 1.0) {
                return x * std::sqrt(-2.0 * natural_logarithm(square) / square);
            }
        }
    }

private:
    std::uint64_t state_;
};

// Pareto with exponent 4 has a finite variance. u^(-1/4) - 1 has mean 1/3 for u even in (0, 1].
double heavy_tail(double unit) {
    return 3.0 * (1.0 / std::sqrt(std::sqrt(1.0 - unit)) - 1.0);
}

// What one datagram is later by, as a share of the jitter. Each has a stream of its own, so that nothing else
// depends on the shape.
double jitter_share(JitterShape shape, std::uint64_t seed, std::uint64_t number, std::uint64_t stream) {
    Dice dice(seed, number, stream);
    switch (shape) {
        case JitterShape::uniform:
            return 2.0 * dice.unit() - 1.0;
        case JitterShape::normal:
            return dice.normal();
        case JitterShape::heavy_tail:
            return heavy_tail(dice.unit());
        case JitterShape::trace:
            break;
    }
    return 0.0;
}

}  // namespace

LinkEmulator::LinkEmulator(Link& inner, const LinkConditions& conditions, std::uint64_t seed,
                           std::size_t capacity)
    : inner_(inner),
      conditions_(conditions),
      changed_(conditions),
      seed_(seed),
      capacity_(std::max<std::size_t>(capacity, 2)),
      store_(capacity_ + capacity_ / 2) {
    under_way_.reserve(capacity_);
    line_free_ = newest_due_ = beginning;
}

ReceivedDatagram LinkEmulator::receive(std::span<std::byte> into, Nanoseconds now) {
    if (changed_.refresh()) {
        conditions_ = changed_.front();
    }
    admit(now);
    while (!under_way_.empty() && under_way_.front().due <= now) {
        std::pop_heap(under_way_.begin(), under_way_.end(), later);
        const UnderWay first = under_way_.back();
        under_way_.pop_back();
        const bool fits = first.bytes <= into.size();
        store_.take(first.place, first.bytes, fits ? into.first(first.bytes) : std::span<std::byte>());
        if (fits) {
            ++counts_.delivered;
            return {first.bytes, first.due};
        }
        ++counts_.no_room;
    }
    return {};
}

// Takes over what the link below has; a flood is spread over ticks.
void LinkEmulator::admit(Nanoseconds now) {
    for (int i = 0; i < max_at_once; ++i) {
        const ReceivedDatagram received = inner_.receive(incoming_, now);
        if (!received) {
            return;
        }
        ++counts_.arrived;
        decide(std::span(incoming_).first(received.bytes), received.arrived);
    }
}

void LinkEmulator::decide(std::span<const std::byte> datagram, Nanoseconds arrived) {
    Dice dice(seed_, counts_.arrived);
    Luck luck;
    luck.loss = dice.unit();
    luck.turn = dice.unit();
    luck.burst_loss = dice.unit();
    luck.duplication = dice.unit();
    luck.reordering = dice.unit();
    luck.jitter = jitter_share(conditions_.shape, seed_, counts_.arrived, 1);
    luck.copy = jitter_share(conditions_.shape, seed_, counts_.arrived, 2);

    Nanoseconds leaves = arrived;
    const std::optional<Nanoseconds> recorded = recorded_delay();
    // The burst model goes on with each datagram, also with those that the trace has lost.
    if (is_lost(luck) || recorded == DelayTrace::lost) {
        ++counts_.lost;
        return;
    }
    if (!pass_narrow_place(datagram.size() + inner_.overhead(), leaves)) {
        ++counts_.squeezed;
        return;
    }
    const bool held_back = luck.reordering < conditions_.reordering;
    counts_.held_back += held_back ? 1 : 0;
    const Nanoseconds on_top = recorded.value_or(0);
    schedule(datagram, leaves, delayed_by(luck.jitter) + on_top, held_back);
    if (luck.duplication < conditions_.duplication) {
        ++counts_.duplicated;
        schedule(datagram, leaves, delayed_by(luck.copy) + on_top, false);
    }
}

// Of the datagram that has arrived last: one entry for each, lost or not. A copy takes as long.
std::optional<Nanoseconds> LinkEmulator::recorded_delay() const {
    if (conditions_.shape != JitterShape::trace || conditions_.trace == nullptr) {
        return std::nullopt;
    }
    const std::vector<Nanoseconds>& delays = conditions_.trace->delays;
    return delays[(counts_.arrived - 1) % delays.size()];
}

bool LinkEmulator::is_lost(const Luck& luck) {
    bad_ = bad_ ? luck.turn >= conditions_.burst.leave : luck.turn < conditions_.burst.enter;
    return luck.loss < conditions_.loss || (bad_ && luck.burst_loss < conditions_.burst.loss_while);
}

// `time`: when the datagram gets there, and then when its last bit is through.
bool LinkEmulator::pass_narrow_place(std::size_t bytes, Nanoseconds& time) {
    if (!(conditions_.rate > 0.0)) {
        return true;
    }
    const Nanoseconds begins = std::max(time, line_free_);
    if (begins - time > conditions_.max_waiting) {
        return false;
    }
    line_free_ = begins + from_seconds(8.0 * static_cast<double>(bytes) / conditions_.rate);
    time = line_free_;
    return true;
}

Nanoseconds LinkEmulator::delayed_by(double share) const {
    const auto extra = static_cast<Nanoseconds>(share * static_cast<double>(conditions_.jitter));
    return std::max<Nanoseconds>(conditions_.delay + extra, 0);
}

void LinkEmulator::schedule(std::span<const std::byte> datagram, Nanoseconds leaves, Nanoseconds delay,
                            bool held_back) {
    if (under_way_.size() == capacity_ || !store_.has_room_for(datagram.size())) {
        ++counts_.no_room;
        return;
    }
    Nanoseconds due = leaves + delay;
    if (held_back) {
        due += conditions_.reorder_by;
    } else if (conditions_.keep_order) {
        due = std::max(due, newest_due_);
    }
    newest_due_ = held_back ? newest_due_ : std::max(newest_due_, due);
    under_way_.push_back(
        {due, scheduled_++, store_.put(datagram), static_cast<std::uint32_t>(datagram.size())});
    std::push_heap(under_way_.begin(), under_way_.end(), later);
}

}  // namespace tactus
