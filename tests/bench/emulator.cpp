// Whether the emulated network does what it is asked, over a million datagrams a case: ./run bench emulator
// [--packets=1000000] [--only=CASE]
//
// The judge knows distributions in closed form and nothing of the emulator's own. CASE.FIGURE_z is by how
// many standard deviations of chance a figure is off, CASE.FIGURE_wrong how many datagrams are not exactly
// what they have to be. The exit code is 1 where one is beyond chance.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "network/link_emulator.hpp"
#include "shared/bench_kit.hpp"

namespace {

using namespace tactus;
using namespace tactus::shared;

constexpr Nanoseconds ms = 1'000'000;
constexpr std::size_t bytes = 100;
// Of some hundred figures none is beyond by chance: once in a million and a half.
constexpr double beyond_chance = 5.0;

struct Arrival {
    std::uint32_t number = 0;
    Nanoseconds delay = 0;
};

struct Played {
    std::vector<Arrival> arrivals;  // in the order in which they were taken
    EmulatorCounts counts;
};

// One datagram a millisecond, and on until all is there that will come.
Played play(const LinkConditions& conditions, std::uint32_t count, std::uint64_t seed = 1) {
    MemoryLinkPair pair(1 << 10);
    LinkEmulator emulator(pair.second(), conditions, seed);
    Played played;
    std::array<std::byte, bytes> datagram{};
    std::array<std::byte, max_datagram_bytes> buffer;
    for (std::int64_t tick = 0; tick < static_cast<std::int64_t>(count) + 60'000; ++tick) {
        const Nanoseconds now = tick * ms;
        if (tick < static_cast<std::int64_t>(count)) {
            const auto number = static_cast<std::uint32_t>(tick);
            std::memcpy(datagram.data(), &number, sizeof number);
            pair.first().send(datagram, now);
        }
        while (const ReceivedDatagram received = emulator.receive(buffer, now)) {
            Arrival arrival;
            std::memcpy(&arrival.number, buffer.data(), sizeof arrival.number);
            arrival.delay = received.arrived - arrival.number * ms;
            played.arrivals.push_back(arrival);
        }
    }
    played.counts = emulator.counts();
    return played;
}

class Judge {
public:
    Judge(std::uint32_t count, std::string only) : count_(count), only_(std::move(only)) {}

    bool begins(const std::string& name) {
        case_ = name;
        return is_chosen(name, only_);
    }
    std::uint32_t count() const { return count_; }
    double packets() const { return count_; }

    void z(const std::string& figure, double value) {
        report_.set(case_ + "." + figure + "_z", value);
        judge(figure, value, std::abs(value) <= beyond_chance);
    }
    void wrong(const std::string& figure, std::uint64_t number) {
        report_.set(case_ + "." + figure + "_wrong", static_cast<double>(number));
        judge(figure, static_cast<double>(number), number == 0);
    }
    // A share p of n.
    void share(const std::string& figure, double found, double n, double p) {
        z(figure, (found - n * p) / std::sqrt(n * p * (1.0 - p)));
    }
    // Numbers that are spread evenly over [0, 1): chi-square over a hundred bins, as normal deviate (Wilson
    // and Hilferty 1931), and the correlation of each with the next one.
    void even(const std::string& figure, const std::vector<double>& values) {
        constexpr std::size_t bins = 100;
        std::array<double, bins> found{};
        double products = 0.0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double place = std::clamp(values[i], 0.0, 1.0 - 1e-12);
            ++found[static_cast<std::size_t>(place * bins)];
            products += i > 0 ? (values[i] - 0.5) * (values[i - 1] - 0.5) : 0.0;
        }
        const double expected = static_cast<double>(values.size()) / bins;
        double chi_square = 0.0;
        for (const double number : found) {
            chi_square += (number - expected) * (number - expected) / expected;
        }
        constexpr double freedom = bins - 1;
        constexpr double spread = 2.0 / (9.0 * freedom);
        z(figure + "_chi_square", (std::cbrt(chi_square / freedom) - (1.0 - spread)) / std::sqrt(spread));
        z(figure + "_next_one", products * 12.0 / std::sqrt(static_cast<double>(values.size())));
    }
    bool all_hold() const { return failures_ == 0; }
    const Report& report() const { return report_; }

private:
    void judge(const std::string& figure, double value, bool holds) {
        failures_ += holds ? 0 : 1;
        std::printf("  %-12s %-28s %8.2f%s\n", case_.c_str(), figure.c_str(), value,
                    holds ? "" : "  BEYOND CHANCE");
    }

