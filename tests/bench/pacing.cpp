// How evenly this machine lets the tick loop tick: with an empty tick, with 50 µs of work and with a hand
// among boxes, a bare sleeping loop beside it, and, to choose the default by, with one means of staying on
// time taken away at a time.
//
//     pacing [--seconds=10] [--rounds=1] [--compare] [--only=CASE] [--alone]
//     [--output=build/bench/pacing.json]
//
// --alone leaves out the bare loop. CASE.lateness_counts are how many ticks began so many whole microseconds
// after their deadline, from 0 on; the last is of all that were later.
//
// Runs are repeated in turns (--rounds) and each case reports its quietest round: what the rest of the
// machine, or the other guests of a virtual one, take away varies from second to second, and `steal_share`
// says how much it was.
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "platform/clock.hpp"
#include "platform/file.hpp"
#include "realtime/baseline_loop.hpp"
#include "realtime/tick_loop.hpp"
#include "session/session.hpp"
#include "shared/bench_kit.hpp"

namespace {

using namespace tactus;

struct Options {
    int seconds = 10;
    int rounds = 1;
    bool compare = false;
    bool alone = false;
    std::string only;
    std::filesystem::path output = shared::result_path("pacing");
};

struct Case {
    std::string name;
    Nanoseconds work;
    TickLoopSettings settings;
    bool touches = false;
};

constexpr std::size_t most_late = 20'000;  // (unit: microseconds)

struct Outcome {
    TickFigures loop;
    TickFigures baseline;
    std::vector<std::uint64_t> lateness;  // ticks by whole microseconds
    double steal_share = 0.0;             // of all processors' time: run by the hypervisor for somebody else
    std::string granted;
};

TickStatus work_for(void* context, Nanoseconds) {
    const Nanoseconds until = monotonic_now() + *static_cast<const Nanoseconds*>(context);
    while (monotonic_now() < until) {
    }
    return 0;
}

class MovedDevice final : public Device {
public:
    DeviceSample read(Nanoseconds now) override {
        const double t = to_seconds(now);
        const Vec3 place(0.3 * std::sin(4.0 * t), 0.06 + 0.05 * std::sin(7.0 * t), 0.1 * std::cos(3.0 * t));
        return {place, {1.0, 0.0, 0.0, 0.0}, Vec3(0.0), 0, true};
    }
    void write(Nanoseconds, const Vec3&) override {}
};

// A hand that pushes boxes about on a table.
class Touching {
public:
    Touching() {
        Workspace workspace;
        workspace.force_limit = 10.0;
        ProxyDescription pointer;
        pointer.device = session_.add_device(device_, workspace).handle;
        session_.add_proxy(pointer);
        add(PlaneShape{}, Vec3(0.0), Motion::Static);
        for (int i = 0; i < 6; ++i) {
            add(BoxShape{Vec3(0.04)}, {0.12 * i - 0.3, 0.04, 0.0}, Motion::Dynamic);
        }
        session_.settle();
    }
    static TickStatus tick(void* context, Nanoseconds now) {
        return static_cast<Touching*>(context)->session_.tick(now);
    }

private:
    void add(const Shape& shape, const Vec3& place, Motion motion) {
        BodyAddition addition;
        addition.description.shapes = {PlacedShape{shape, Pose{}}};
        addition.description.pose.position = place;
        addition.description.motion = motion;
        addition.touch_material = {500.0, 1.0, 0.3, 0.2};
        session_.add_body(addition);
    }

