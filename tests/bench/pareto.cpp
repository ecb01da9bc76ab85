// Run time against error: what each choice costs and what it buys.
//
//     pareto [--ticks=10000] [--rounds=3] [--checks=400]
//
// One sphere of radius 1, one proxy of radius 0.05, the hand of the bench `proxy`. Each row changes one
// choice:
//   steps N       at most N steps of the proxy a tick (the default is 64)
//   triangles N   the mesh's resolution; error against the smooth sphere as well
//   shaded N      the same with force shading: the proxy stays on the facets, the force turns smoothly
//   closed form   the sphere as a sphere
//   float         mesh, hand and proxy rounded to single precision, as in an engine that computes with floats
//   physics T     the time step of the bodies that move (in milliseconds; the default is 1): errors of
//   motions
//                 with an exact solution (shared/physics_checks.hpp) against the run time of a second
//   at D          everything D metres from the origin: the proxy's tolerances grow with the largest
//   coordinate
//                 (core/proxy/tolerances.hpp), so these are the rows of looser tolerances
// Errors: `facets` against exact descent on the same facets, `sphere` against the place on the smooth sphere
// that is nearest to the hand; `deg`: largest angle between the pull and the right pull, from a depth of 1e-4
// on (degrees). `force`: angle between the force on the hand and that of the smooth sphere, likewise.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "core/haptics/force_law.hpp"
#include "shared/bench_kit.hpp"
#include "shared/hand_paths.hpp"
#include "shared/meshes.hpp"
#include "shared/physics_checks.hpp"
#include "shared/reference_descent.hpp"
#include "shared/touch_rig.hpp"
#include "support/process.hpp"

