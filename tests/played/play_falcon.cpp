// Plays a Falcon in a user's hand for another program:
//
//     play_falcon [--firmware=FILE] [--failing=SHARE] [--figures=FILE] -- PROGRAM …
//
// The user goes round the thesis's way: a circle in 10 s, with a sine upon it. --firmware: where the dummy
// image is written that this Falcon takes; --figures: where it says, when the program has ended, what the
// device has seen.
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <glm/geometric.hpp>
#include <span>
#include <string>

#include "platform/clock.hpp"
#include "platform/sleep.hpp"
#include "played/played_usb.hpp"
#include "shared/bench_kit.hpp"

namespace {

using namespace tactus;

Vec3 way_of_the_user(double seconds) {
    const double turn = 2.0 * 3.14159265358979 * seconds / 10.0;
    return {0.025 * std::cos(turn), 0.006 + 0.02 * std::sin(5.0 * turn), 0.025 * std::sin(turn)};
}

// A hand and a device wait for no processor: where the system permits it, nothing but the haptic threads goes
// first. Threads that are made after this have it, too.
void schedule_as_hardware(bool on) {
    const sched_param priority{.sched_priority = on ? 50 : 0};
    sched_setscheduler(0, on ? SCHED_FIFO : SCHED_OTHER, &priority);
}

// Moves the hand until the program has ended; its exit code.
int play_for(shared::PlayedUsb& falcon, pid_t program, double& largest_force) {
    SleepTimer timer;
    const Nanoseconds start = monotonic_now();
    int status = 0;
    while (waitpid(program, &status, WNOHANG) == 0) {
        falcon.mean(way_of_the_user(to_seconds(monotonic_now() - start)));
        largest_force = std::max(largest_force, glm::length(falcon.force()));
        timer.sleep_until(monotonic_now() + 2'000'000);
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

}  // namespace

int main(int count, char** arguments) {
    if (!shared::run_below_umockdev(arguments)) {
        std::fputs("umockdev's library cannot be loaded: install libumockdev0\n", stderr);
        return 1;
    }
    const std::span all(arguments, static_cast<std::size_t>(count));
    const auto end = std::find(all.begin(), all.end(), std::string("--"));
    shared::Options options(static_cast<int>(end - all.begin()), arguments);
    const std::string firmware = options.text("firmware");
    const std::string figures = options.text("figures");
    shared::PlayedUsbSettings settings;
    settings.failing = options.number("failing", 0.0);
    if (!options.understood() || end == all.end() || end + 1 == all.end()) {
        std::fputs("play_falcon [--firmware=FILE] [--failing=SHARE] [--figures=FILE] -- PROGRAM …\n", stderr);
        return 2;
    }
    const std::vector<std::uint8_t> image = shared::PlayedFalcon::firmware();
    std::ofstream(firmware, std::ios::binary)
        .write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(image.size()));
    schedule_as_hardware(true);
    shared::PlayedUsb falcon(settings);
    falcon.plug();
    const pid_t program = fork();
    if (program == 0) {
        schedule_as_hardware(false);
        prctl(PR_SET_PDEATHSIG, SIGKILL);  // it does not outlive what it touches
        execvp(*(end + 1), &*(end + 1));
        std::perror(*(end + 1));
        _exit(127);
    }
    double largest_force = 0.0;
    const int code = play_for(falcon, program, largest_force);
    shared::Report report;
    report.set("exchanges", static_cast<double>(falcon.exchanges()));
    report.set("largest_force_N", largest_force);
    report.set("force_at_the_end_N", glm::length(falcon.force()));
    return figures.empty() || report.write_json(figures) ? code : 1;
}
