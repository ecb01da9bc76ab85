#include "proxy/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <utility>
#include <vector>

#include "core/haptics/force_law.hpp"
#include "core/proxy/proxy.hpp"
#include "shared/many_bodies.hpp"

namespace tactus::bench {

namespace {

using shared::ManyBodies;

struct Case {
    const char* name;
    double radius;  // of the sphere (unit: meters)
    double moves;   // how far each body goes to and fro (unit: meters)
    ManyBodies (*make)(int count);
    Vec3 (*hand)(double seconds);
};

constexpr double finger = 0.005;
constexpr double ball = 0.05;

// Comes down onto the first box and rubs it.
Vec3 over_boxes(double seconds) {
    return {0.05 * (1.0 - std::cos(2.0 * seconds)), std::max(0.073 + finger, 0.2 - seconds), 0.0};
}
Vec3 through_heap(double seconds) {
    return shared::through_heap(ball, seconds);
}
ManyBodies heap(int count) {
    return shared::heap_of_balls(count, ball);
}

constexpr Case cases[] = {{"apart", finger, 0.0, shared::boxes_apart, over_boxes},
                          {"apart_moving", finger, 1e-4, shared::boxes_apart, over_boxes},
                          {"heap", ball, 0.0, heap, through_heap},
                          {"heap_moving", ball, 1e-3 * ball, heap, through_heap}};

struct Figures {
    std::vector<double> times;  // of each tick the least of the replays (unit: microseconds)
    int contact_ticks = 0, unfinished = 0, frozen = 0;
};

Figures play(const shared::SpanClock& clock, const Case& played, int count, const BodiesSettings& settings) {
    Figures figures;
    figures.times.assign(static_cast<std::size_t>(settings.ticks), 1e300);
    for (int replay = 0; replay < settings.replays; ++replay) {
        ManyBodies bodies = played.make(count);
        Proxy proxy(bodies.places.size(), {.radius = played.radius});
        for (std::size_t i = 0; i < figures.times.size(); ++i) {
            bodies.tick(played.moves);
            const Vec3 hand = played.hand(1e-3 * static_cast<double>(i));
            const Vec3 before = proxy.position();
            const std::uint64_t start = clock.now();
            const ProxyTick tick = proxy.move(bodies.scene, hand);
            const HandForce force =
                contact_force(bodies.scene, proxy.touching(), tick.slide, Vec3(0.0), 1e-3);
            const double time = 1e-3 * clock.nanoseconds(start, clock.now());
            figures.times[i] = std::min(figures.times[i], time);
            if (replay == 0) {
                const bool is_unfinished = (tick.status & proxy_unfinished) != 0;
                figures.contact_ticks += force.contact_count > 0;
                figures.unfinished += is_unfinished;
                figures.frozen += is_unfinished && tick.position == before;
            }
        }
    }
    return figures;
}

}  // namespace

void measure_bodies(const shared::SpanClock& clock, const BodiesSettings& settings, shared::Report& report) {
    bool headed = false;
    for (const Case& played : cases) {
        for (const int count : {256, 1'024, 4'096}) {
            const std::string name = "bodies_" + std::string(played.name) + "_" + std::to_string(count);
            if (!shared::is_chosen(name, settings.only)) {
                continue;
            }
            if (!std::exchange(headed, true)) {
                std::printf("%-28s %8s %8s %8s %8s %8s %8s %8s\n", "bodies", "mean us", "p95", "p99", "max",
                            "touched", "unfin.", "frozen");
            }
            Figures f = play(clock, played, count, settings);
            const double mean =
                std::accumulate(f.times.begin(), f.times.end(), 0.0) / static_cast<double>(f.times.size());
            const double p95 = shared::quantile(f.times, 0.95);
            const double p99 = shared::quantile(f.times, 0.99);
            const double longest = *std::ranges::max_element(f.times);
            report.set(name + ".mean_us", mean);
            report.set(name + ".p95_us", p95);
            report.set(name + ".p99_us", p99);
            report.set(name + ".max_us", longest);
            report.set(name + ".contact_ticks", f.contact_ticks);
            report.set(name + ".unfinished_ticks", f.unfinished);
            report.set(name + ".frozen_ticks", f.frozen);
            std::printf("%-28s %8.2f %8.2f %8.2f %8.2f %8d %8d %8d\n", name.c_str(), mean, p95, p99, longest,
                        f.contact_ticks, f.unfinished, f.frozen);
        }
    }
}

}  // namespace tactus::bench
