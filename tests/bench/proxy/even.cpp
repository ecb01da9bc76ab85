#include "proxy/even.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <tuple>
#include <utility>

#include "proxy/players.hpp"
#include "proxy/rivals.hpp"
#include "shared/hand_paths.hpp"
#include "shared/judge_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/reference_descent.hpp"
#include "shared/settled_shape.hpp"

namespace tactus::bench {

namespace {

using shared::Report;
using shared::SpanClock;

struct Tick {
    Vec3 hand;
    PlayedTick proxy;
    Segment segment;
    double nanoseconds = 0.0;
};

template <class Player>
std::vector<Tick> replay(const SpanClock& clock, Player& player, const std::vector<Vec3>& way) {
    std::vector<Tick> ticks;
    ticks.reserve(way.size());
    Vec3 before = way.front();
    for (const Vec3& hand : way) {
        const std::uint64_t start = clock.now();
        const PlayedTick tick = player.tick(hand);
        const std::uint64_t end = clock.now();
        ticks.push_back({hand, tick, {before, hand}, clock.nanoseconds(start, end)});
        before = tick.position;
    }
    return ticks;
}

bool is_touching(const Tick& tick) {
    return tick.proxy.touching;
}

struct Errors {
    double rms = 0.0, p99 = 0.0, max = 0.0;  // (unit: meters)
    double direction = 0.0;                  // (unit: degrees)
    int unsettled = 0, stuck = 0, checked = 0;
    int passes = 0;  // ticks in which the center went through a triangle
};

// A tick is stuck when the proxy stops short of the place that descent reaches from it.
Errors errors_of(const std::vector<Tick>& ticks, const shared::JudgeTree& tree, double radius, int checks) {
    shared::ReferenceDescent reference(tree, radius);
    const auto touching = static_cast<int>(std::ranges::count_if(ticks, is_touching));
    const int every = std::max(1, touching / std::max(1, checks));
    Errors errors;
    std::vector<double> all;
    double sum = 0.0;
    int seen = 0;
    Vec3 before = ticks.front().proxy.position;
    for (const Tick& tick : ticks) {
        errors.passes += !(tick.proxy.status & proxy_absent) &&
                         tree.first_crossing(before, tick.proxy.position - before) <= 1.0;
        before = tick.proxy.position;
        if (!tick.proxy.touching) {
            continue;
        }
        const bool unfinished = tick.proxy.status & proxy_unfinished;
        if (seen++ % every != 0 && !unfinished) {
            continue;
        }
        const shared::ReferencePlace place = reference.settle(tick.proxy.position, tick.hand);
        errors.unsettled += !place.settled;
        const auto error =
            static_cast<double>(glm::distance(place.position, shared::SlowVec3(tick.proxy.position)));
        const Vec3 pull = tick.proxy.position - tick.hand;
        const Vec3 right_pull = Vec3(place.position) - tick.hand;
        const double sine = glm::length(glm::cross(pull, right_pull));
        errors.direction = std::max(errors.direction,
                                    std::atan2(sine, glm::dot(pull, right_pull)) * 180.0 / std::numbers::pi);
        errors.max = std::max(errors.max, error);
        errors.stuck += error > 1e-5 || unfinished;
        sum += error * error;
        all.push_back(error);
        ++errors.checked;
    }
    errors.p99 = shared::quantile(all, 0.99);
    errors.rms = errors.checked > 0 ? std::sqrt(sum / errors.checked) : 0.0;
    return errors;
}

std::vector<Segment> contact_segments(const std::vector<Tick>& ticks, std::size_t count) {
    std::vector<Segment> segments;
    for (const Tick& tick : ticks) {
        if (tick.proxy.touching) {
            segments.push_back(tick.segment);
        }
    }
    const std::size_t every = std::max<std::size_t>(1, segments.size() / count);
    std::vector<Segment> chosen;
    for (std::size_t i = 0; i < segments.size(); i += every) {
        chosen.push_back(segments[i]);
    }
    return chosen;
}

double median(std::vector<double> values) {
    return shared::quantile(values, 0.5);
}

// Of several rounds, each summed up by itself (unit: microseconds).
struct Rounds {
    std::vector<double> contact_mean, contact_median, contact_p95, contact_p99, free_median;
    std::vector<double> least;  // of each tick

