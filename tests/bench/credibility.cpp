// How right free bodies move, and what a hand feels from them, against closed forms.
//
//     credibility [--only=friction|spin|rolling|hand|slowed|joints|crowd|soft]
//
// Writes the file that TACTUS_BENCH_JSON names (build/bench/credibility.json otherwise): CASE.ours and, where
// there is a closed form, CASE.right, in SI units, and what is a figure by itself. ./run bench credibility
// then asks MuJoCo (tools/credibility/), adds the deviations and writes the table. All runs are in virtual
// time: the same figures on each run.
#include <string>
#include <string_view>

#include "credibility/cases.hpp"

int main(int count, char** arguments) {
    using namespace tactus;
    shared::Options options(count, arguments);
    const std::string only = options.text("only");
    if (!options.understood())
        return 2;
    bench::Results results;
    const auto part = [&only](std::string_view name) { return only.empty() || only == name; };
    if (part("friction"))
        bench::measure_friction(results);
    if (part("spin"))
        bench::measure_spin(results);
    if (part("rolling"))
        bench::measure_rolling_bodies(results);
    if (part("hand"))
        bench::measure_hand(results);
    if (part("slowed"))
        bench::measure_slowed(results);
    if (part("joints"))
        bench::measure_joints(results);
    if (part("crowd"))
        bench::measure_stacks(results);
    if (part("soft"))
        bench::measure_soft(results);
    return results.report.write_json(shared::result_path("credibility")) ? 0 : 1;
}
