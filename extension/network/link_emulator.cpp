#include "network/link_emulator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus {

// The random numbers of one datagram: always the same count, whatever the conditions make of them.
struct LinkEmulator::Luck {
    double loss, turn, burst_loss, duplication, reordering;  // in [0, 1)
    double jitter_unit, jitter_normal;                       // of the datagram
    double copy_unit, copy_normal;                           // of its copy
};

namespace {

constexpr int max_at_once = 1024;
constexpr Nanoseconds beginning = std::numeric_limits<Nanoseconds>::min();

// splitmix64 (Steele, Lea & Flood 2014), begun anew for every datagram from the seed and its number.
class Dice {
public:
    Dice(std::uint64_t seed, std::uint64_t number) : state_(seed ^ mixed(number)) {}

    double unit() {
        state_ += 0x9e3779b97f4a7c15u;
        return static_cast<double>(mixed(state_) >> 11) * 0x1p-53;
    }

    // The sum of twelve has mean 6 and variance 1, and its bits do not depend on a library's logarithm.
    double normal() {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i) {
            sum += unit();
        }
        return sum;
    }

private:
    static std::uint64_t mixed(std::uint64_t z) {
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }

    std::uint64_t state_;
};

// Pareto with exponent 4 has a finite variance. u^(-1/4) - 1 has mean 1/3 for u even in (0, 1].
double heavy_tail(double unit) {
    return 3.0 * (1.0 / std::sqrt(std::sqrt(1.0 - unit)) - 1.0);
}

}  // namespace

LinkEmulator::LinkEmulator(Link& inner, const LinkConditions& conditions, std::uint64_t seed,
                           std::size_t capacity)
    : inner_(inner),
      conditions_(conditions),
      changed_(conditions),
      seed_(seed),
      slots_(std::max<std::size_t>(capacity, 2)) {
    free_.reserve(slots_.size());
    under_way_.reserve(slots_.size());
    for (std::size_t slot = slots_.size(); slot > 0; --slot) {
        free_.push_back(static_cast<std::uint32_t>(slot - 1));
    }
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
        free_.push_back(first.slot);
        const Datagram& datagram = slots_[first.slot];
        if (datagram.size <= into.size()) {
            std::memcpy(into.data(), datagram.bytes.data(), datagram.size);
            ++counts_.delivered;
            return {datagram.size, first.due};
        }
        ++counts_.no_room;
    }
    return {};
}

// Takes over what the link below has; a flood is spread over ticks. One slot stays free to look at the next
// datagram in.
void LinkEmulator::admit(Nanoseconds now) {
    for (int i = 0; i < max_at_once; ++i) {
        const std::uint32_t slot = free_.back();
        Datagram& datagram = slots_[slot];
        const ReceivedDatagram received = inner_.receive(datagram.bytes, now);
        if (!received) {
            return;
        }
        ++counts_.arrived;
        datagram.size = received.bytes;
        datagram.arrived = received.arrived;
        decide(slot);
    }
}

void LinkEmulator::decide(std::uint32_t slot) {
    Dice dice(seed_, counts_.arrived);
    Luck luck;
    luck.loss = dice.unit();
    luck.turn = dice.unit();
    luck.burst_loss = dice.unit();
    luck.duplication = dice.unit();
    luck.reordering = dice.unit();
    luck.jitter_unit = dice.unit();
    luck.jitter_normal = dice.normal();
    luck.copy_unit = dice.unit();
    luck.copy_normal = dice.normal();

    Nanoseconds leaves = slots_[slot].arrived;
    if (is_lost(luck)) {
        ++counts_.lost;
        return;
    }
    if (!pass_narrow_place(slots_[slot].size, leaves)) {
        ++counts_.squeezed;
        return;
    }
    Nanoseconds delay = jittered(luck.jitter_unit, luck.jitter_normal);
    if (conditions_.shape == JitterShape::trace && conditions_.trace != nullptr) {
        const Nanoseconds recorded =
            conditions_.trace->delays[trace_at_++ % conditions_.trace->delays.size()];
        if (recorded == DelayTrace::lost) {
            ++counts_.lost;
            return;
        }
        delay = conditions_.delay + recorded;
    }
    const bool held_back = luck.reordering < conditions_.reordering;
    counts_.held_back += held_back ? 1 : 0;
    schedule(slot, leaves, delay, held_back);
    if (luck.duplication < conditions_.duplication) {
        copy(slot, leaves, luck);
    }
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

Nanoseconds LinkEmulator::jittered(double unit, double normal) const {
    double share = 0.0;
    switch (conditions_.shape) {
        case JitterShape::uniform:
            share = 2.0 * unit - 1.0;
            break;
        case JitterShape::normal:
            share = normal;
            break;
        case JitterShape::heavy_tail:
            share = heavy_tail(unit);
            break;
        case JitterShape::trace:
            break;
    }
    const auto extra = static_cast<Nanoseconds>(share * static_cast<double>(conditions_.jitter));
    return std::max<Nanoseconds>(conditions_.delay + extra, 0);
}

// Takes `slot`, which is the last free one.
void LinkEmulator::schedule(std::uint32_t slot, Nanoseconds leaves, Nanoseconds delay, bool held_back) {
    if (free_.size() == 1) {
        ++counts_.no_room;
        return;
    }
    free_.pop_back();
    Nanoseconds due = leaves + delay;
    if (held_back) {
        due += conditions_.reorder_by;
    } else if (conditions_.keep_order) {
        due = std::max(due, newest_due_);
    }
    newest_due_ = held_back ? newest_due_ : std::max(newest_due_, due);
    under_way_.push_back({due, scheduled_++, slot});
    std::push_heap(under_way_.begin(), under_way_.end(), later);
}

void LinkEmulator::copy(std::uint32_t slot, Nanoseconds leaves, const Luck& luck) {
    const std::uint32_t twin = free_.back();
    if (twin == slot) {
        return;  // the original found no room either
    }
    slots_[twin] = slots_[slot];
    ++counts_.duplicated;
    schedule(twin, leaves, jittered(luck.copy_unit, luck.copy_normal), false);
}

}  // namespace tactus
