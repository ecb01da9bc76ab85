// What a hand feels of changes of the scene, and whether what deforms passes it: build/bench/kick.json.
//
//   --seeds=N   runs of each kind of change, and of each kind of script's force (200)
//   --deformations=N   of meshes (10000)
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <string>

#include "shared/bench_kit.hpp"
#include "shared/deforms.hpp"
#include "shared/kicks.hpp"
#include "shared/script_forces.hpp"

namespace {

using namespace tactus::shared;

void report_kicks(Report& report, int seeds) {
    KickFigures all;
    const auto tell = [&](const std::string& name, const KickFigures& figures) {
        report.set("kick." + name + ".force_step_max_N", figures.force_step_max);
        report.set("kick." + name + ".torque_step_max_Nm", figures.torque_step_max);
        report.set("kick." + name + ".force_max_N", figures.force_max);
        report.set("kick." + name + ".events", figures.events);
        report.set("kick." + name + ".let_out", figures.let_out);
        report.set("kick." + name + ".overlaps", figures.overlaps);
        report.set("kick." + name + ".imprisoned", figures.imprisoned);
        report.set("kick." + name + ".untouchable", figures.untouchable);
        std::printf(
            "kick %-10s step %.3f N, %.4f Nm, %d events, %d let out, overlaps %d, imprisoned %d, untouchable "
            "%d\n",
            name.c_str(), figures.force_step_max, figures.torque_step_max, figures.events, figures.let_out,
            figures.overlaps, figures.imprisoned, figures.untouchable);
    };
    for (const KickCase kick : kick_cases) {
        KickFigures figures;
        for (int seed = 0; seed < seeds; ++seed) {
            figures.add(play_kick(kick, 1'000 + static_cast<std::uint64_t>(seed)));
        }
        tell(std::string(name_of(kick)), figures);
        all.add(figures);
    }
    tell("all", all);
}

constexpr double allowed_energy = 0.01;  // of a run (unit: joules)

// At even frames, and where one of ten takes 30 to 100 ms.
void report_scripts(Report& report, int seeds) {
    int late_beyond = 0;
    double late_made = 0.0;
    for (const ScriptForm form : script_forms) {
        ScriptFigures figures, late;
        for (int i = 0; i < seeds; ++i) {
            const std::uint64_t seed = 1'000 + static_cast<std::uint64_t>(i);
            figures.add(play_script(form, seed));
            const ScriptFigures one = play_script(form, seed, {0.0, 0.1});
            late_beyond += one.energy_made_max > allowed_energy ? 1 : 0;
            late.add(one);
        }
        const std::string name = "script." + std::string(name_of(form));
        report.set(name + ".energy_made_max_J", figures.energy_made_max);
        report.set(name + ".late_frames_energy_made_max_J", late.energy_made_max);
        report.set(name + ".shake_max_mm", 1e3 * figures.shake_max);
        report.set(name + ".limited", figures.limited);
        std::printf("script %-8s %d runs, %d limited, %.4f J made (late frames: %.4f), shaking by %.2f mm\n",
                    std::string(name_of(form)).c_str(), figures.runs, figures.limited,
                    figures.energy_made_max, late.energy_made_max, 1e3 * figures.shake_max);
        late_made = std::max(late_made, late.energy_made_max);
    }
    report.set("script.late_frames_energy_made_max_J", late_made);
    report.set("script.late_frames_beyond_share",
               static_cast<double>(late_beyond) / (seeds * static_cast<double>(std::size(script_forms))));
    std::printf("script with late frames: at most %.4f J made, %d runs beyond %.2f J\n", late_made,
                late_beyond, allowed_energy);
}

void report_deforms(Report& report, int deformations) {
    DeformFigures figures;
    for (std::uint64_t seed = 100'000; figures.deformations < deformations; ++seed) {
        figures.add(play_deforms(seed));
    }
    report.set("deform.deformations", figures.deformations);
    report.set("deform.passes", figures.passes);
    report.set("deform.let_out", figures.let_out);
    report.set("deform.touched", figures.touched);
    report.set("deform.farthest_radii", figures.farthest);
    std::printf("deform     %d, passes %d, let out %d, touched %d, up to %.1f radii\n", figures.deformations,
                figures.passes, figures.let_out, figures.touched, figures.farthest);
}

}  // namespace

int main(int count, char** arguments) {
    Options options(count, arguments);
    const int seeds = static_cast<int>(options.number("seeds", 200));
    const int deformations = static_cast<int>(options.number("deformations", 10'000));
    if (!options.understood()) {
        return 2;
    }
    Report report;
    report_kicks(report, seeds);
    report_scripts(report, seeds);
    report_deforms(report, deformations);
    return report.write_json(result_path("kick")) ? 0 : 1;
}
