// What more than a point does: build/bench/tool.json.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "shared/bench_kit.hpp"
#include "shared/field_figures.hpp"
#include "shared/pair_figures.hpp"
#include "shared/rough_meshes.hpp"
#include "shared/soft_figures.hpp"
#include "shared/stack_figures.hpp"
#include "shared/tool_figures.hpp"
#include "shared/torsion_figures.hpp"
#include "tool/among.hpp"

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

void report_plays(Report& report, const std::string& name, ToolFigures& figures) {
    const double p99 = quantile(figures.microseconds, 0.99);
    const double longest = quantile(figures.microseconds, 1.0);
    report.set(name + ".ticks", figures.ticks);
    report.set(name + ".contact_ticks", figures.contact_ticks);
    report.set(name + ".unfinished", figures.unfinished);
    report.set(name + ".penetrations", figures.penetrations);
    report.set(name + ".deepest_m", figures.deepest);
    report.set(name + ".passes", figures.passes);
    report.set(name + ".still_way_m", figures.still_way);
    report.set(name + ".tick_p50_us", quantile(figures.microseconds, 0.5));
    report.set(name + ".tick_p99_us", p99);
    report.set(name + ".tick_max_us", longest);
    std::printf(
        "%s: %d ticks, %d in contact, %d unfinished; penetrations %d, passes %d, still way %g m; "
        "p50 %.0f, p99 %.0f, longest %.0f us\n",
        name.c_str(), figures.ticks, figures.contact_ticks, figures.unfinished, figures.penetrations,
        figures.passes, figures.still_way, quantile(figures.microseconds, 0.5), p99, longest);
}

void report_peg(Report& report, int angles) {
    ToolFigures all;
    for (int i = 0; i < angles; ++i) {
        for (const double tilt : {0.0, 0.1, 0.3, 0.6}) {
            all.add(play_peg(tilt, 6.2832 * i / angles, 8, i == 0 && tilt == 0.0));
        }
    }
    report_plays(report, "peg", all);
    report.set("peg.plays", all.plays);
    report.set("peg.arrivals", all.arrivals);
    report.set("peg.force_error_percent", all.force_error);
    report.set("peg.torque_error_percent", all.torque_error);
    std::printf("peg: %d of %d went in; force off by %.3f %%, torque by %.3f %%\n", all.arrivals, all.plays,
                all.force_error, all.torque_error);
}

void report_rough(Report& report, int ticks) {
    const tactus::TriangleMesh mesh = displaced(6);
    ToolFigures all = play_rough(mesh, mesh, ticks, 10, 1);
    report_plays(report, "rough_on_rough", all);
}

void report_stack(Report& report) {
    ToolFigures all;
    int lost = 0;
    for (const double speed : {0.1, 0.2, 0.4}) {
        for (const double aside : {-0.05, -0.02, 0.0, 0.03}) {
            const StackFigures figures = push_stack(speed, aside);
            all.add(figures.tool);
            lost += figures.lost;
        }
    }
    report_plays(report, "stack", all);
    report.set("stack.lost", lost);
    std::printf("stack: lost for %d ticks, %.3f mm in a box at most\n", lost, 1e3 * all.deepest);
}

void report_pair(Report& report, int ticks) {
    PairFigures all;
    for (const double ratio : {1.0, 0.2, 5.0}) {
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const PairFigures pressed = press_pair(ratio, seed);
            all.tool.add(pressed.tool);
            all.balance_error = std::max(all.balance_error, pressed.balance_error);
        }
    }
    all.tool.add(rub_pair(ticks, 500, 1).tool);
    const PairFigures slid = slide_pair();
    report_plays(report, "pair", all.tool);
    report.set("pair.force_error_percent", all.tool.force_error);
    report.set("pair.torque_error_percent", all.tool.torque_error);
    report.set("pair.balance_error_percent", all.balance_error);
    report.set("pair.friction_error_percent", slid.friction_error);
    std::printf(
        "pair: force off by %.3f %%, torque by %.3f %%, one hand's from the other's by %.4f %%, friction "
        "from Coulomb's by %.3f %%\n",
        all.tool.force_error, all.tool.torque_error, all.balance_error, slid.friction_error);
}

void report_field(Report& report, int samples, int ticks) {
    double error = 0.0;
    double p99 = 0.0;
    for (const double radius : {0.05, 0.02}) {
        FieldFigures figures = play_field_sphere(static_cast<std::uint32_t>(samples), radius, ticks);
        const std::string name = "field.r" + std::to_string(radius).substr(0, 4);
        const double of_these = quantile(figures.microseconds, 0.99);
        report.set(name + ".error_voxel_max", figures.error_voxels);
        report.set(name + ".height_error_voxel_max", figures.height_error_voxels);
        report.set(name + ".contact_ticks", figures.contact_ticks);
        report.set(name + ".unfinished", figures.unfinished);
        report.set(name + ".tick_p50_us", quantile(figures.microseconds, 0.5));
        report.set(name + ".tick_p99_us", of_these);
        report.set(name + ".tick_max_us", quantile(figures.microseconds, 1.0));
        report.set(name + ".free_tick_p50_us", quantile(figures.free_microseconds, 0.5));
        report.set(name + ".triangles", figures.triangles);
        report.set(name + ".build_ms", figures.build_milliseconds);
        std::printf(
            "%s: %d^3 samples, %.0f triangles in %.0f ms; %d ticks in contact, %d unfinished; off by %.4f "
            "voxels, %.4f in height; p50 %.2f, p99 %.2f, longest %.2f us\n",
            name.c_str(), samples, figures.triangles, figures.build_milliseconds, figures.contact_ticks,
            figures.unfinished, figures.error_voxels, figures.height_error_voxels,
            quantile(figures.microseconds, 0.5), of_these, quantile(figures.microseconds, 1.0));
        error = std::max(error, figures.error_voxels);
        p99 = std::max(p99, of_these);
    }
    report.set("field.error_voxel_max", error);
    report.set("field.tick_p99_us", p99);
}

