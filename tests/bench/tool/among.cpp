#include "tool/among.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "core/tool/tool_proxy.hpp"
#include "shared/many_bodies.hpp"
#include "shared/meshes.hpp"

namespace tactus::bench {

namespace {

using shared::ManyBodies;

constexpr std::size_t ticks = 1'500;
constexpr int replays = 3;

struct Case {
    const char* name;
    double moves;  // how far each body goes to and fro (unit: meters)
    ManyBodies (*make)(int count);
    Pose (*hand)(double seconds);
};

Pose tilted(const Vec3& place, double seconds) {
    return {place,
            glm::normalize(Quat(1.0, 0.1 * std::sin(3.0 * seconds), 0.05 * std::cos(2.0 * seconds), 0.0))};
}

constexpr double ball = 0.05;  // of the heap (unit: meters)

Pose through_heap(double seconds) {
    return tilted(shared::through_heap(ball, seconds), seconds);
}

ManyBodies heap(int count) {
    return shared::heap_of_balls(count, ball);
}

// Posts of 5 mm side by side, their tops at 0.
ManyBodies posts(int count) {
    const int side = static_cast<int>(std::ceil(std::sqrt(count)));
    std::vector<Vec3> places;
    for (int i = 0; i < count; ++i) {
        places.emplace_back(0.005 * (i % side - side / 2), -0.01, 0.005 * (i / side - side / 2));
    }
    return {BoxShape{Vec3(0.0025, 0.01, 0.0025)}, places};
}

// Comes down onto them and rubs them.
Pose over_posts(double seconds) {
    return tilted(
        {0.03 * std::sin(2.0 * seconds), std::max(0.008, 0.1 - seconds), 0.02 * std::cos(3.0 * seconds)},
        seconds);
}

constexpr Case cases[] = {{"heap", 0.0, heap, through_heap},
                          {"heap_moving", 1e-5, heap, through_heap},
                          {"posts", 0.0, posts, over_posts},
                          {"posts_moving", 1e-5, posts, over_posts}};

struct Figures {
    std::vector<double> times;  // of each tick the least of the replays (unit: microseconds)
    int contact_ticks = 0, unfinished = 0, absent = 0;
};

Figures play(const Case& played, int count) {
    const shared::SpanClock clock;
    const auto shape = make_tool_shape(shared::box(Vec3(0.05, 0.01, 0.01)), {1e-3, 400}).shape;
    Figures figures;
    figures.times.assign(ticks, 1e300);
    for (int replay = 0; replay < replays; ++replay) {
        ManyBodies bodies = played.make(count);
        ToolProxy tool(shape, bodies.places.size(), {});
        for (std::size_t i = 0; i < ticks; ++i) {
            bodies.tick(played.moves);
            const std::uint64_t start = clock.now();
            const ToolTick tick = tool.move(bodies.scene, played.hand(1e-3 * static_cast<double>(i)));
            const double time = 1e-3 * clock.nanoseconds(start, clock.now());
            figures.times[i] = std::min(figures.times[i], time);
            if (replay == 0) {
                figures.contact_ticks += (tick.status & tool_touching) != 0;
                figures.unfinished += (tick.status & tool_unfinished) != 0;
                figures.absent += (tick.status & tool_absent) != 0;
            }
        }
    }
    return figures;
}

}  // namespace

void measure_among(const std::string& only, shared::Report& report) {
    for (const Case& played : cases) {
        for (const int count : {256, 1'024, 4'096}) {
            const std::string name = "among_" + std::string(played.name) + "_" + std::to_string(count);
            if (!shared::is_chosen(name, only)) {
                continue;
            }
            Figures figures = play(played, count);
            const double p50 = shared::quantile(figures.times, 0.5);
            const double p99 = shared::quantile(figures.times, 0.99);
            const double longest = *std::ranges::max_element(figures.times);
            report.set(name + ".tick_p50_us", p50);
            report.set(name + ".tick_p99_us", p99);
            report.set(name + ".tick_max_us", longest);
            report.set(name + ".contact_ticks", figures.contact_ticks);
            report.set(name + ".unfinished", figures.unfinished);
            report.set(name + ".absent", figures.absent);
            std::printf(
                "%s: p50 %.1f, p99 %.0f, longest %.0f us; of %zu ticks %d touched, %d unfinished, %d let "
                "go\n",
                name.c_str(), p50, p99, longest, ticks, figures.contact_ticks, figures.unfinished,
                figures.absent);
        }
    }
}

}  // namespace tactus::bench