    std::uint32_t count_;
    std::string only_, case_;
    Report report_;
    int failures_ = 0;
};

double share_below_normal(double deviations) {
    return 0.5 * std::erfc(-deviations / std::sqrt(2.0));
}

// By the share of jitter that a datagram is later by, what share of all is earlier.
using Distribution = std::function<double(double)>;

void judge_jitter(Judge& judge, const LinkConditions& conditions, const Distribution& share_below) {
    const Played played = play(conditions, judge.count());
    judge.wrong("missing", judge.count() - played.arrivals.size());
    std::vector<double> by_number(judge.count());
    for (const Arrival& arrival : played.arrivals) {
        const double later =
            static_cast<double>(arrival.delay - conditions.delay) / static_cast<double>(conditions.jitter);
        by_number[arrival.number] = share_below(later);
    }
    judge.even("shape", by_number);
}

void judge_delays(Judge& judge) {
    for (const Nanoseconds delay : {Nanoseconds{0}, Nanoseconds{123'457}, 100 * ms, 10'000 * ms}) {
        const bool is_whole = delay % ms == 0;
        if (!judge.begins("delay_" + std::to_string(is_whole ? delay / ms : delay) +
                          (is_whole ? "ms" : "ns"))) {
            continue;
        }
        LinkConditions conditions;
        conditions.delay = delay;
        const Played played = play(conditions, judge.count());
        judge.wrong("missing", judge.count() - played.arrivals.size());
        judge.wrong("delay", static_cast<std::uint64_t>(std::ranges::count_if(
                                 played.arrivals, [&](const Arrival& a) { return a.delay != delay; })));
    }
}

void judge_shapes(Judge& judge) {
    LinkConditions conditions;
    conditions.delay = 100 * ms;
    conditions.jitter = 10 * ms;
    if (judge.begins("uniform")) {
        judge_jitter(judge, conditions, [](double later) { return 0.5 + 0.5 * later; });
    }
    conditions.shape = JitterShape::heavy_tail;
    if (judge.begins("heavy_tail")) {
        judge_jitter(judge, conditions, [](double later) { return 1.0 - std::pow(1.0 + later / 3.0, -4.0); });
    }
    conditions.shape = JitterShape::normal;
    if (judge.begins("normal")) {
        judge_jitter(judge, conditions, share_below_normal);
        const Played played = play(conditions, judge.count());
        for (const int deviations : {3, 4, 5}) {
            const auto beyond =
                static_cast<double>(std::ranges::count_if(played.arrivals, [&](const Arrival& a) {
                    return std::abs(static_cast<double>(a.delay - conditions.delay)) >
                           deviations * static_cast<double>(conditions.jitter);
                }));
            const double expected = judge.packets() * 2.0 * share_below_normal(-deviations);
            // Anscombe's transform: also of few, the square root is nearly normal.
            judge.z("beyond_" + std::to_string(deviations) + "_deviations",
                    2.0 * (std::sqrt(beyond + 0.375) - std::sqrt(expected + 0.375)));
        }
    }
}

void judge_losses(Judge& judge) {
    for (const double loss : {0.001, 0.1, 0.5}) {
        if (judge.begins("loss_" + std::to_string(static_cast<int>(1000.0 * loss)) + "permille")) {
            LinkConditions conditions;
            conditions.loss = loss;
            const Played played = play(conditions, judge.count());
            judge.share("share", judge.packets() - static_cast<double>(played.arrivals.size()),
                        judge.packets(), loss);
            double pairs = 0.0;
            for (std::size_t i = 1; i < played.arrivals.size(); ++i) {
                pairs += std::max(
                    0.0,
                    static_cast<double>(played.arrivals[i].number - played.arrivals[i - 1].number) - 2.0);
            }
            // Two in a row: of each such pair, p^2 (1 - p^2) + 2 p^3 (1 - p) is the variance with its
            // neighbors.
            const double mean = judge.packets() * loss * loss;
            const double variance =
                judge.packets() * (loss * loss * (1 - loss * loss) + 2 * loss * loss * loss * (1 - loss));
            judge.z("two_in_a_row", (pairs - mean) / std::sqrt(variance));
        }
    }
    for (const double length : {3.0, 30.0}) {
        if (judge.begins("bursts_of_" + std::to_string(static_cast<int>(length)))) {
            constexpr double share = 0.1;
            LinkConditions conditions;
            conditions.burst = bursts(share, length);
            const Played played = play(conditions, judge.count());
            const double lost = judge.packets() - static_cast<double>(played.arrivals.size());
            const double stays = 1.0 - conditions.burst.enter - conditions.burst.leave;
            judge.z("share",
                    (lost - judge.packets() * share) /
                        std::sqrt(judge.packets() * share * (1 - share) * (1 + stays) / (1 - stays)));
            double found = 0.0, inside = 0.0;
            for (std::size_t i = 1; i < played.arrivals.size(); ++i) {
                const double gap =
                    static_cast<double>(played.arrivals[i].number - played.arrivals[i - 1].number) - 1.0;
                found += gap > 0.0 ? 1.0 : 0.0;
                inside += gap;
            }
            judge.z("length", (inside / found - length) / std::sqrt((length * length - length) / found));
        }
    }
}

void judge_copies(Judge& judge) {
    if (!judge.begins("duplication")) {
        return;
    }
    LinkConditions conditions;
    conditions.delay = 100 * ms;
    conditions.jitter = 10 * ms;
    conditions.duplication = 0.25;
    const Played played = play(conditions, judge.count());
    std::vector<std::vector<double>> by_number(judge.count());
    for (const Arrival& arrival : played.arrivals) {
        by_number[arrival.number].push_back(0.5 + 0.5 *
                                                      static_cast<double>(arrival.delay - conditions.delay) /
                                                      static_cast<double>(conditions.jitter));
    }
    std::vector<double> all;
    double twice = 0.0, apart = 0.0;
    std::uint64_t others = 0;
    for (const std::vector<double>& delays : by_number) {
        all.insert(all.end(), delays.begin(), delays.end());
        others += delays.size() == 1 || delays.size() == 2 ? 0 : 1;
        if (delays.size() == 2) {
            twice += 1.0;
            apart += std::abs(delays[0] - delays[1]);
        }
    }
    judge.wrong("neither_once_nor_twice", others);
    judge.share("share", twice, judge.packets(), conditions.duplication);
    // The distance of two even numbers has mean 1/3 and variance 1/18.
    judge.z("copy_has_its_own_delay", (apart / twice - 1.0 / 3.0) / std::sqrt(1.0 / 18.0 / twice));
    std::shuffle(all.begin(), all.end(), std::mt19937_64(1));
    judge.even("shape", all);
}

void judge_order(Judge& judge) {
    LinkConditions conditions;
    conditions.delay = 50 * ms;
    if (judge.begins("reordering")) {
        conditions.reordering = 0.1;
        conditions.reorder_by = 7 * ms;
        const Played played = play(conditions, judge.count());
        double held = 0.0;
        std::uint64_t wrong = judge.count() - played.arrivals.size();
        for (const Arrival& arrival : played.arrivals) {
            held += arrival.delay == 57 * ms ? 1.0 : 0.0;
            wrong += arrival.delay == 57 * ms || arrival.delay == 50 * ms ? 0 : 1;
        }
        judge.share("share", held, judge.packets(), 0.1);
        judge.wrong("delay", wrong);
    }
    if (judge.begins("keep_order")) {
        conditions.jitter = 20 * ms;
        conditions.reordering = 0.0;
        const Played free = play(conditions, judge.count());
        conditions.keep_order = true;
        const Played kept = play(conditions, judge.count());
        // The same draws, each no earlier than all before it.
        std::vector<Nanoseconds> due(judge.count());
        for (const Arrival& arrival : free.arrivals) {
            due[arrival.number] = arrival.delay + arrival.number * ms;
        }
        for (std::size_t i = 1; i < due.size(); ++i) {
            due[i] = std::max(due[i], due[i - 1]);
        }
        std::uint64_t wrong = judge.count() - kept.arrivals.size();
        for (std::size_t i = 0; i < kept.arrivals.size(); ++i) {
            const Arrival& arrival = kept.arrivals[i];
            wrong +=
                arrival.number == i && arrival.delay + arrival.number * ms == due[arrival.number] ? 0 : 1;
        }
        judge.wrong("order_or_delay", wrong);
    }
}

void judge_rate(Judge& judge) {
    constexpr double wire_bits = 8.0 * (bytes + 28);  // with the headers of UDP and IPv4
    LinkConditions conditions;
    if (judge.begins("rate_enough")) {
        conditions.rate = 2e6;
        const Played played = play(conditions, judge.count());
        const auto takes = static_cast<Nanoseconds>(std::llround(1e9 * wire_bits / conditions.rate));
        judge.wrong("delay", static_cast<std::uint64_t>(std::ranges::count_if(
                                 played.arrivals, [&](const Arrival& a) { return a.delay != takes; })));
    }
    if (judge.begins("rate_too_low")) {
        conditions.rate = 305'000.0;
        conditions.max_waiting = 100 * ms;
        const Played played = play(conditions, judge.count());
        const double told =
            static_cast<double>(played.arrivals.size()) * wire_bits / (judge.packets() * 1e-3);
        // All along; only what waits at the end comes as well.
        judge.wrong("rate_off_by_more_than_a_thousandth",
                    std::abs(told / conditions.rate - 1.0) > 1e-3 ? 1 : 0);
        const auto longest = 100 * ms + static_cast<Nanoseconds>(1e9 * wire_bits / conditions.rate) + 1;
        judge.wrong("waited_too_long",
                    static_cast<std::uint64_t>(std::ranges::count_if(
                        played.arrivals, [&](const Arrival& a) { return a.delay > longest; })));
    }
}

void judge_trace(Judge& judge) {
    if (!judge.begins("trace")) {
        return;
    }
    DelayTrace trace;
    std::mt19937_64 random(2);
    for (int i = 0; i < 997; ++i) {
        trace.delays.push_back(i % 50 == 7 ? DelayTrace::lost
                                           : static_cast<Nanoseconds>(random() % 80'000'000));
    }
    LinkConditions conditions;
    conditions.delay = 5 * ms;
    conditions.shape = JitterShape::trace;
    conditions.trace = &trace;
    conditions.loss = 0.1;
    conditions.duplication = 0.2;
    const Played played = play(conditions, judge.count());
    std::uint64_t wrong = 0;
    for (const Arrival& arrival : played.arrivals) {
        const Nanoseconds recorded = trace.delays[arrival.number % trace.delays.size()];
        wrong += recorded != DelayTrace::lost && arrival.delay == conditions.delay + recorded ? 0 : 1;
    }
    judge.wrong("delay", wrong);
    double left = 0.0;
    for (std::uint32_t i = 0; i < judge.count(); ++i) {
        left += trace.delays[i % trace.delays.size()] == DelayTrace::lost ? 0.0 : 1.0;
    }
    const double originals = static_cast<double>(played.arrivals.size() - played.counts.duplicated);
    judge.share("loss", left - originals, left, 0.1);
    judge.share("duplication", static_cast<double>(played.counts.duplicated), originals, 0.2);
}

void judge_ways(Judge& judge) {
    if (!judge.begins("ways")) {
        return;
    }
    LinkConditions conditions;
    conditions.loss = 0.5;
    std::map<std::string, std::vector<double>> came;
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        for (const Way way : {Way::to_teleoperator, Way::to_operator}) {
            std::vector<double> one(judge.count(), -1.0);
            for (const Arrival& arrival : play(conditions, judge.count(), luck_of(seed, way)).arrivals) {
                one[arrival.number] = 1.0;
            }
            came[std::to_string(seed) + (way == Way::to_operator ? "_back" : "_forth")] = std::move(one);
        }
    }
    for (const auto& [name, one] : came) {
        for (const auto& [other_name, other] : came) {
            if (name < other_name) {
                double sum = 0.0;
                for (std::size_t i = 0; i < one.size(); ++i) {
                    sum += one[i] * other[i];
                }
                judge.z(name + "_and_" + other_name, sum / std::sqrt(judge.packets()));
            }
        }
    }
}

