// What more than a point does: build/bench/tool.json.
#include <algorithm>
#include <cstdio>

#include "shared/bench_kit.hpp"
#include "shared/torsion_figures.hpp"

namespace {

using namespace tactus::shared;

void report_torsion(Report& report) {
    TorsionFigures worst;
    for (const double edge : {0.03, 0.05, 0.08, 0.12}) {
        for (const double pressing : {1.0, 3.0, 8.0, 20.0}) {
            const TorsionFigures figures = turn_held_cube(edge, pressing);
            worst.break_away_error = std::max(worst.break_away_error, figures.break_away_error);
            worst.slipping_error = std::max(worst.slipping_error, figures.slipping_error);
        }
    }
    const double error = std::max(worst.break_away_error, worst.slipping_error);
    const LiftFigures soft = lift_beside_middle({1e5, 0.008});
    const LiftFigures point = lift_beside_middle({});
    report.set("torsion.error_percent", error);
    report.set("torsion.break_away_error_percent", worst.break_away_error);
    report.set("torsion.slipping_error_percent", worst.slipping_error);
    report.set("torsion.lift.turned_deg", soft.turned);
    report.set("torsion.lift.turned_without_deg", point.turned);
    std::printf("torsion: break-away off by %.2f %%, slipping by %.2f %%\n", worst.break_away_error,
                worst.slipping_error);
    std::printf("lifted 20 mm beside the middle: turned %.3f degrees, by points %.1f\n", soft.turned,
                point.turned);
}

}  // namespace

int main(int count, char** arguments) {
    Options options(count, arguments);
    if (!options.understood()) {
        return 2;
    }
    Report report;
    report_torsion(report);
    return report.write_json(result_path("tool")) ? 0 : 1;
}
