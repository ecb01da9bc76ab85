#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "physics/physics_world.hpp"
#include "physics/scenes.hpp"

namespace tactus::bench {

namespace {

Vec3 force_at(std::uint64_t at, std::size_t body) {
    std::minstd_rand random(static_cast<unsigned>(at * 31u + body + 1u));
    const auto newtons = [&random] { return static_cast<double>(random() % 12001u) * 1e-3 - 6.0; };
    const double x = newtons();
    return {x, newtons(), 0.0};
}

// A world, and a twin of it that goes back to a memento and does the inputs since then again, as a link's
// does.
class Past {
public:
    using Input = void (*)(std::uint64_t at, std::span<const BodyId> bodies, PhysicsWorld& world);

    Past(int boxes, Input input) : input_(input), present_(settings()), twin_(settings()) {
        join(ground());
        for (int i = 0; i < boxes; ++i)
            ids_.push_back(join(box(Vec3(edge), place(i), 1.0)));
        for (Memento& memento : mementos_)
            memento.bytes.resize(65536);
        live(300);
    }

    void live(int ticks) {
        for (int i = 0; i < ticks; ++i) {
            if (at_ % ticks_a_memento == 0)
                save(present_, at_);
            input_(at_++, ids_, present_);
            present_.step(tick);
        }
    }

    void go_back(std::uint64_t ticks) {
        const std::uint64_t to = (at_ - ticks) / ticks_a_memento * ticks_a_memento;
        const Memento& memento = mementos_[to / ticks_a_memento % mementos_.size()];
        replayed_ = memento.at;
        twin_.restore(std::span(memento.bytes).first(memento.used));
    }

    // At most `ticks` of the past. True where the twin has caught up and the present is set to it.
    bool replay(int ticks) {
        for (; ticks > 0 && replayed_ < at_; --ticks) {
            input_(replayed_++, ids_, twin_);
            twin_.step(tick);
            if (replayed_ % ticks_a_memento == 0 && replayed_ < at_)
                save(twin_, replayed_);
        }
        if (replayed_ < at_)
            return false;
        present_.restore(std::span(hand_over_).first(twin_.save_everything(hand_over_)));
        return true;
    }

    bool same_as(const Past& other) const {
        return std::equal(ids_.begin(), ids_.end(), other.ids_.begin(), [&](BodyId a, BodyId b) {
            const Pose mine = present_.pose(a);
            const Pose theirs = other.present_.pose(b);
            return mine.position == theirs.position && mine.rotation == theirs.rotation &&
                   present_.linear_velocity(a) == other.present_.linear_velocity(b);
        });
    }

private:
    static constexpr std::uint64_t ticks_a_memento = 8;
    struct Memento {
        std::uint64_t at = 0;  // before the step of this tick
        std::vector<std::byte> bytes;
        std::size_t used = 0;
    };

    static PhysicsSettings settings() {
        PhysicsSettings result;
        // A small scene says so: Jolt empties its table of contacts in every step.
        result.max_bodies = 64;
        result.max_touching_pairs = 128;
        result.max_contacts = 128;
        return result;
    }

    BodyId join(const BodyDescription& description) {
        PreparedBody body = prepare(description);
        PreparedBody same = duplicate(body);
        twin_.add(same);
        return present_.add(body);
    }

    void save(PhysicsWorld& world, std::uint64_t at) {
        Memento& memento = mementos_[at / ticks_a_memento % mementos_.size()];
        memento.at = at;
        memento.used = world.save_everything(memento.bytes);
    }