void judge_together(Judge& judge) {
    for (const Nanoseconds delay : {100 * ms, 10'000 * ms}) {
        if (!judge.begins("together_" + std::to_string(delay / ms) + "ms")) {
            continue;
        }
        LinkConditions conditions;
        conditions.delay = delay;
        conditions.jitter = 20 * ms;
        conditions.loss = 0.05;
        conditions.burst = bursts(0.05, 10.0);
        conditions.duplication = 0.1;
        conditions.reordering = 0.05;
        conditions.reorder_by = 1'000 * ms;  // tells those apart that were held back
        const Played played = play(conditions, judge.count());
        judge.wrong("no_room", played.counts.no_room);
        const double originals = static_cast<double>(played.arrivals.size() - played.counts.duplicated);
        const double stays = 1.0 - conditions.burst.enter - conditions.burst.leave;
        const double in_bursts = judge.packets() * 0.05 * 0.95 * (1 + stays) / (1 - stays);
        const double alone = judge.packets() * 0.95 * 0.05 * 0.95;
        judge.z("loss", (judge.packets() - originals - judge.packets() * (1.0 - 0.95 * 0.95)) /
                            std::sqrt(0.95 * 0.95 * in_bursts + alone));
        judge.share("duplication", static_cast<double>(played.counts.duplicated), originals, 0.1);
        std::vector<double> places;
        double held = 0.0;
        for (const Arrival& arrival : played.arrivals) {
            const bool is_held = arrival.delay > delay + 500 * ms;
            held += is_held ? 1.0 : 0.0;
            const Nanoseconds later = arrival.delay - delay - (is_held ? conditions.reorder_by : 0);
            places.push_back(0.5 + 0.5 * static_cast<double>(later) / static_cast<double>(conditions.jitter));
        }
        judge.share("reordering", held, originals, 0.05);
        std::shuffle(places.begin(), places.end(), std::mt19937_64(1));
        judge.even("shape", places);
    }
}

}  // namespace

int main(int argc, char** argv) {
    Options options(argc, argv);
    const double packets = options.number("packets", 1e6);
    Judge judge(static_cast<std::uint32_t>(std::clamp(packets, 1e4, 1e8)), options.text("only", "*"));
    if (!options.understood()) {
        return 2;
    }
    judge_delays(judge);
    judge_shapes(judge);
    judge_losses(judge);
    judge_copies(judge);
    judge_order(judge);
    judge_rate(judge);
    judge_trace(judge);
    judge_ways(judge);
    judge_together(judge);
    return judge.report().write_json(result_path("emulator")) && judge.all_hold() ? 0 : 1;
}
