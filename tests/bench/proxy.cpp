// The proxy, timed tick by tick and held against exact descent, beside one sphere cast of Jolt and one convex
// sweep of Bullet over the same segments; its kernels, each alone; and what it does among thousands of bodies
// and on rough meshes.
//
//     proxy [--only=PATTERN] [--most=1310720] [--ticks=N] [--rounds=5] [--checks=N] [--replays=3] [--work=N]
//           [--whole] [--three_pass --epsilon=M --epsilon_min=M --epsilon_ahead=M]
//     proxy --mesh=FILE.obj --hip=FILE.csv --radius=R [--static-friction=F --dynamic-friction=F]
//     [--two-sided]
//           --trace=OUT.csv
//
// PATTERN chooses cases by the beginning of their names, * stands for anything: sphere_1310720,
// 'rough_*_r0.2_walk'. The second form replays a hand path (x,y,z a line, one line a tick) over any mesh,
// with stiffness 1. Meshes are touched from both sides with and without --two-sided, which is there so that
// the same command line may serve engines that tell the difference.
//
// Rough meshes are touched as in a world: through what the sphere can touch of them; with --whole through all
// of their triangles, as in the first seconds of a large one and while it deforms.
//
// With --three_pass the thesis's own proxy (proxy/three_pass.hpp) plays the even and the rough meshes in
// place of ours, with those epsilons.
//
// Times are those of one whole tick (motion and force) on one processor. Even meshes: of several rounds, of
// the proxy and of the others' queries in turn, the median counts. Rough meshes: each tick the least of three
// replays of the same ticks. A segment is that of the tick: from where the proxy is to the hand.
#include <cstdio>

#include "proxy/bodies.hpp"
#include "proxy/even.hpp"
#include "proxy/kernels.hpp"
#include "proxy/rough.hpp"
#include "proxy/trace.hpp"
#include "shared/bench_kit.hpp"
#include "support/process.hpp"

namespace {

using namespace tactus;

int measure_all(shared::Options& options) {
    bench::EvenSettings even;
    bench::RoughSettings rough;
    bench::BodiesSettings bodies;
    even.only = rough.only = bodies.only = options.text("only");
    even.rounds = static_cast<int>(options.number("rounds", even.rounds));
    even.max_triangles = static_cast<int>(options.number("most", even.max_triangles));
    even.ticks = static_cast<int>(options.number("ticks", even.ticks));
    even.checks = static_cast<int>(options.number("checks", even.checks));
    rough.ticks = static_cast<int>(options.number("ticks", rough.ticks));
    rough.checks = static_cast<int>(options.number("checks", rough.checks));
    rough.replays = bodies.replays = static_cast<int>(options.number("replays", rough.replays));
    rough.max_work = static_cast<std::int64_t>(options.number("work", static_cast<double>(rough.max_work)));
    rough.narrowed = !options.has("whole");
    rough.max_triangles = static_cast<int>(options.number("most", rough.max_triangles));
    if (options.has("three_pass")) {
        bench::Epsilons epsilons;
        epsilons.base = options.number("epsilon", epsilons.base);
        epsilons.least = options.number("epsilon_min", epsilons.least);
        epsilons.ahead = options.number("epsilon_ahead", epsilons.ahead);
        even.three_pass = rough.three_pass = epsilons;
    }
    if (!options.understood() || even.ticks < 1 || rough.ticks < 1 || even.rounds < 1 || rough.replays < 1) {
        return 2;
    }
    if (!testing::stay_on_one_processor()) {
        std::fprintf(stderr, "the system does not let this program stay on one processor: times will vary\n");
    }
    const shared::SpanClock clock;
    shared::Report report;
    bench::measure_even(clock, even, report);
    if (!even.three_pass) {
        if (shared::is_chosen("friction", even.only)) {
            bench::measure_friction(report);
        }
        if (shared::is_chosen("still", even.only)) {
            bench::measure_still_hand(report);
        }
        if (shared::is_chosen("kernel.", even.only)) {
            bench::measure_kernels(clock, even.rounds, report);
        }
        bench::measure_bodies(clock, bodies, report);
    }
    bench::measure_rough(clock, rough, report);
    return report.write_json(shared::result_path("proxy")) ? 0 : 1;
}

int trace(shared::Options& options) {
    bench::TraceSettings settings;
    settings.mesh = options.text("mesh");
    settings.path = options.text("hip");
    settings.output = options.text("trace");
    settings.radius = options.number("radius", 0.0);
    settings.dynamic_friction = options.number("dynamic-friction", 0.0);
    settings.static_friction = options.number("static-friction", settings.dynamic_friction);
    options.has("two-sided");
    if (!options.understood() || settings.mesh.empty() || settings.path.empty() || settings.output.empty()) {
        std::fprintf(stderr, "proxy --mesh=FILE.obj --hip=FILE.csv --radius=R --trace=OUT.csv\n");
        return 2;
    }
    return bench::write_trace(settings);
}

}  // namespace

int main(int argc, char** argv) {
    shared::Options options(argc, argv);
    const bool traces = options.has("mesh") || options.has("hip") || options.has("trace");
    return traces ? trace(options) : measure_all(options);
}
