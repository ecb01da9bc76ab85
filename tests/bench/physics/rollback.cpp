#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "physics/scenes.hpp"
#include "physics/timeline.hpp"

namespace tactus::bench {

namespace {

Vec3 force_at(std::uint64_t at, std::size_t body) {
    std::minstd_rand random(static_cast<unsigned>(at * 31u + body + 1u));
    const auto newtons = [&random] { return static_cast<double>(random() % 12001u) * 1e-3 - 6.0; };
    const double x = newtons();
    return {x, newtons(), 0.0};
}

struct Past {
    explicit Past(int boxes) : timeline(settings()) {
        join(ground());
        for (int i = 0; i < boxes; ++i)
            ids.push_back(join(box(Vec3(edge), place(i), 1.0)));
        live(300);
    }

    static TimelineSettings settings() {
        TimelineSettings result;
        // A small scene says so: Jolt empties its table of contacts in every step.
        result.physics.max_bodies = 64;
        result.physics.max_touching_pairs = 128;
        result.physics.max_contacts = 128;
        return result;
    }

    BodyId join(const BodyDescription& description) {
        PreparedBody body = prepare(description);
        PreparedBody same = prepare(description);
        return timeline.add(body, same);
    }

    void live(int ticks) {
        for (int i = 0; i < ticks; ++i) {
            for (std::size_t body = 0; body < ids.size(); ++body)
                timeline.apply_force(ids[body], force_at(timeline.tick(), body),
                                     timeline.world().center_of_mass(ids[body]) + Vec3(0.0, 0.03, 0.02));
            timeline.step(tick);
        }
    }

    // A finger goes to and fro with the first box, at 30 mm/s at most.
    void live_pushed(int ticks) {
        constexpr double stiffness = 1000.0;
        for (int i = 0; i < ticks; ++i) {
            const double phase = 2.0 * static_cast<double>(timeline.tick()) * tick;
            const Vec3 velocity{0.03 * std::cos(phase), 0.0, 0.0};
            const Pose pose = timeline.world().pose(ids[0]);
            const double side = velocity.x > 0.0 ? -1.0 : 1.0;
            const Vec3 point = to_parent(pose, Vec3(side * 0.5 * edge, -0.1 * edge, 0.0));
            const Vec3 face{place(0).x + 0.015 * std::sin(phase) + side * (0.5 * edge - 0.005), point.y,
                            point.z};
            const double depth = side * (point.x - face.x);
            if (depth > 0.0)
                timeline.apply_spring_force(
                    ids[0], {{-side * stiffness * depth, 0.0, 0.0}, point, stiffness, 0.0, velocity});
            timeline.step(tick);
        }
    }

    bool same_as(const Past& other) const {
        return std::equal(ids.begin(), ids.end(), other.ids.begin(), [&](BodyId a, BodyId b) {
            const Pose mine = timeline.world().pose(a);
            const Pose theirs = other.timeline.world().pose(b);
            return mine.position == theirs.position && mine.rotation == theirs.rotation &&
                   timeline.world().linear_velocity(a) == other.timeline.world().linear_velocity(b);
        });
    }

    Timeline timeline;
    std::vector<BodyId> ids;
};

}  // namespace

void measure_rollback(Results& results, bool quick) {
    {
        Past past(1);
        std::vector<double> work;
        for (int i = 0; i < 100; ++i) {
            past.live_pushed(20);
            work.push_back(microseconds([&past] {
                past.timeline.correct(past.timeline.tick() - 100, {});
                past.timeline.replay(1000);
            }));
        }
        results.add("rollback_one_box_work_ms", percentile(work, 0.5) * 1e-3);
        results.add("rollback_one_box_work_p99_ms", percentile(work, 0.99) * 1e-3);
    }
    {
        // Spread out: a tick is the present's step and two of the past's.
        Past past(10);
        std::vector<double> ticks;
        std::vector<double> lengths;
        for (int round = 0; round < 30; ++round) {
            past.live(100);
            int length = 0;
            bool done = false;
            while (!done) {
                ticks.push_back(microseconds([&] {
                    if (length == 0)
                        past.timeline.correct(past.timeline.tick() - 100, {});
                    done = past.timeline.replay(2);
                    past.live(1);
                }));
                ++length;
            }
            lengths.push_back(length);
        }
        results.add("rollback_ten_boxes_tick_p50_us", percentile(ticks, 0.5));
        results.add("rollback_ten_boxes_tick_p99_us", percentile(ticks, 0.99));
        results.add("rollback_ten_boxes_tick_max_us", percentile(ticks, 1.0));
        results.add("rollback_ten_boxes_ticks", percentile(lengths, 0.5));
    }
    {
        Past past(5);
        Past plain(5);
        std::mt19937 random(1);
        int mismatches = 0;
        const int rollbacks = quick ? 50 : 1000;
        for (int i = 0; i < rollbacks; ++i) {
            const int ahead = 1 + static_cast<int>(random() % 20);
            past.live(ahead);
            plain.live(ahead);
            past.timeline.correct(past.timeline.tick() - random() % 100, {});
            past.timeline.replay(1000);
            mismatches += past.same_as(plain) ? 0 : 1;
        }
        results.add("rollbacks", rollbacks);
        results.add("rollback_mismatches", mismatches);
    }
}

}  // namespace tactus::bench
