// How evenly this machine lets the tick loop tick: with an empty tick and with 50 µs of work, a bare sleeping
// loop beside it, and, to choose the default by, with one means of staying on time taken away at a time.
//
//     pacing [--seconds=10] [--compare] [--output=build/bench/pacing.json]
//
// Runs are repeated in turns (--rounds) and each case reports its quietest round: what the rest of the
// machine, or the other guests of a virtual one, take away varies from second to second, and `steal_share`
// says how much it was.
#include <array>
#include <charconv>
#include <chrono>
#include <cinttypes>
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

namespace {

using namespace tactus;

struct Options {
    int seconds = 10;
    int rounds = 1;
    bool compare = false;
    std::filesystem::path output = "build/bench/pacing.json";
};

struct Case {
    std::string name;
    Nanoseconds work;
    TickLoopSettings settings;
};

struct Outcome {
    TickFigures loop;
    TickFigures baseline;
    double steal_share = 0.0;  // of all processors' time: run by the hypervisor for somebody else
    std::string granted;
};

TickStatus work_for(void* context, Nanoseconds) {
    const Nanoseconds until = monotonic_now() + *static_cast<const Nanoseconds*>(context);
    while (monotonic_now() < until) {
    }
    return 0;
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

std::optional<Outcome> measure(const Case& what, int seconds) {
    Nanoseconds work = what.work;
    TickLoop loop;
    BaselineLoop baseline;
    std::string error = loop.start(what.settings, &work_for, &work);
    if (error.empty()) {
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
    write_periods(file, name + ".baseline", outcome.baseline);
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
    const std::vector<Case> all = cases(options->compare);
    std::vector<std::optional<Outcome>> quietest(all.size());
    for (int round = 0; round < options->rounds; ++round) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            const std::optional<Outcome> outcome = measure(all[i], options->seconds);
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
