// Hard cases without end: ./run bench stress [--ticks=100000000] [--seed=1] [--ticks-per-case=2000]
//
// One case after the other, each from its own seed (see shared/stress.hpp), until so many ticks are done.
// Every failure names the seed and the tick that shows it again: stress --seed=N --ticks=1.
#include <cmath>
#include <cstdio>

#include "shared/bench_kit.hpp"
#include "shared/stress.hpp"

int main(int argc, char** argv) {
    using namespace tactus::shared;
    Options options(argc, argv);
    const double ticks = options.number("ticks", 1e8);
    const double first = options.number("seed", 1.0);
    const double per_case = options.number("ticks-per-case", 2'000.0);
    if (!options.understood() || !(ticks > 0.0) || !(per_case >= 1.0) || !(first >= 0.0)) {
        return 2;
    }
    StressCounts counts;
    std::size_t told = 0;
    auto seed = static_cast<std::uint64_t>(first);
    double next_line = ticks / 20.0;
    std::printf("%14s %14s %12s %8s %6s %8s %12s %10s\n", "ticks", "in contact", "penetrations", "passes",
                "NaNs", "stuck", "unfinished", "error/r");
    while (static_cast<double>(counts.ticks) < ticks) {
        run_stress_case(seed++, static_cast<int>(per_case), counts);
        for (; told < counts.failures.size(); ++told) {
            std::printf("%s\n", counts.failures[told].c_str());
        }
        if (static_cast<double>(counts.ticks) >= next_line) {
            std::printf("%14llu %14llu %12llu %8llu %6llu %8llu %12llu %10.1e\n",
                        static_cast<unsigned long long>(counts.ticks),
                        static_cast<unsigned long long>(counts.contact_ticks),
                        static_cast<unsigned long long>(counts.penetrations),
                        static_cast<unsigned long long>(counts.passes),
                        static_cast<unsigned long long>(counts.nans),
                        static_cast<unsigned long long>(counts.stuck_ticks),
                        static_cast<unsigned long long>(counts.unfinished_ticks), counts.error_max);
            std::fflush(stdout);
            next_line += ticks / 20.0;
        }
    }
    Report report;
    report.set("ticks", static_cast<double>(counts.ticks));
    report.set("contact_ticks", static_cast<double>(counts.contact_ticks));
    report.set("cases", static_cast<double>(seed) - first);
    report.set("penetrations", static_cast<double>(counts.penetrations));
    report.set("passes", static_cast<double>(counts.passes));
    report.set("nans", static_cast<double>(counts.nans));
    report.set("stuck_ticks", static_cast<double>(counts.stuck_ticks));
    report.set("unfinished_ticks", static_cast<double>(counts.unfinished_ticks));
    report.set("checked_ticks", static_cast<double>(counts.checked_ticks));
    report.set("error_over_radius_max", counts.error_max);
    const bool clean = counts.penetrations + counts.passes + counts.nans + counts.stuck_ticks == 0;
    return report.write_json(result_path("stress")) && clean ? 0 : 1;
}
