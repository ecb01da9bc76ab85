// What is seen: depth images of seeded scenes, held against their truth. build/bench/sensing.json.
//
//   --scenes=N   of each kind (200)
//   --first=N    seed of the first scene (5000): nothing was tuned on the scenes from there on
//   --only=PART  still, far, uncalibrated, moving, recovery, rest, parameters, tick, pcl
//   --talk       of every object that was seen wrong
#include <cstdio>

#include "sensing/sensing_figures.hpp"

using namespace tactus;
using namespace tactus::shared;

int main(int count, char** arguments) {
    Options options(count, arguments);
    SensingCase bench;
    bench.scenes = static_cast<int>(options.number("scenes", 200));
    bench.first = static_cast<std::uint64_t>(options.number("first", 5000));
    bench.talks = options.has("talk");
    const std::string only = options.text("only");
    if (!options.understood()) {
        return 2;
    }
    bench.library = library_meshes(six_meshes());
    const SpanClock clock;
    const std::uint64_t from = clock.now();
    std::vector<LearntMesh> meshes(bench.library.size());
    run_on_two_threads(meshes.size(), [&](std::size_t i) { meshes[i] = learn_mesh(bench.library[i], {}); });
    const double learning = 1e-6 * clock.nanoseconds(from, clock.now());
    bench.meshes = std::make_shared<const std::vector<LearntMesh>>(std::move(meshes));
    const auto is_wanted = [&only](const char* part) { return only.empty() || is_chosen(part, only); };
    Report report;
    report.set("learning_ms", learning);
    std::printf("learning       six meshes in %.0f ms\n", learning);
    if (is_wanted("still")) {
        report_still(report, bench, "", 0.85, true);
    }
    if (is_wanted("far")) {
        report_still(report, bench, "far.", 1.3, true);
    }
    if (is_wanted("uncalibrated")) {
        report_still(report, bench, "uncalibrated.", 0.85, false);
    }
    if (is_wanted("moving")) {
        report_moving(report, bench);
    }
    if (is_wanted("recovery")) {
        report_recovery(report, bench);
    }
    if (is_wanted("rest")) {
        report_rest(report, bench);
    }
    if (is_wanted("parameters")) {
        report_parameters(report, bench);
    }
    if (is_wanted("tick")) {
        report_tick(report, bench);
    }
    if (is_wanted("pcl")) {
        report_rival(report, bench);
    }
    return report.write_json(result_path("sensing")) ? 0 : 1;
}