namespace {

using namespace tactus;
using shared::quantile;
using shared::Report;
using shared::SpanClock;
using shared::TouchRig;

constexpr double radius = 0.05;

struct Row {
    std::string name;
    int level = 4;  // of the icosphere; below 0: the sphere in closed form
    int max_steps = 64;
    bool in_float = false;
    bool shaded = false;
    double from_origin = 0.0;  // (unit: meters)
};

struct Settings {
    int ticks = 10'000;
    int rounds = 3;
    int checks = 400;
};

struct Figures {
    double median = 1e300, p99 = 1e300;                     // (unit: microseconds)
    double facets_rms = 0.0, facets_max = 0.0;              // (unit: meters)
    double sphere_rms = 0.0, sphere_max = 0.0;              // (unit: meters)
    double direction_facets = 0.0, direction_sphere = 0.0;  // largest (unit: degrees)
    double force_rms = 0.0, force_max = 0.0;                // (unit: degrees)
    double unfinished = 0.0;                                // share of the contact ticks
};

Vec3 to_float(const Vec3& v) {
    return Vec3(glm::vec3(v));
}

double degrees_between(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / std::numbers::pi;
}

Figures measure(const SpanClock& clock, const Settings& settings, const Row& row) {
    TriangleMesh mesh = shared::icosphere(std::max(row.level, 0), 1.0);
    TriangleMesh touched = mesh;
    std::vector<Vec3> way = shared::around_sphere(radius, settings.ticks);
    const Vec3 place = row.from_origin * glm::normalize(Vec3(0.6, 0.5, -0.7));
    for (std::vector<Vec3>* points : {&mesh.vertices, &touched.vertices, &way}) {
        for (Vec3& point : *points) {
            point += place;
        }
    }
    const std::vector<Vec3> exact_way = way;
    if (row.in_float) {
        std::ranges::transform(touched.vertices, touched.vertices.begin(), to_float);
        std::ranges::transform(way, way.begin(), to_float);
    }
    Figures figures;
    std::vector<ProxyTick> ticks;
    std::vector<bool> touching;
    std::vector<Vec3> forces;
    for (int round = 0; round < settings.rounds; ++round) {
        TouchRig rig(radius);
        // Facets of the coarsest sphere meet at 42 degrees.
        constexpr double smooth_below = 0.8;
        row.level < 0 ? rig.add(SphereShape{1.0}, Pose{place, Quat(1.0, 0.0, 0.0, 0.0)})
                      : rig.add(Shape(MeshShape{std::make_shared<const TriangleMesh>(touched),
                                                row.shaded ? smooth_below : 0.0}));
        ProxySettings proxy = rig.proxy.settings();
        proxy.max_steps = row.max_steps;
        rig.proxy.set_settings(proxy);
        ticks.clear();
        touching.clear();
        forces.clear();
        std::vector<double> times;
        for (const Vec3& hand : way) {
            const std::uint64_t start = clock.now();
            const ProxyTick tick = rig.tick(hand);
            const HandForce force =
                contact_force(rig.scene, rig.proxy.touching(), tick.slide, Vec3(0.0), 1e-3);
            const double time = clock.nanoseconds(start, clock.now()) * 1e-3;
            ticks.push_back(tick);
            if (row.in_float) {
                ticks.back().position = to_float(tick.position);
            }
            touching.push_back(force.contact_count > 0);
            forces.push_back(force.total);
            if (touching.back()) {
                times.push_back(time);
            }
        }
        figures.median = std::min(figures.median, quantile(times, 0.5));
        figures.p99 = std::min(figures.p99, quantile(times, 0.99));
    }
    shared::ReferenceDescent reference(mesh, radius);
    const auto contact = static_cast<int>(std::ranges::count(touching, true));
    const int every = std::max(1, contact / settings.checks);
    int seen = 0;
    int checked = 0;
    int deep_ticks = 0;
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        if (!touching[i]) {
            continue;
        }
        const Vec3& p = ticks[i].position;
        const Vec3& hand = exact_way[i];
        figures.unfinished += (ticks[i].status & proxy_unfinished) ? 1.0 / contact : 0.0;
        const Vec3 on_sphere = place + (1.0 + radius) * glm::normalize(hand - place);
        figures.sphere_max = std::max(figures.sphere_max, glm::distance(p, on_sphere));
        figures.sphere_rms += glm::dot(p - on_sphere, p - on_sphere) / contact;
        const bool deep = glm::distance(p, hand) > 1e-4;
        if (deep) {
            figures.direction_sphere =
                std::max(figures.direction_sphere, degrees_between(p - hand, on_sphere - hand));
            const double off = degrees_between(forces[i], on_sphere - hand);
            figures.force_max = std::max(figures.force_max, off);
            figures.force_rms += off * off;
            ++deep_ticks;
        }
        if (row.level >= 0 && seen++ % every == 0) {
            const Vec3 right(reference.settle(p, hand).position);
            const double error = glm::distance(p, right);
            figures.facets_max = std::max(figures.facets_max, error);
            figures.facets_rms += error * error;
            if (deep) {
                figures.direction_facets =
                    std::max(figures.direction_facets, degrees_between(p - hand, right - hand));
            }
            ++checked;
        }
    }
    figures.facets_rms = checked > 0 ? std::sqrt(figures.facets_rms / checked) : 0.0;
    figures.sphere_rms = std::sqrt(figures.sphere_rms);
    figures.force_rms = std::sqrt(figures.force_rms / std::max(1, deep_ticks));
    return figures;
}

