// Hard cases without end (see shared/stress.hpp), in chunks that are kept: a run that was interrupted goes
// on.
//
//     stress [--ticks=1e8] [--processes=2] [--minutes=M] [--folder=build/bench/stress_chunks]
//     stress --seed=N [--ticks=2000] [--undense]       one case, as a failure names it
//
// Chunk k is the cases of the seeds 500 k + 1 … 500 k + 500, a million ticks. It is written to the folder
// under the fingerprint of this program, so that another program's chunks do not count. After --minutes no
// new chunk is begun. Whatever ends last merges all chunks there are into the result.
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "shared/bench_kit.hpp"
#include "shared/stress.hpp"

namespace {

using namespace tactus::shared;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t cases_per_chunk = 500;
constexpr int ticks_per_case = 2'000;

struct Figure {
    const char* name;
    std::uint64_t StressCounts::* count;
    bool must_be_zero = false;
};

constexpr Figure figures[] = {
    {"cases", &StressCounts::cases},
    {"ticks", &StressCounts::ticks},
    {"contact_ticks", &StressCounts::contact_ticks},
    {"friction_ticks", &StressCounts::friction_ticks},
    {"moving_ticks", &StressCounts::moving_ticks},
    {"dense_ticks", &StressCounts::dense_ticks},
    {"deformations", &StressCounts::deformations},
    {"appearances", &StressCounts::appearances},
    {"squeezes", &StressCounts::squeezes},
    {"penetrations", &StressCounts::penetrations, true},
    {"passes", &StressCounts::passes, true},
    {"nans", &StressCounts::nans, true},
    {"stuck_ticks", &StressCounts::stuck_ticks, true},
    {"false_ends", &StressCounts::false_ends, true},
    {"false_excuses", &StressCounts::false_excuses, true},
    {"judge_faults", &StressCounts::judge_faults, true},
    {"unfinished_ticks", &StressCounts::unfinished_ticks},
    {"excused_ticks", &StressCounts::excused_ticks},
    {"checked_ticks", &StressCounts::checked_ticks},
    {"balanced_ticks", &StressCounts::balanced_ticks},
};

Report report_of(const StressCounts& counts) {
    Report report;
    for (const Figure& figure : figures) {
        report.set(figure.name, static_cast<double>(counts.*figure.count));
    }
    report.set("error_over_radius_max", counts.error_max);
    report.set("thrown_over_radius_max", counts.thrown_max);
    report.set("longest_tick_us", counts.longest_tick_us);
    report.set("longest_tick_seed", static_cast<double>(counts.longest_tick_seed));
    return report;
}

std::uint64_t failures_of(const StressCounts& counts) {
    std::uint64_t sum = 0;
    for (const Figure& figure : figures) {
        sum += figure.must_be_zero ? counts.*figure.count : 0;
    }
    return sum;
}

// Of the bytes of this program (FNV-1a).
std::string fingerprint() {
    std::ifstream program("/proc/self/exe", std::ios::binary);
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (std::istreambuf_iterator<char> at(program), end; at != end; ++at) {
        hash = (hash ^ static_cast<unsigned char>(*at)) * 0x100000001b3u;
    }
    char text[20];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

// A chunk as text: its counts in their order, one a line, then the failures.
bool write_chunk(const std::filesystem::path& path, const StressCounts& counts) {
    KeptFile kept(path);
    std::FILE* const file = kept.get();
    if (!file) {
        return false;
    }
    for (const Figure& figure : figures) {
        std::fprintf(file, "%llu\n", static_cast<unsigned long long>(counts.*figure.count));
    }
    std::fprintf(file, "%.17g\n%.17g\n%.17g\n%llu\n", counts.error_max, counts.thrown_max,
                 counts.longest_tick_us, static_cast<unsigned long long>(counts.longest_tick_seed));
    for (const std::string& failure : counts.failures) {
        std::fprintf(file, "%s\n", failure.c_str());
    }
    return kept.keep();
}

bool read_chunk(const std::filesystem::path& path, StressCounts& counts) {
    std::ifstream file(path);
    for (const Figure& figure : figures) {
        file >> counts.*figure.count;
    }
    file >> counts.error_max >> counts.thrown_max >> counts.longest_tick_us >> counts.longest_tick_seed >>
        std::ws;
    const bool whole = file.good() || file.eof();
    for (std::string line; std::getline(file, line);) {
        counts.failures.push_back(line);
    }
    return whole;
}

struct Run {
    std::filesystem::path folder;
    std::uint64_t chunks = 0;
    int processes = 1;
    Clock::time_point until;

    std::filesystem::path chunk(std::uint64_t index) const {
        return folder / (std::to_string(index) + ".txt");
    }

    // Every chunk of one of the processes that is not there yet, as long as there is time.
    bool work(int process) const {
        for (auto k = static_cast<std::uint64_t>(process); k < chunks && Clock::now() < until;
             k += static_cast<std::uint64_t>(processes)) {
            if (std::filesystem::exists(chunk(k))) {
                continue;
            }
            StressCounts counts;
            for (std::uint64_t i = 1; i <= cases_per_chunk; ++i) {
                run_stress_case(k * cases_per_chunk + i,
                                {.ticks = ticks_per_case, .dense = true, .timed = true}, counts);
            }
            if (!write_chunk(chunk(k), counts)) {
                return false;
            }
        }
        return true;
    }

    bool work_in_processes() const {
        for (int process = 1; process < processes; ++process) {
            const pid_t child = fork();
            if (child == 0) {
                _exit(work(process) ? 0 : 1);
            }
            if (child < 0) {
                std::perror("fork");
                return false;
            }
        }
        bool good = work(0);
        for (int process = 1; process < processes; ++process) {
            int status = 0;
            good = wait(&status) > 0 && status == 0 && good;
        }
        return good;
    }

    StressCounts merged() const {
        StressCounts all;
        for (std::uint64_t k = 0; k < chunks; ++k) {
            StressCounts one;
            if (std::filesystem::exists(chunk(k)) && read_chunk(chunk(k), one)) {
                all.add(one);
            }
        }
        return all;
    }
};

void print(const StressCounts& counts) {
    for (const std::string& failure : counts.failures) {
        std::printf("%s\n", failure.c_str());
    }
    for (const Figure& figure : figures) {
        std::printf("%-18s %14llu\n", figure.name, static_cast<unsigned long long>(counts.*figure.count));
    }
    std::printf("%-18s %14.2e\n%-18s %14.2e\n%-18s %14.1f us of processor time (seed %llu)\n",
                "error / radius", counts.error_max, "thrown / radius", counts.thrown_max, "longest tick",
                counts.longest_tick_us, static_cast<unsigned long long>(counts.longest_tick_seed));
}

}  // namespace

int main(int argc, char** argv) {
    Options options(argc, argv);
    const bool one = options.has("seed");
    const auto seed = static_cast<std::uint64_t>(options.number("seed", 1.0));
    const double ticks = options.number("ticks", one ? ticks_per_case : 1e8);
    const bool undense = options.has("undense");
    const double minutes = options.number("minutes", 1e6);
    const auto processes = static_cast<int>(options.number("processes", 2.0));
    const std::filesystem::path folder =
        options.text("folder", (result_path("stress").parent_path() / "stress_chunks").string());
    if (!options.understood() || !(ticks >= 1.0) || processes < 1) {
        return 2;
    }
    StressCounts counts;
    if (one) {
        run_stress_case(seed, {.ticks = static_cast<int>(ticks), .dense = !undense, .timed = true}, counts);
    } else {
        Run run;
        run.folder = folder / fingerprint();
        run.chunks =
            static_cast<std::uint64_t>(std::ceil(ticks / (cases_per_chunk * double{ticks_per_case})));
        run.processes = processes;
        run.until = Clock::now() + std::chrono::milliseconds(static_cast<long long>(minutes * 6e4));
        std::error_code failed;
        std::filesystem::create_directories(run.folder, failed);
        if (!run.work_in_processes()) {
            return 1;
        }
        counts = run.merged();
    }
    print(counts);
    return report_of(counts).write_json(result_path("stress")) && failures_of(counts) == 0 ? 0 : 1;
}