    void add(const std::vector<Tick>& ticks) {
        std::vector<double> contact, free;
        double sum = 0.0;
        least.resize(ticks.size(), 1e300);
        for (std::size_t i = 0; i < ticks.size(); ++i) {
            const Tick& tick = ticks[i];
            least[i] = std::min(least[i], tick.nanoseconds * 1e-3);
            (tick.proxy.touching ? contact : free).push_back(tick.nanoseconds * 1e-3);
            sum += tick.proxy.touching ? tick.nanoseconds * 1e-3 : 0.0;
        }
        contact_mean.push_back(sum / std::max<double>(1.0, static_cast<double>(contact.size())));
        contact_median.push_back(shared::quantile(contact, 0.5));
        contact_p95.push_back(shared::quantile(contact, 0.95));
        contact_p99.push_back(shared::quantile(contact, 0.99));
        free_median.push_back(shared::quantile(free, 0.5));
    }
    // The longest tick, each being the least of its rounds.
    double max() const { return *std::ranges::max_element(least); }
};

// Median time of the query over the segments (unit: microseconds).
double time_of(const SpanClock& clock, Rival& rival, const std::vector<Segment>& segments) {
    std::vector<double> times;
    for (const Segment& segment : segments) {
        const std::uint64_t start = clock.now();
        rival.cast(segment);
        times.push_back(clock.nanoseconds(start, clock.now()) * 1e-3);
    }
    return shared::quantile(times, 0.5);
}

double build_milliseconds(const TriangleMesh& mesh, int rounds) {
    std::vector<double> times;
    for (int i = 0; i < rounds; ++i) {
        const auto start = std::chrono::steady_clock::now();
        const TriangleTree tree = TriangleTree::build(mesh, shared::run_on_two_threads);
        times.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    return median(times);
}

std::string case_name(const std::string& mesh, double radius) {
    char text[32];
    std::snprintf(text, sizeof text, "_r%g", radius);
    return mesh + text;
}

// One mesh with its tree, its judge and what others make of it.
struct Built {
    const TriangleMesh& mesh;
    std::shared_ptr<const TouchShape> shape;
    shared::JudgeTree judge;
    double build_ms;

    Built(const TriangleMesh& triangles, int rounds) : mesh(triangles), judge(triangles) {
        const PlacedShape placed{MeshShape{std::make_shared<const TriangleMesh>(triangles)}, {}};
        shape = make_touch_shape({&placed, 1}, shared::run_on_two_threads).shape;
        shared::settle(*shape);
        build_ms = build_milliseconds(triangles, rounds);
    }
};

// The ticks, and the bytes that the proxy has of the mesh.
std::pair<std::vector<Tick>, double> play(const SpanClock& clock, const EvenSettings& settings,
                                          const Built& built, double radius, const std::vector<Vec3>& way) {
    if (settings.three_pass) {
        ThreePassPlayer player(built.judge, radius, *settings.three_pass);
        return {replay(clock, player, way), player.bytes()};
    }
    OurPlayer player(built.shape, radius, ProxySettings{}.max_work);
    return {replay(clock, player, way), player.bytes()};
}

// One round of each player after the other, several times over: what the machine takes away meanwhile hits
// all alike.
void measure(const SpanClock& clock, const EvenSettings& settings, const std::string& name,
             const Built& built, double radius, const std::vector<Vec3>& way, Report& report) {
    Rounds rounds;
    std::vector<Tick> ticks;
    std::vector<Segment> segments;
    std::vector<std::unique_ptr<Rival>> rivals;
    if (!settings.three_pass) {
        rivals = make_rivals(built.mesh, radius);
    }
    std::vector<std::vector<double>> rival_times(rivals.size());
    double bytes = 0.0;
    for (int round = 0; round < settings.rounds; ++round) {
        std::tie(ticks, bytes) = play(clock, settings, built, radius, way);
        rounds.add(ticks);
        if (round == 0) {
            segments = contact_segments(ticks, 3'000);
        }
        for (std::size_t i = 0; i < rivals.size(); ++i) {
            rival_times[i].push_back(time_of(clock, *rivals[i], segments));
        }
    }
    const Errors errors = errors_of(ticks, built.judge, radius, settings.checks);
    const double tick_us = median(rounds.contact_median);
    const double bytes_per_triangle = bytes / static_cast<double>(built.mesh.triangles.size());
    report.set(name + ".contact_median_us", tick_us);
    report.set(name + ".contact_mean_us", median(rounds.contact_mean));
    report.set(name + ".contact_p95_us", median(rounds.contact_p95));
    report.set(name + ".contact_p99_us", median(rounds.contact_p99));
    report.set(name + ".max_us", rounds.max());
    report.set(name + ".free_median_us", median(rounds.free_median));
    report.set(name + ".contact_ticks", static_cast<double>(std::ranges::count_if(ticks, is_touching)));
    report.set(name + ".error_rms", errors.rms);
    report.set(name + ".error_p99", errors.p99);
    report.set(name + ".error_max", errors.max);
    report.set(name + ".passes", errors.passes);
    report.set(name + ".force_direction_max_deg", errors.direction);
    report.set(name + ".stuck_ticks", errors.stuck);
    report.set(name + ".checked_ticks", errors.checked);
    report.set(name + ".reference_unsettled", errors.unsettled);
    report.set(name + ".build_ms", built.build_ms);
    report.set(name + ".bytes_per_triangle", bytes_per_triangle);
    std::printf("%-22s %8.2f %8.2f %8.2f %9.2f %8.3f %9.1e %9.1e %9.1e %5d %8.1f %6.1f", name.c_str(),
                tick_us, median(rounds.contact_p95), median(rounds.contact_p99), rounds.max(),
                median(rounds.free_median), errors.rms, errors.max, errors.direction, errors.stuck,
                built.build_ms, bytes_per_triangle);
    for (std::size_t i = 0; i < rivals.size(); ++i) {
        const double rival_us = median(rival_times[i]);
        report.set(name + "." + rivals[i]->name + "_us", rival_us);
        report.set(name + "." + rivals[i]->name + "_over_tick", rival_us / tick_us);
        std::printf("  %s %.2f us, %.1f x", rivals[i]->name.c_str(), rival_us, rival_us / tick_us);
    }
    std::printf("\n");
    std::fflush(stdout);
}

template <class MakeWay>
void measure_mesh(const SpanClock& clock, const EvenSettings& settings, const std::string& name,
                  const TriangleMesh& mesh, MakeWay&& way, Report& report) {
    std::unique_ptr<const Built> built;
    for (const double radius : {0.05, 0.01}) {
        const std::string one = case_name(name, radius);
        if (!shared::is_chosen(one, settings.only) ||
            static_cast<int>(mesh.triangles.size()) > settings.max_triangles) {
            continue;
        }
        if (!built) {
            built = std::make_unique<const Built>(mesh, settings.rounds);
        }
        const std::string reported = settings.three_pass ? three_pass_prefix + one : one;
        measure(clock, settings, reported, *built, radius, way(radius), report);
    }
}

}  // namespace

void measure_even(const SpanClock& clock, const EvenSettings& settings, Report& report) {
    std::printf("%-22s %8s %8s %8s %9s %8s %9s %9s %9s %5s %8s %6s\n", "case", "med us", "p95 us", "p99 us",
                "max us", "free us", "err rms", "err max", "dir deg", "stuck", "build ms", "B/tri");
    const Vec3 half(0.5, 0.7, 0.6);
    measure_mesh(
        clock, settings, "box_12", shared::box(half),
        [&](double radius) { return shared::around_box(half, radius, settings.ticks); }, report);
    constexpr int cells = 512;
    constexpr double size = 5.12;
    for (const bool is_single : {false, true}) {
        const std::string prefix = is_single ? "single_" : "";
        const auto measure_as = [&](const std::string& name, const TriangleMesh& mesh, auto&& way) {
            measure_mesh(clock, settings, name, is_single ? shared::in_single_precision(mesh) : mesh, way,
                         report);
        };
        for (int level = 2; level <= 8; ++level) {
            const std::string name = prefix + "sphere_" + std::to_string(20 << (2 * level));
            if (shared::is_chosen(name, settings.only, false)) {
                measure_as(name, shared::icosphere(level, 1.0),
                           [&](double radius) { return shared::around_sphere(radius, settings.ticks); });
            }
        }
        if (const std::string name = prefix + "terrain_524288";
            shared::is_chosen(name, settings.only, false)) {
            const TriangleMesh hills = shared::terrain(cells, size, 0.2);
            measure_as(name, hills, [&](double radius) {
                return shared::over_terrain(hills, cells, size, radius, settings.ticks);
            });
        }
    }
}

}  // namespace tactus::bench