void physics(Report& report, int rounds) {
    std::printf("%-18s %10s %10s %10s %10s %10s %10s\n", "physics, step", "ms a s", "fall %", "sliding %",
                "momentum %", "energy %", "spring %");
    for (const double milliseconds : {0.25, 0.5, 1.0, 2.0, 4.0}) {
        shared::PhysicsCheck check = shared::check_physics(1e-3 * milliseconds);
        for (int round = 1; round < rounds; ++round) {
            check.run_time = std::min(check.run_time, shared::check_physics(1e-3 * milliseconds).run_time);
        }
        char name[32];
        std::snprintf(name, sizeof name, "physics_%g_ms", milliseconds);
        std::printf("%-18s %10.3f %10.4f %10.4f %10.4f %10.4f %10.4f\n", name, 1e3 * check.run_time,
                    check.fall, check.sliding, check.momentum, check.energy, check.spring_loss);
        const std::string row = std::string(name) + '.';
        report.set(row + "run_ms_per_s", 1e3 * check.run_time);
        report.set(row + "fall_error_percent", check.fall);
        report.set(row + "sliding_error_percent", check.sliding);
        report.set(row + "momentum_error_percent", check.momentum);
        report.set(row + "energy_error_percent", check.energy);
        report.set(row + "work_error_percent", check.work);
        report.set(row + "spring_energy_loss_percent", check.spring_loss);
    }
}

}  // namespace

int main(int argc, char** argv) {
    shared::Options options(argc, argv);
    Settings settings;
    settings.ticks = static_cast<int>(options.number("ticks", settings.ticks));
    settings.rounds = static_cast<int>(options.number("rounds", settings.rounds));
    settings.checks = static_cast<int>(options.number("checks", settings.checks));
    if (!options.understood()) {
        return 2;
    }
    std::vector<Row> rows;
    for (const int steps : {1, 2, 3, 4, 6, 8, 16, 64}) {
        rows.push_back({"steps_" + std::to_string(steps), 4, steps});
    }
    for (int level = 1; level <= 7; ++level) {
        rows.push_back({"triangles_" + std::to_string(20 << (2 * level)), level});
    }
    for (int level = 1; level <= 7; ++level) {
        rows.push_back({"shaded_" + std::to_string(20 << (2 * level)), level, 64, false, true});
    }
    rows.push_back({"closed_form", -1});
    rows.push_back({"float_5120", 4, 64, true});
    for (const auto& [name, distance] : {std::pair{"at_1e4", 1e4}, {"at_1e6", 1e6}, {"at_1e8", 1e8}}) {
        rows.push_back({name, 4, 64, false, false, distance});
    }
    testing::stay_on_one_processor();
    const SpanClock clock;
    Report report;
    std::printf("%-18s %8s %8s %10s %10s %9s %10s %10s %9s %9s %10s\n", "choice", "med us", "p99 us",
                "facets rms", "max", "deg", "sphere rms", "max", "deg", "force deg", "unfinished");
    for (const Row& row : rows) {
        const Figures f = measure(clock, settings, row);
        std::printf("%-18s %8.2f %8.2f %10.1e %10.1e %9.1e %10.1e %10.1e %9.1e %9.1e %10.4f\n",
                    row.name.c_str(), f.median, f.p99, f.facets_rms, f.facets_max, f.direction_facets,
                    f.sphere_rms, f.sphere_max, f.direction_sphere, f.force_rms, f.unfinished);
        std::fflush(stdout);
        report.set(row.name + ".contact_median_us", f.median);
        report.set(row.name + ".contact_p99_us", f.p99);
        if (row.level >= 0) {
            report.set(row.name + ".facets_error_rms", f.facets_rms);
            report.set(row.name + ".facets_error_max", f.facets_max);
            report.set(row.name + ".facets_direction_max_deg", f.direction_facets);
        }
        report.set(row.name + ".sphere_error_rms", f.sphere_rms);
        report.set(row.name + ".sphere_error_max", f.sphere_max);
        report.set(row.name + ".sphere_direction_max_deg", f.direction_sphere);
        report.set(row.name + ".force_direction_rms_deg", f.force_rms);
        report.set(row.name + ".force_direction_max_deg", f.force_max);
        report.set(row.name + ".unfinished_share", f.unfinished);
    }
    physics(report, std::max(20, settings.rounds));
    return report.write_json(shared::result_path("pareto")) ? 0 : 1;
}