    MovedDevice device_;
    Session session_{SessionSettings{}};
};

std::vector<std::uint64_t> by_microseconds(const DurationHistogram& durations) {
    std::vector<std::uint64_t> counts;
    const auto all = static_cast<double>(durations.count());
    double before = 0.0;
    for (const DurationHistogram::Step& step : durations.cumulative()) {
        const auto whole = std::min(most_late, static_cast<std::size_t>(step.duration * 1e-3));
        counts.resize(std::max(counts.size(), whole + 1));
        counts[whole] += static_cast<std::uint64_t>(std::llround(all * (step.share - before)));
        before = step.share;
    }
    return counts;
}

// The first line of /proc/stat: user nice system idle iowait irq softirq steal, in ticks since the machine
// started. Elsewhere than on Linux all are 0.
struct ProcessorTimes {
    double stolen = 0.0;
    double all = 0.0;
};

ProcessorTimes processor_times() {
    std::ifstream file("/proc/stat");
    std::string label;
    file >> label;
    ProcessorTimes times;
    for (int column = 0; column < 8; ++column) {
        double ticks = 0.0;
        file >> ticks;
        times.all += ticks;
        times.stolen = ticks;
    }
    return times;
}

std::optional<Outcome> measure(const Case& what, int seconds, bool alone) {
    Nanoseconds work = what.work;
    std::optional<Touching> touching;
    if (what.touches) {
        touching.emplace();
    }
    TickLoop loop;
    BaselineLoop baseline;
    std::string error = touching ? loop.start(what.settings, &Touching::tick, &*touching)
                                 : loop.start(what.settings, &work_for, &work);
    if (error.empty() && !alone) {
        error = baseline.start(what.settings);
    }
    if (!error.empty()) {
        std::fprintf(stderr, "%s: %s\n", what.name.c_str(), error.c_str());
        return std::nullopt;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // warm up
    loop.statistics().request_clear();
    baseline.statistics().request_clear();
    const ProcessorTimes before = processor_times();
    std::this_thread::sleep_for(std::chrono::seconds(seconds));
    const ProcessorTimes after = processor_times();
    loop.stop();
    baseline.stop();
    Outcome outcome;
    outcome.loop = loop.statistics().figures();
    outcome.baseline = baseline.statistics().figures();
    outcome.lateness = by_microseconds(loop.statistics().lateness());
    const double all = after.all - before.all;
    outcome.steal_share = all > 0.0 ? (after.stolen - before.stolen) / all : 0.0;
    outcome.granted = loop.realtime_report().text;
    return outcome;
}

std::vector<Case> cases(bool compare) {
    constexpr std::array<Nanoseconds, 2> works{0, 50'000};
    std::vector<Case> all;
    for (const Nanoseconds work : works) {
        const std::string name = work == 0 ? "empty" : "busy50us";
        all.push_back({name, work, {}});
        if (!compare) {
            continue;
        }
        all.push_back({name + "_without_spin", work, {}});
        all.back().settings.sleep.spin_limit = 0;
        all.push_back({name + "_on_kernel_ticks", work, {}});
        all.back().settings.phase = 0;
        all.push_back({name + "_always_awake", work, {}});
        all.back().settings.awake_lead = all.back().settings.period;
        for (const int lead : {60, 240, 400}) {
            all.push_back({name + "_lead" + std::to_string(lead), work, {}});
            all.back().settings.awake_lead = lead * 1000;
        }
        all.push_back({name + "_may_sleep", work, {}});
        all.back().settings.realtime.keep_awake = false;
        all.push_back({name + "_any_processor", work, {}});
        all.back().settings.realtime.cpu = any_processor;
        all.push_back({name + "_without_fifo", work, {}});
        all.back().settings.realtime.fifo_priority = 0;
        all.push_back({name + "_plain_sleep", work, {}});
        all.back().settings.realtime = {.fifo_priority = 0,
                                        .lock_memory = false,
                                        .cpu = any_processor,
                                        .keep_awake = false,
                                        .timer_slack = 50'000};
        all.back().settings.sleep.spin_limit = 0;
    }
    all.push_back({"touch", 0, {}, true});
    return all;
}

void write_number(std::FILE* file, const std::string& key, double value) {
    std::fprintf(file, ",\n  \"%s\": %.4f", key.c_str(), value);
}

void write_periods(std::FILE* file, const std::string& prefix, const TickFigures& figures) {
    write_number(file, prefix + "_period_p10_us", figures.period_p10_us);
    write_number(file, prefix + "_period_p50_us", figures.period_p50_us);
    write_number(file, prefix + "_period_p90_us", figures.period_p90_us);
    write_number(file, prefix + "_period_p99_us", figures.period_p99_us);
    write_number(file, prefix + "_period_p999_us", figures.period_p999_us);
    write_number(file, prefix + "_period_max_us", figures.period_max_us);
    write_number(file, prefix + "_lateness_p50_us", figures.lateness_p50_us);
    write_number(file, prefix + "_lateness_p90_us", figures.lateness_p90_us);
    write_number(file, prefix + "_lateness_p99_us", figures.lateness_p99_us);
}

void write_outcome(std::FILE* file, const std::string& name, const Outcome& outcome) {
    write_periods(file, name + ".tick", outcome.loop);
    if (outcome.baseline.ticks > 0) {
        write_periods(file, name + ".baseline", outcome.baseline);
    }
    std::fprintf(file, ",\n  \"%s.lateness_counts\": [", name.c_str());
    for (std::size_t i = 0; i < outcome.lateness.size(); ++i) {
        std::fprintf(file, "%s%" PRIu64, i > 0 ? "," : "", outcome.lateness[i]);
    }
    std::fputs("]", file);
    write_number(file, name + ".mean_period_us", outcome.loop.mean_period_us);
    write_number(file, name + ".tick_compute_p99_us", outcome.loop.compute_p99_us);
    write_number(file, name + ".ticks", static_cast<double>(outcome.loop.ticks));
    write_number(file, name + ".missed_deadlines", static_cast<double>(outcome.loop.missed_deadlines));
    write_number(file, name + ".steal_share", outcome.steal_share);
    std::fprintf(file, ",\n  \"%s.granted\": \"%s\"", name.c_str(), outcome.granted.c_str());
}

void print_row(const std::string& name, const Outcome& outcome) {
    std::printf(
        "%-26s mean %8.3f  p50 %7.1f  p90 %7.1f  p99 %7.1f  p99.9 %8.1f  max %8.1f | baseline p90 %7.1f  p99 "
        "%7.1f"
        " | missed %" PRIu64 "  steal %.3f\n",
        name.c_str(), outcome.loop.mean_period_us, outcome.loop.period_p50_us, outcome.loop.period_p90_us,
        outcome.loop.period_p99_us, outcome.loop.period_p999_us, outcome.loop.period_max_us,
        outcome.baseline.period_p90_us, outcome.baseline.period_p99_us, outcome.loop.missed_deadlines,
        outcome.steal_share);
    std::fflush(stdout);
}

bool read_number(std::string_view text, int& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc{} && end == text.data() + text.size() && number > 0;
}

std::optional<Options> parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        bool known = true;
        if (argument == "--compare") {
            options.compare = true;
        } else if (argument == "--alone") {
            options.alone = true;
        } else if (argument.starts_with("--only=")) {
            options.only = argument.substr(7);
        } else if (argument.starts_with("--seconds=")) {
            known = read_number(argument.substr(10), options.seconds);
        } else if (argument.starts_with("--rounds=")) {
            known = read_number(argument.substr(9), options.rounds);
        } else if (argument.starts_with("--output=")) {
            options.output = argument.substr(9);
        } else {
            known = false;
        }
        if (!known) {
            std::fprintf(stderr, "not understood: %s\n", argv[i]);
            return std::nullopt;
        }
    }
    return options;
}

}  // namespace

int main(int argc, char** argv) {
    const std::optional<Options> options = parse(argc, argv);
    if (!options) {
        return 2;
    }
    std::vector<Case> all = cases(options->compare);
    std::erase_if(all, [&](const Case& one) { return !options->only.empty() && one.name != options->only; });
    std::vector<std::optional<Outcome>> quietest(all.size());
    for (int round = 0; round < options->rounds; ++round) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            const std::optional<Outcome> outcome = measure(all[i], options->seconds, options->alone);
            if (!outcome) {
                return 1;
            }
            print_row(all[i].name, *outcome);
            if (!quietest[i] || outcome->steal_share < quietest[i]->steal_share) {
                quietest[i] = outcome;
            }
        }
    }
    std::error_code failed;
    std::filesystem::create_directories(options->output.parent_path(), failed);
    std::FILE* file = open_file(options->output.string(), "w");
    if (file == nullptr) {
        std::perror(options->output.string().c_str());
        return 1;
    }
    std::fprintf(file, "{\n  \"seconds\": %d,\n  \"rounds\": %d", options->seconds, options->rounds);
    for (std::size_t i = 0; i < all.size(); ++i) {
        write_outcome(file, all[i].name, *quietest[i]);
    }
    std::fputs("\n}\n", file);
    return std::fclose(file) == 0 ? 0 : 1;
}
