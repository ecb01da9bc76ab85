#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sensing/sensing_figures.hpp"
#include "shared/robot_at_block.hpp"

namespace tactus::shared {

namespace {

// Half of the time it presses and rubs, half of it it pushes.
constexpr double touched_seconds = 2.0;

double percent_off(const TouchValue& told, double truth) {
    return 100.0 * std::abs(told.value - truth) / truth;
}

}  // namespace

void report_parameters(Report& report, const SensingCase& bench) {
    std::vector<double> stiffness, friction, mass;
    int unknown = 0, within = 0;
    for (int s = 0; s < bench.scenes; ++s) {
        const BlockTruth truth = any_block(bench.first + static_cast<std::uint64_t>(s));
        RobotAtBlock robot(truth);
        robot.rub(0.5 * touched_seconds);
        robot.push(0.5 * touched_seconds);
        const ObjectEstimate& told = robot.told();
        stiffness.push_back(percent_off(told.stiffness, truth.stiffness));
        friction.push_back(percent_off(told.friction, truth.friction));
        mass.push_back(percent_off(told.mass, truth.mass));
        unknown += !told.stiffness.known || !told.friction.known || !told.mass.known;
        within += std::max({stiffness.back(), friction.back(), mass.back()}) <= 10.0;
        if (bench.talks) {
            std::printf("  k %.0f (%.0f %% off) mu %.2f (%.0f %%) m %.2f (%.0f %%)\n", truth.stiffness,
                        stiffness.back(), truth.friction, friction.back(), truth.mass, mass.back());
        }
    }
    const double k = quantile(stiffness, 0.95), mu = quantile(friction, 0.95), m = quantile(mass, 0.95);
    report.set("stiffness_error_percent", k);
    report.set("friction_error_percent", mu);
    report.set("mass_error_percent", m);
    report.set("parameters.unknown", unknown);
    report.set("parameters.all_within_10_percent", within);
    std::printf(
        "touched 2 s    stiffness %.1f %%, friction %.1f %%, mass %.1f %% off (p95; median %.1f, %.1f, "
        "%.1f); of "
        "%d all within 10 %% in %d, one not known in %d\n",
        k, mu, m, quantile(stiffness, 0.5), quantile(friction, 0.5), quantile(mass, 0.5), bench.scenes,
        within, unknown);
}

}  // namespace tactus::shared
