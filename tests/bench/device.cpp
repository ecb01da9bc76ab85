// Hands of metal: kinematics of a delta arm. build/bench/device.json.
//
//   --places=N   of the workspace, for each geometry (1000000)
#include <cstdio>

#include "shared/bench_kit.hpp"
#include "shared/delta_figures.hpp"

namespace {

using namespace tactus;
using namespace tactus::shared;

constexpr int places_a_task = 50'000;

void report_kinematics(Report& report, int places) {
    std::vector<DeltaFigures> parts(static_cast<std::size_t>((places + places_a_task - 1) / places_a_task));
    DeltaFigures all;
    for (const DeltaGeometry& geometry : {falcon_geometry, falcon_geometry_martin}) {
        run_on_two_threads(parts.size(), [&](std::size_t part) {
            parts[part] = check_delta(geometry, 1'000 + part, places_a_task);
        });
        for (const DeltaFigures& part : parts) {
            all.add(part);
        }
    }
    report.set("kinematics.places", all.places);
    report.set("kinematics.lost", all.lost);
    report.set("kinematics.round_trip_max_rad", all.round_trip_rad);
    report.set("kinematics.round_trip_max_m", all.round_trip_m);
    report.set("kinematics.jacobian_error_max", all.jacobian_error);
    report.set("kinematics.newton_steps_cold_max", all.steps_cold);
    report.set("kinematics.newton_steps_warm_max", all.steps_warm);
    report.set("falcon.force_direction_max_deg", all.force_direction_deg);
    report.set("falcon.force_size_error_max", all.force_size_error);
    std::printf(
        "kinematics  %d places, %d lost; there and back %.1e rad, %.1e m; Jacobian %.1e; Newton %d steps, "
        "warm %d\n",
        all.places, all.lost, all.round_trip_rad, all.round_trip_m, all.jacobian_error, all.steps_cold,
        all.steps_warm);
    std::printf("falcon      force off by %.1e degrees, %.1e of its size\n", all.force_direction_deg,
                all.force_size_error);
}

}  // namespace

int main(int count, char** arguments) {
    Options options(count, arguments);
    const int places = static_cast<int>(options.number("places", 1'000'000));
    if (!options.understood()) {
        return 2;
    }
    Report report;
    report_kinematics(report, places);
    return report.write_json(result_path("device")) ? 0 : 1;
}
