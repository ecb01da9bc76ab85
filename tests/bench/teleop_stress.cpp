// Whether anything that comes over the wire stops a side, moves what is not its sender's, or kicks the hand:
// both sides as they really are, under mutated, reordered and replayed packets of every kind, from a
// stranger, from somebody who hears all but has no key, and from a peer; then a flood through real sockets,
// and silence.
//
//     teleop_stress [--packets=10000000] [--kind=NAME] [--seed=1] [--only=attack|flood|blackout]
//
// `packets`: of each kind, a third from each attacker. Each attack runs in a process of its own, so that a
// crash or a hang is counted and does not end the bench.
#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

#include "platform/clock.hpp"
#include "shared/attack.hpp"
#include "shared/bench_kit.hpp"
#include "shared/flood.hpp"

namespace {

using namespace tactus;
using namespace tactus::shared;

// A packet takes a microsecond or two of a processor: whoever takes so much more hangs (unit: seconds).
constexpr double longest(std::uint64_t packets) {
    return 120.0 + 60e-6 * static_cast<double>(packets);
}
// So does who gets no further at all, by the clock: a busy machine gives a little now and then.
constexpr Nanoseconds longest_standstill = 600 * nanoseconds_per_second;

Nanoseconds processor_time(pid_t process) {
    clockid_t clock{};
    timespec used{};
    const bool known = clock_getcpuclockid(process, &clock) == 0 && clock_gettime(clock, &used) == 0;
    return known ? used.tv_sec * nanoseconds_per_second + used.tv_nsec : 0;
}

enum class End { well, hung, crashed };

// Runs the attack in a child; its figures come back through a pipe.
End run_apart(const AttackSettings& settings, AttackFigures& figures) {
    int ends[2];
    if (pipe(ends) != 0) {
        return End::crashed;
    }
    const pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        const AttackFigures found = run_attack(settings);
        const bool told = write(ends[1], &found, sizeof found) == static_cast<ssize_t>(sizeof found);
        _exit(told ? 0 : 1);
    }
    close(ends[1]);
    const Nanoseconds most = from_seconds(longest(settings.packets));
    Nanoseconds used = 0, went_on = monotonic_now();
    int status = 0;
    bool hung = false;
    while (waitpid(child, &status, WNOHANG) == 0) {
        const Nanoseconds before = std::exchange(used, processor_time(child));
        went_on = used != before ? monotonic_now() : went_on;
        if (used > most || monotonic_now() - went_on > longest_standstill) {
            kill(child, SIGKILL);
            waitpid(child, &status, 0);
            hung = true;
            break;
        }
        const timespec nap{0, 20'000'000};
        nanosleep(&nap, nullptr);
    }
    const bool told = read(ends[0], &figures, sizeof figures) == static_cast<ssize_t>(sizeof figures);
    close(ends[0]);
    return hung                                                    ? End::hung
           : told && WIFEXITED(status) && WEXITSTATUS(status) == 0 ? End::well
                                                                   : End::crashed;
}

struct Totals {
    double packets = 1e300;  // of the kind that had fewest
    double hangs = 0.0, crashes = 0.0, moved_objects = 0.0, force_steps = 0.0, not_recovered = 0.0;
    double memory_growth_mb = 0.0, largest_force_step = 0.0, largest_unmoved_step = 0.0;
};

