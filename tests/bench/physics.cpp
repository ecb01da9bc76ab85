// Things that move: what a tick with moving bodies costs, how they feel, and how right they are.
//
//     physics [--quick] [--only=tick|crowd|changes|feel|rollback|checks|awake|rolling]
//
// Writes the file that TACTUS_BENCH_JSON names (build/bench/physics.json otherwise): one flat object. Whole
// ticks are a Session's; Jolt's bare step is Jolt's own world of the same boxes, stepped in turns with it in
// the same run.
#include <algorithm>
#include <string>
#include <string_view>

#include "physics/scenes.hpp"
#include "shared/bench_kit.hpp"
#include "shared/physics_checks.hpp"

namespace {

using namespace tactus;

// Over other steps: the bench `pareto`.
void checks(bench::Results& results) {
    const shared::PhysicsCheck check = shared::check_physics(bench::tick);
    const double push = std::max({check.momentum, check.energy, check.work});
    results.add("check_fall_error_percent", check.fall);
    results.add("check_sliding_error_percent", check.sliding);
    results.add("check_push_error_percent", push);
    results.add("check_spring_throw_percent", check.thrown);
    results.add("check_spring_bounce_percent", check.bounced);
    results.add("check_spring_loss_percent", check.spring_loss);
    results.add("check_max_error_percent", std::max({check.fall, check.sliding, push, check.spring_loss}));
}

}  // namespace

int main(int count, char** arguments) {
    shared::Options options(count, arguments);
    const bool quick = options.has("quick");
    const std::string only = options.text("only");
    if (!options.understood())
        return 2;
    const int rounds = quick ? 5 : 60;
    bench::Results results;
    prepare(bench::ground());  // starts Jolt
    const auto part = [&only](std::string_view name) { return only.empty() || only == name; };
    if (part("tick"))
        bench::measure_ticks(results, rounds);
    if (part("crowd"))
        bench::measure_crowds(results, rounds);
    if (part("changes"))
        bench::measure_arrivals(results);
    if (part("feel"))
        bench::measure_feel(results);
    if (part("rollback"))
        bench::measure_rollback(results, quick);
    if (part("checks"))
        checks(results);
    if (part("awake"))
        bench::measure_awake(results, quick);
    if (part("rolling"))
        bench::measure_rolling(results, quick);
    return results.report.write_json(shared::result_path("physics")) ? 0 : 1;
}
