#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sensing/sensing_figures.hpp"
#include "shared/touched_block.hpp"

namespace tactus::shared {

namespace {

constexpr double touched_seconds = 2.0;

double percent_off(const TouchValue& told, double truth) {
    return 100.0 * std::abs(told.value - truth) / truth;
}

}  // namespace

void report_parameters(Report& report, const SensingCase& bench) {
    std::vector<double> stiffness, friction, mass;
    int unknown = 0;
    for (int s = 0; s < bench.scenes; ++s) {
        RandomValues random(bench.first + static_cast<std::uint64_t>(s));
        TouchedBlock block;
        block.stiffness = random.magnitude(200.0, 4000.0);
        block.damping = random.between(0.0, 3.0);
        block.friction = random.between(0.15, 1.0);
        block.on_table = random.between(0.15, 0.7);
        block.mass = random.magnitude(0.15, 2.0);
        block.seed = bench.first + 1000 + static_cast<std::uint64_t>(s);
        const TouchEstimate estimate = touch_block(block, touched_seconds);
        stiffness.push_back(percent_off(estimate.stiffness(), block.stiffness));
        friction.push_back(percent_off(estimate.friction(), block.friction));
        mass.push_back(percent_off(estimate.mass(), block.mass));
        unknown += !estimate.stiffness().known || !estimate.friction().known || !estimate.mass().known;
    }
    const double k = quantile(stiffness, 0.95), mu = quantile(friction, 0.95), m = quantile(mass, 0.95);
    report.set("stiffness_error_percent", k);
    report.set("friction_error_percent", mu);
    report.set("mass_error_percent", m);
    report.set("parameters.unknown", unknown);
    std::printf(
        "touched 2 s    stiffness %.1f %%, friction %.1f %%, mass %.1f %% off (p95); not known in %d of %d\n",
        k, mu, m, unknown, bench.scenes);
}

}  // namespace tactus::shared