void report_presses(Report& report, const std::string& name, SoftFigures& figures) {
    report.set(name + ".nodes", static_cast<double>(figures.nodes));
    report.set(name + ".elements", static_cast<double>(figures.elements));
    report.set(name + ".triangles", static_cast<double>(figures.triangles));
    report.set(name + ".factor_entries", static_cast<double>(figures.factor_entries));
    report.set(name + ".presses", figures.presses);
    report.set(name + ".contact_ticks", figures.contact_ticks);
    report.set(name + ".passes", figures.passes);
    report.set(name + ".unfinished", figures.unfinished);
    report.set(name + ".deepest_m", figures.deepest);
    report.set(name + ".force_max_n", figures.largest_force);
    report.set(name + ".energy_created_J", figures.energy_created);
    report.set(name + ".energy_created_held_J", figures.energy_created_held);
    report.set(name + ".energy_held_over_damped", figures.held_share);
    report.set(name + ".shape_error_m", figures.shape_error);
    report.set(name + ".tick_p50_us", quantile(figures.microseconds, 0.5));
    report.set(name + ".tick_p99_us", quantile(figures.microseconds, 0.99));
    report.set(name + ".tick_max_us", quantile(figures.microseconds, 1.0));
    report.set(name + ".still_tick_p50_us", quantile(figures.still_microseconds, 0.5));
    std::printf(
        "%s: %zu nodes, %zu elements, %zu entries; %d presses, %d ticks in contact, %d passes, %d "
        "unfinished; "
        "%.1f mm deep, %.1f N; created %g J (held %g J, %.3f of what a device damps), shape off by %g mm; "
        "p50 %.0f, p99 %.0f, longest "
        "%.0f, "
        "asleep %.1f us\n",
        name.c_str(), figures.nodes, figures.elements, figures.factor_entries, figures.presses,
        figures.contact_ticks, figures.passes, figures.unfinished, 1e3 * figures.deepest,
        figures.largest_force, figures.energy_created, figures.energy_created_held, figures.held_share,
        1e3 * figures.shape_error, quantile(figures.microseconds, 0.5), quantile(figures.microseconds, 0.99),
        quantile(figures.microseconds, 1.0), quantile(figures.still_microseconds, 0.5));
}

void report_soft(Report& report, int presses) {
    SoftFigures block = press_block(presses, 1e4, 7);
    report_presses(report, "soft.block", block);
    SoftFigures cloth = press_cloth(presses, 1e6, 7);
    report_presses(report, "soft.cloth", cloth);
    report.set("soft.tick_p99_us",
               std::max(quantile(block.microseconds, 0.99), quantile(cloth.microseconds, 0.99)));
    report.set("soft.passes", block.passes + cloth.passes);
    report.set("soft.energy_created_J", std::max(block.energy_created, cloth.energy_created));
    report.set("soft.shape_error_m", std::max(block.shape_error, cloth.shape_error));
    for (const double stiffness : {1e3, 1e4, 1e5, 1e6}) {
        constexpr int iterations[] = {1, 2, 4, 8};
        const std::vector<SoftAccuracy> all = soft_accuracy(stiffness, iterations);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const SoftAccuracy& accuracy = all[i];
            const std::string name = "soft.accuracy." + std::to_string(static_cast<int>(stiffness)) + "_Pa." +
                                     std::to_string(iterations[i]);
            report.set(name + ".force_error_percent", accuracy.force_error_percent);
            report.set(name + ".static_error_percent", accuracy.static_error_percent);
            report.set(name + ".step_us", accuracy.step_microseconds);
            std::printf("%s: force off by %.2f %% on the way, %.3f %% at rest; %.0f us\n", name.c_str(),
                        accuracy.force_error_percent, accuracy.static_error_percent,
                        accuracy.step_microseconds);
        }
    }
}

}  // namespace

int main(int count, char** arguments) {
    Options options(count, arguments);
    const std::string only = options.text("only");
    const int angles = static_cast<int>(options.number("angles", 8));
    const int ticks = static_cast<int>(options.number("ticks", 10'000));
    const int samples = static_cast<int>(options.number("samples", 128));
    const int presses = static_cast<int>(options.number("presses", 200));
    if (!options.understood()) {
        return 2;
    }
    Report report;
    if (is_chosen("torsion", only)) {
        report_torsion(report);
    }
    if (is_chosen("peg", only)) {
        report_peg(report, angles);
    }
    if (is_chosen("stack", only)) {
        report_stack(report);
    }
    if (is_chosen("pair", only)) {
        report_pair(report, ticks);
    }
    if (is_chosen("field", only)) {
        report_field(report, samples, ticks);
    }
    if (is_chosen("soft", only)) {
        report_soft(report, presses);
    }
    if (is_chosen("among", only, false)) {
        tactus::bench::measure_among(only, report);
    }
    if (is_chosen("rough_on_rough", only)) {
        report_rough(report, ticks);
    }
    return report.write_json(result_path("tool")) ? 0 : 1;
}