    Input input_;
    PhysicsWorld present_, twin_;
    std::vector<BodyId> ids_;
    std::uint64_t at_ = 0, replayed_ = 0;
    std::array<Memento, 64> mementos_;
    std::vector<std::byte> hand_over_ = std::vector<std::byte>(65536);
};

void throw_about(std::uint64_t at, std::span<const BodyId> bodies, PhysicsWorld& world) {
    for (std::size_t body = 0; body < bodies.size(); ++body)
        world.apply_force(bodies[body], force_at(at, body),
                          world.center_of_mass(bodies[body]) + Vec3(0.0, 0.03, 0.02));
}

// A finger goes to and fro with the first box, at 30 mm/s at most.
void push(std::uint64_t at, std::span<const BodyId> bodies, PhysicsWorld& world) {
    constexpr double stiffness = 1000.0;
    const double phase = 2.0 * static_cast<double>(at) * tick;
    const Vec3 velocity{0.03 * std::cos(phase), 0.0, 0.0};
    const Pose pose = world.pose(bodies[0]);
    const double side = velocity.x > 0.0 ? -1.0 : 1.0;
    const Vec3 point = to_parent(pose, Vec3(side * 0.5 * edge, -0.1 * edge, 0.0));
    const Vec3 face{place(0).x + 0.015 * std::sin(phase) + side * (0.5 * edge - 0.005), point.y, point.z};
    const double depth = side * (point.x - face.x);
    if (depth > 0.0)
        world.apply_spring_force(bodies[0],
                                 {{-side * stiffness * depth, 0.0, 0.0}, point, stiffness, 0.0, velocity});
}

}  // namespace

void measure_rollback(Results& results, bool quick) {
    {
        Past past(1, push);
        std::vector<double> work;
        for (int i = 0; i < 100; ++i) {
            past.live(20);
            work.push_back(microseconds([&past] {
                past.go_back(100);
                past.replay(1000);
            }));
        }
        results.add("rollback_one_box_work_ms", percentile(work, 0.5) * 1e-3);
        results.add("rollback_one_box_work_p99_ms", percentile(work, 0.99) * 1e-3);
    }
    {
        // Spread out: a tick is the present's step and two of the past's. Three that live through the same,
        // in turns: what a tick takes is the least of the three, so that the host's pauses do not count.
        std::array<std::unique_ptr<Past>, 3> pasts;
        for (std::unique_ptr<Past>& past : pasts)
            past = std::make_unique<Past>(10, throw_about);
        std::vector<double> ticks;
        std::vector<double> lengths;
        double longest = 0.0;
        for (int round = 0; round < 30; ++round) {
            for (const std::unique_ptr<Past>& past : pasts)
                past->live(100);
            int length = 0;
            for (bool done = false; !done; ++length) {
                double least = std::numeric_limits<double>::infinity();
                for (const std::unique_ptr<Past>& past : pasts) {
                    const double time = microseconds([&] {
                        if (length == 0)
                            past->go_back(100);
                        done = past->replay(2);
                        past->live(1);
                    });
                    least = std::min(least, time);
                    longest = std::max(longest, time);
                }
                ticks.push_back(least);
            }
            lengths.push_back(length);
        }
        results.add("rollback_ten_boxes_tick_p50_us", percentile(ticks, 0.5));
        results.add("rollback_ten_boxes_tick_p99_us", percentile(ticks, 0.99));
        results.add("rollback_ten_boxes_tick_max_us", percentile(ticks, 1.0));
        results.add("rollback_ten_boxes_tick_max_with_pauses_us", longest);
        results.add("rollback_ten_boxes_ticks", percentile(lengths, 0.5));
    }
    {
        Past past(5, throw_about);
        Past plain(5, throw_about);
        std::mt19937 random(1);
        int mismatches = 0;
        const int rollbacks = quick ? 50 : 1000;
        for (int i = 0; i < rollbacks; ++i) {
            const int ahead = 1 + static_cast<int>(random() % 20);
            past.live(ahead);
            plain.live(ahead);
            past.go_back(random() % 100);
            past.replay(1000);
            mismatches += past.same_as(plain) ? 0 : 1;
        }
        results.add("rollbacks", rollbacks);
        results.add("rollback_mismatches", mismatches);
    }
}

}  // namespace tactus::bench
