#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sensing/sensing_figures.hpp"
#include "shared/random_values.hpp"
#include "shared/robot_at_block.hpp"

namespace tactus::shared {

namespace {

// Half of the time it rubs, half of it it pushes.
constexpr double touched_seconds = 2.0;

// More than a robot of 8 N can slide (unit: newtons).
constexpr double most_to_slide = 4.0;

BlockTruth truth_of(std::uint64_t seed) {
    RandomValues random(seed);
    BlockTruth block;
    block.stiffness = random.magnitude(200.0, 1200.0);
    block.friction = random.between(0.15, 1.0);
    block.mass = random.magnitude(0.2, 2.0);
    block.on_table = random.between(0.15, std::min(0.7, most_to_slide / (9.81 * block.mass)));
    block.seed = static_cast<unsigned>(seed);
    return block;
}

double percent_off(const TouchValue& told, double truth) {
    return 100.0 * std::abs(told.value - truth) / truth;
}

}  // namespace

void report_parameters(Report& report, const SensingCase& bench) {
    std::vector<double> stiffness, friction, mass;
    int unknown = 0;
    for (int s = 0; s < bench.scenes; ++s) {
        const BlockTruth truth = truth_of(bench.first + static_cast<std::uint64_t>(s));
        RobotAtBlock robot(truth);
        robot.rub(0.5 * touched_seconds);
        robot.push(0.5 * touched_seconds);
        const ObjectEstimate& told = robot.told();
        stiffness.push_back(percent_off(told.stiffness, truth.stiffness));
        friction.push_back(percent_off(told.friction, truth.friction));
        mass.push_back(percent_off(told.mass, truth.mass));
        unknown += !told.stiffness.known || !told.friction.known || !told.mass.known;
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
    std::printf(
        "touched 2 s    stiffness %.1f %%, friction %.1f %%, mass %.1f %% off (p95); not known in %d of %d\n",
        k, mu, m, unknown, bench.scenes);
}

}  // namespace tactus::shared