void attack_with_kind(Report& report, Totals& totals, std::size_t kind, std::uint64_t packets,
                      std::uint64_t seed) {
    std::uint64_t thrown = 0;
    constexpr auto attackers = static_cast<std::size_t>(Attacker::count);
    for (std::size_t who = 0; who < attackers; ++who) {
        const auto attacker = static_cast<Attacker>(who);
        AttackFigures figures;
        const End end = run_apart({kind, attacker, packets / attackers + 1, seed + who}, figures);
        const std::string key = kind_name(kind) + "." + name_of(attacker) + ".";
        thrown += figures.packets;
        totals.hangs += end == End::hung ? 1.0 : 0.0;
        totals.crashes += end == End::crashed ? 1.0 : 0.0;
        totals.moved_objects += static_cast<double>(figures.moved_objects);
        totals.force_steps += static_cast<double>(figures.force_steps);
        totals.not_recovered += static_cast<double>(figures.not_recovered);
        totals.memory_growth_mb = std::max(totals.memory_growth_mb, figures.memory_growth_mb);
        totals.largest_force_step = std::max(totals.largest_force_step, figures.largest_force_step);
        totals.largest_unmoved_step = std::max(totals.largest_unmoved_step, figures.largest_unmoved_step);
        report.set(key + "ended_well", end == End::well ? 1.0 : 0.0);
        report.set(key + "packets", static_cast<double>(figures.packets));
        report.set(key + "moved_objects", static_cast<double>(figures.moved_objects));
        report.set(key + "force_steps", static_cast<double>(figures.force_steps));
        report.set(key + "largest_force_step_N", figures.largest_force_step);
        report.set(key + "largest_unmoved_force_step_N", figures.largest_unmoved_step);
        report.set(key + "memory_growth_mb", figures.memory_growth_mb);
        report.set(key + "model_changes", static_cast<double>(figures.model_changes));
        report.set(key + "not_recovered", static_cast<double>(figures.not_recovered));
    }
    totals.packets = std::min(totals.packets, static_cast<double>(thrown));
}

void attack(Report& report, std::uint64_t packets, const std::string& only_kind, std::uint64_t seed) {
    Totals totals;
    for (std::size_t kind = 0; kind < kind_count(); ++kind) {
        if (only_kind.empty() || only_kind == kind_name(kind)) {
            attack_with_kind(report, totals, kind, packets, seed);
        }
    }
    report.set("packets", totals.packets);
    report.set("hangs", totals.hangs);
    report.set("crashes", totals.crashes);
    report.set("moved_objects", totals.moved_objects);
    report.set("force_steps", totals.force_steps);
    report.set("largest_force_step_N", totals.largest_force_step);
    report.set("largest_unmoved_force_step_N", totals.largest_unmoved_step);
    report.set("memory_growth_mb", totals.memory_growth_mb);
    report.set("not_recovered", totals.not_recovered);
}

void black_out(Report& report) {
    double worst = 0.0;
    for (const auto& [name, seconds] :
         {std::pair{"0_4_s", 0.4}, std::pair{"0_7_s", 0.7}, std::pair{"5_s", 5.0}}) {
        const BlackoutFigures figures = run_blackout(seconds);
        worst = std::max(worst, figures.recovery_s);
        const std::string key = std::string("blackout.") + name + ".";
        report.set(key + "recovery_s", figures.recovery_s);
        report.set(key + "max_hand_speed_m_per_s", figures.max_speed);
        report.set(key + "operators_hand_speed_m_per_s", figures.hand_speed);
    }
    report.set("blackout_recovery_s", worst);
}

bool flood(Report& report) {
    const FloodFigures figures = run_flood({});
    if (!figures.error.empty()) {
        std::fprintf(stderr, "%s\n", figures.error.c_str());
        return false;
    }
    report.set("flood_packets_per_s", figures.packets_per_s);
    report.set("flood_packets_that_reached_the_socket", figures.reached);
    report.set("flood_from_the_peers_address", figures.from_peers_address ? 1.0 : 0.0);
    report.set("flood_tick_over_quiet", figures.tick_over_quiet);
    report.set("flood_tick_p99_over_quiet", figures.tick_p99_over_quiet);
    report.set("flood_network_thread_percent", figures.network_thread_percent);
    report.set("quiet_network_thread_percent", figures.quiet_network_thread_percent);
    report.set("flood_honest_packets_lost_percent", figures.honest_lost_percent);
    return true;
}

}  // namespace

int main(int count, char** arguments) {
    Options options(count, arguments);
    const auto packets = static_cast<std::uint64_t>(options.number("packets", 1e7));
    const auto seed = static_cast<std::uint64_t>(options.number("seed", 1.0));
    const std::string kind = options.text("kind");
    const std::string only = options.text("only");
    if (!options.understood()) {
        return 2;
    }
    Report report;
    bool good = true;
    if (only.empty() || only == "blackout") {
        black_out(report);
    }
    if (only.empty() || only == "flood") {
        good = flood(report);
    }
    if (only.empty() || only == "attack") {
        attack(report, packets, kind, seed);
    }
    return report.write_json(result_path("teleop_stress")) && good ? 0 : 1;
}
