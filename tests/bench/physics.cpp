// Things that move: what a tick with moving bodies costs, how they feel, and how right they are.
//
//     physics [--quick] [--only=tick|crowd|changes|feel|rollback|checks|awake]
//
// Writes the file that TACTUS_BENCH_JSON names (build/bench/physics.json otherwise): one flat object. Whole
// ticks are a Session's; Jolt's bare step is Jolt's own world of the same boxes, stepped in turns with it in
// the same run.
#include <Jolt/Jolt.h>

#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/PhysicsSystem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "physics/physics_world.hpp"
#include "realtime/clock.hpp"
#include "session/session.hpp"
#include "shared/bench_kit.hpp"
#include "shared/physics_checks.hpp"

namespace {

using namespace tactus;

constexpr double tick = 1e-3;  // (unit: seconds)
constexpr Vec3 down{0.0, -9.81, 0.0};

// A report that is seen to grow.
struct Results {
    shared::Report report;

    void add(const std::string& key, double value) {
        report.set(key, value);
        std::printf("  %-40s %.6g\n", key.c_str(), value);
        std::fflush(stdout);
    }
};

double percentile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

template <class Work>
double microseconds(Work&& work) {
    const Nanoseconds start = monotonic_now();
    work();
    return static_cast<double>(monotonic_now() - start) * 1e-3;
}

std::vector<PlacedShape> one(Shape shape) {
    return {PlacedShape{std::move(shape), Pose{}}};
}

BodyDescription box(const Vec3& size, const Vec3& position, double mass) {
    BodyDescription body;
    body.shapes = one(BoxShape{0.5 * size});
    body.pose.position = position;
    body.mass = mass;
    body.material.friction = 0.5;
    return body;
}

BodyDescription ground() {
    BodyDescription body;
    body.shapes = one(PlaneShape{});
    body.motion = Motion::Static;
    body.material.friction = 0.5;
    return body;
}

// --- whole ticks
// -----------------------------------------------------------------------------------------------------

// A hand that is told where to be.
class Hand final : public Device {
public:
    DeviceSample read(Nanoseconds) override {
        return {position, Quat(1.0, 0.0, 0.0, 0.0), velocity, 0, true};
    }
    void write(Nanoseconds, const Vec3& value) override { force = value; }

    Vec3 position{0.0, 1.0, 0.0};
    Vec3 velocity{0.0};
    Vec3 force{0.0};
};

class Rig {
public:
    Rig(std::uint32_t most_bodies, double stiffness, bool with_hand = true)
        : session_(settings(most_bodies)), stiffness_(stiffness) {
        if (!with_hand)
            return;
        ProxyDescription finger;
        finger.device = session_.add_device(hand, Workspace{}).handle;
        finger.settings.radius = radius;
        session_.add_proxy(finger);
    }

    SessionHandle add(const BodyDescription& description) {
        BodyAddition addition;
        addition.description = description;
        addition.touch_material.stiffness = stiffness_;
        addition.touch_material.static_friction = addition.touch_material.dynamic_friction = 0.3;
        const AddResult result = session_.add_body(addition);
        if (!result.error.empty()) {
            std::fprintf(stderr, "%s\n", result.error.c_str());
            std::exit(1);
        }
        if (++sent_ % 1000 == 0)
            session_.settle();
        return result.handle;
    }

    void settle() { session_.settle(); }

    void kick(SessionHandle body) { session_.set_body_velocity(body, {0.0, 0.8, 0.0}, {3.0, 1.0, 2.0}); }

    double step() {  // (unit: microseconds)
        now_ += 1'000'000;
        return microseconds([this] { session_.tick(now_); });
    }

    const SessionSnapshot& look() {
        session_.refresh();
        return session_.snapshot();
    }

    Pose pose(SessionHandle handle) {
        const SessionSnapshot& snapshot = look();
        for (std::size_t i = 0; i < snapshot.body_count; ++i)
            if (snapshot.bodies[i].handle == handle)
                return snapshot.bodies[i].pose;
        return {};
    }

    static constexpr double radius = 0.005;
    Hand hand;

private:
    static SessionSettings settings(std::uint32_t most_bodies) {
        SessionSettings result;
        result.most_bodies = most_bodies;
        result.most_parts = most_bodies;
        result.physics.gravity = down;
        return result;
    }

    Session session_;
    double stiffness_;
    Nanoseconds now_ = 0;
    int sent_ = 0;
};

constexpr double edge = 0.15;  // of the box of the thesis (unit: meters)

Vec3 place(int i, double apart = 0.2) {
    return {apart * (i % 32), 0.5 * edge, -apart * (i / 32)};
}

// The finger rubs the first box to and fro, pressing from above, so that it is awake and touched in every
// tick.
void rub(Rig& rig, const Pose& first, int i) {
    const double phase = 2.0 * std::numbers::pi * i * tick;
    // It comes from above, or it would be inside the box and touch nothing.
    const double height = std::max(-0.004, 0.01 - 1e-4 * i);
    rig.hand.position = first.position + Vec3(0.02 * std::sin(phase), 0.5 * edge + Rig::radius + height, 0.0);
    rig.hand.velocity = {0.04 * std::numbers::pi * std::cos(phase), 0.0, 0.0};
}

struct Boxes {
    Boxes(int awake, int still, int sleeping, bool with_hand = true, double apart = 0.2)
        : rig(static_cast<std::uint32_t>(awake + still + sleeping + 8), 500.0, with_hand) {
        rig.add(ground());
        for (int i = 0; i < awake; ++i) {
            BodyDescription body = box(Vec3(edge), place(i, apart), 1.0);
            body.can_sleep = false;
            const SessionHandle handle = rig.add(body);
            first = i == 0 ? handle : first;
            if (i > 0)
                others.push_back(handle);
        }
        for (int i = 0; i < still; ++i) {
            BodyDescription body =
                box(Vec3(0.1), {-5.0 - 0.2 * (i % 100), 0.05 + 0.3 * (i / 5000), 0.2 * (i / 100 % 50)}, 1.0);
            body.motion = Motion::Static;
            rig.add(body);
        }
        for (int i = 0; i < sleeping; ++i)
            rig.add(box(Vec3(0.1), {10.0 + 0.2 * (i % 32), 0.05, 0.2 * (i / 32)}, 1.0));
        rig.settle();
        const int until_asleep = sleeping > 0 ? 2000 : 200;
        for (int i = 0; i < until_asleep; ++i)
            run();
        if (with_hand && rig.look().proxies[0].contact_count == 0) {
            std::fprintf(stderr, "the finger does not touch the box\n");
            std::exit(1);
        }
    }

    double run() {
        rub(rig, rig.pose(first), ticks++);
        return rig.step();
    }

    // The same, and each of the others is thrown up every quarter of a second: they fly, fall and tumble.
    double run_thrown() {
        for (std::size_t i = static_cast<std::size_t>(ticks) % 256; i < others.size(); i += 256)
            rig.kick(others[i]);
        return run();
    }

    Rig rig;
    SessionHandle first = no_handle;
    std::vector<SessionHandle> others;
    int ticks = 0;
};

// Jolt as it comes: its own settings, metres for units, a force on the first box.
class BareJolt {
public:
    explicit BareJolt(int boxes) : scratch_(32 << 20) {
        const JPH::uint most = boxes < 1000 ? 1024 : 4096;
        jobs_.Init(256);
        system_.Init(most, 1, 2 * most, most, layers_, against_layer_, pairs_);
        JPH::BodyCreationSettings floor(new JPH::BoxShape({100.0f, 1.0f, 100.0f}), {0, -1, 0},
                                        JPH::Quat::sIdentity(), JPH::EMotionType::Static, 0);
        bodies().CreateAndAddBody(floor, JPH::EActivation::DontActivate);
        for (int i = 0; i < boxes; ++i) {
            const Vec3 at = place(i);
            JPH::BodyCreationSettings body(
                new JPH::BoxShape(JPH::Vec3::sReplicate(0.5f * static_cast<float>(edge))),
                JPH::RVec3(at.x, at.y, at.z), JPH::Quat::sIdentity(), JPH::EMotionType::Dynamic, 1);
            body.mAllowSleeping = false;
            body.mFriction = 0.5f;
            const JPH::BodyID id = bodies().CreateAndAddBody(body, JPH::EActivation::Activate);
            first_ = i == 0 ? id : first_;
        }
        system_.OptimizeBroadPhase();
    }

    double run() {
        bodies().AddForce(first_, JPH::Vec3(ticks_++ % 1000 < 500 ? 0.5f : -0.5f, -2.0f, 0.0f));
        return microseconds([this] { system_.Update(static_cast<float>(tick), 1, &scratch_, &jobs_); });
    }

private:
    JPH::BodyInterface& bodies() { return system_.GetBodyInterfaceNoLock(); }

    struct Layers final : JPH::BroadPhaseLayerInterface {
        JPH::uint GetNumBroadPhaseLayers() const override { return 2; }
        JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer layer) const override {
            return JPH::BroadPhaseLayer(static_cast<JPH::BroadPhaseLayer::Type>(layer));
        }
    };
    Layers layers_;
    JPH::ObjectVsBroadPhaseLayerFilter against_layer_;
    JPH::ObjectLayerPairFilter pairs_;
    JPH::TempAllocatorImpl scratch_;
    JPH::JobSystemSingleThreaded jobs_;
    JPH::PhysicsSystem system_;
    JPH::BodyID first_;
    int ticks_ = 0;
};

void tick_over_jolt(Results& results, const std::string& name, int boxes, int rounds) {
    Boxes whole(boxes, 0, 0);
    BareJolt bare(boxes);
    for (int i = 0; i < 300; ++i)
        bare.run();
    std::vector<double> ours;
    std::vector<double> jolt;
    for (int round = 0; round < rounds; ++round)
        for (int i = 0; i < 100; ++i) {
            ours.push_back(whole.run());
            jolt.push_back(bare.run());
        }
    results.add(name + "_tick_us", percentile(ours, 0.5));
    results.add(name + "_jolt_step_us", percentile(jolt, 0.5));
    results.add(name + "_tick_over_jolt_step", percentile(ours, 0.5) / percentile(jolt, 0.5));
}

// The ticks of two scenes in turns.
template <class Scene>
void compare(Results& results, const std::string& name, Scene& one, Scene& other, int rounds) {
    std::vector<double> few;
    std::vector<double> many;
    for (int i = 0; i < 100 * rounds; ++i) {
        few.push_back(one.run());
        many.push_back(other.run());
    }
    results.add(name, percentile(many, 0.5) / percentile(few, 0.5));
    results.add(name + "_p99", percentile(many, 0.99) / percentile(few, 0.99));
}

void idle_crowd(Results& results, int rounds) {
    Boxes alone(1, 0, 0);
    Boxes crowd(1, 10'000, 1'000);
    compare(results, "idle_crowd_over_one_box", alone, crowd, rounds);
    results.add("idle_crowd_awake", static_cast<double>(crowd.rig.look().awake_bodies));
}

// The same where no hand is: what is left of the difference is the proxy's.
void idle_crowd_no_hand(Results& results, int rounds) {
    Boxes alone(1, 0, 0, false);
    Boxes crowd(1, 10'000, 1'000, false);
    compare(results, "idle_crowd_no_hand_over_one_box", alone, crowd, rounds);
}

// And of physics alone.
void idle_crowd_step(Results& results, int rounds) {
    struct Scene {
        Scene(int still, int sleeping) : world(settings()) {
            const auto enter = [this](const BodyDescription& description) {
                PreparedBody body = prepare(description);
                return world.add(body);
            };
            enter(ground());
            box_id = enter(box(Vec3(edge), place(0), 1.0));
            for (int i = 0; i < still; ++i) {
                BodyDescription body = box(
                    Vec3(0.1), {-5.0 - 0.2 * (i % 100), 0.05 + 0.3 * (i / 5000), 0.2 * (i / 100 % 50)}, 1.0);
                body.motion = Motion::Static;
                enter(body);
            }
            for (int i = 0; i < sleeping; ++i)
                enter(box(Vec3(0.1), {10.0 + 0.2 * (i % 32), 0.05, 0.2 * (i / 32)}, 1.0));
            for (int i = 0; i < 2000; ++i)
                run();
        }
        static PhysicsSettings settings() {
            PhysicsSettings result;
            result.max_bodies = 12'000;
            return result;
        }
        double run() {
            world.apply_force(box_id, {ticks++ % 1000 < 500 ? 6.0 : -6.0, 0.0, 0.0},
                              world.center_of_mass(box_id));
            return microseconds([this] { world.step(tick); });
        }
        PhysicsWorld world;
        BodyId box_id;
        int ticks = 0;
    };
    Scene alone(0, 0);
    Scene crowd(10'000, 1'000);
    compare(results, "idle_crowd_step_over_one_box", alone, crowd, rounds);
}

// Over the number of awake boxes, at rest and thrown about: a tick, how many boxes are slowed, and Jolt's
// bare step of all of them (at rest).
void awake_bodies(Results& results, bool quick) {
    for (const int awake : {1, 3, 10, 30, 100, 300, 1000, 3000}) {
        const int ticks = quick ? 200 : std::max(1000, 20'000 / awake);
        const auto measure = [&](const std::string& row, Boxes& boxes, double (Boxes::*run)()) {
            std::vector<double> times;
            for (int i = 0; i < (quick ? 100 : 1000); ++i)
                (boxes.*run)();
            for (int i = 0; i < ticks; ++i)
                times.push_back((boxes.*run)());
            results.add(row + "_tick_p50_us", percentile(times, 0.5));
            results.add(row + "_tick_p99_us", percentile(times, 0.99));
            results.add(row + "_slowed", static_cast<double>(boxes.rig.look().slowed_bodies));
        };
        const std::string number = std::to_string(awake);
        Boxes at_rest(awake, 0, 0);
        measure("awake_" + number, at_rest, &Boxes::run);
        Boxes thrown(awake, 0, 0, true, 0.5);
        measure("thrown_" + number, thrown, &Boxes::run_thrown);
        BareJolt bare(awake);
        std::vector<double> jolt;
        for (int i = 0; i < ticks; ++i)
            jolt.push_back(bare.run());
        results.add("awake_" + number + "_jolt_step_p50_us", percentile(jolt, 0.5));
    }
}

// Boxes that are all sent in one tick, to a world that runs: the ticks until the last of them is there.
void changes(Results& results) {
    constexpr int boxes = 900;
    Rig rig(boxes + 8, 500.0);
    rig.add(ground());
    rig.settle();
    for (int i = 0; i < 100; ++i)
        rig.step();
    for (int i = 0; i < boxes; ++i)
        rig.add(box(Vec3(edge), place(i), 1.0));
    std::vector<double> ticks;
    while (rig.look().body_count < boxes)
        ticks.push_back(rig.step());
    results.add("arrival_bodies", boxes);
    results.add("arrival_ticks", static_cast<double>(ticks.size()));
    results.add("arrival_tick_p50_us", percentile(ticks, 0.5));
    results.add("arrival_tick_max_us", percentile(ticks, 1.0));
}

// --- how it feels
// ----------------------------------------------------------------------------------------------------

// The finger pushes the box at 30 mm/s for ten seconds; the first half second is the start.
void push(Results& results) {
    constexpr double speed = 0.03;
    Rig rig(8, 1000.0);
    rig.add(ground());
    const SessionHandle handle = rig.add(box(Vec3(edge), {0.0, 0.5 * edge, 0.0}, 1.0));
    rig.settle();
    double x = -0.5 * edge - Rig::radius - 0.002;
    double largest_gap = 0.0;
    int lost = 0;
    std::vector<double> forces;
    for (int i = 0; i < 10'000; ++i) {
        x += speed * tick;
        rig.hand.position = {x, 0.4 * edge, 0.0};
        rig.hand.velocity = {speed, 0.0, 0.0};
        rig.step();
        const SessionSnapshot& snapshot = rig.look();
        if (i < 500)
            continue;
        const double face = rig.pose(handle).position.x - 0.5 * edge;
        largest_gap = std::max(largest_gap, std::abs(face - Rig::radius - snapshot.proxies[0].position.x));
        forces.push_back(-snapshot.proxies[0].force.x);
        lost += snapshot.proxies[0].contact_count > 0 ? 0 : 1;
    }
    double mean = 0.0;
    for (const double force : forces)
        mean += force / static_cast<double>(forces.size());
    // First-order high pass at 30 Hz.
    const double keep = 1.0 / (1.0 + 2.0 * std::numbers::pi * 30.0 * tick);
    double passed = 0.0;
    double square = 0.0;
    for (std::size_t i = 1; i < forces.size(); ++i) {
        passed = keep * (passed + forces[i] - forces[i - 1]);
        square += passed * passed / static_cast<double>(forces.size());
    }
    results.add("push_gap_max_um", largest_gap * 1e6);
    results.add("push_mean_force", mean);
    results.add("push_force_noise_percent", 100.0 * std::sqrt(square) / mean);
    results.add("push_ticks_lost", lost);
}

// Pressed with 8 N a little off its middle; the largest way of a corner to and fro in the last of three
// seconds.
void press(Results& results, const std::string& name, double size) {
    constexpr double stiffness = 1000.0;
    Rig rig(8, stiffness);
    rig.add(ground());
    const Vec3 start{0.0, 0.5 * size, 0.0};
    BodyDescription cube = box(Vec3(size), start, 1000.0 * size * size * size);
    cube.can_sleep = false;
    const SessionHandle handle = rig.add(cube);
    rig.settle();
    const Vec3 above{0.1 * size, size + Rig::radius, 0.05 * size};
    std::array<Vec3, 8> low;
    std::array<Vec3, 8> high;
    double force = 0.0;
    for (int i = 0; i < 3000; ++i) {
        const double depth = std::min(1.0, i / 300.0) * 8.0 / stiffness;
        rig.hand.position = above + Vec3(0.0, 0.001 - depth * (1.0 + 0.001 / (8.0 / stiffness)), 0.0);
        rig.step();
        if (i < 2000)
            continue;
        const Pose pose = rig.pose(handle);
        force = rig.hand.force.y;
        for (std::size_t corner = 0; corner < 8; ++corner) {
            const Vec3 side((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                            (corner & 4) != 0 ? 0.5 : -0.5);
            const Vec3 at = to_parent(pose, size * side);
            low[corner] = i == 2000 ? at : glm::min(low[corner], at);
            high[corner] = i == 2000 ? at : glm::max(high[corner], at);
        }
    }
    double most = 0.0;
    for (std::size_t corner = 0; corner < 8; ++corner)
        most = std::max(most, glm::length(high[corner] - low[corner]));
    results.add(name + "_force", force);
    results.add(name + "_rest_um", most * 1e6);
}

// --- going back
// ------------------------------------------------------------------------------------------------------

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

void rollback(Results& results, bool quick) {
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
    }
    {
        // Spread out: a tick is the present's step and two of the past's.
        Past past(10, throw_about);
        std::vector<double> ticks;
        std::vector<double> lengths;
        for (int round = 0; round < 30; ++round) {
            past.live(100);
            int length = 0;
            bool done = false;
            while (!done) {
                ticks.push_back(microseconds([&] {
                    if (length == 0)
                        past.go_back(100);
                    done = past.replay(2);
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

// --- how right it is
// -------------------------------------------------------------------------------------------------

// Over other steps: the bench `pareto`.
void checks(Results& results) {
    const shared::PhysicsCheck check = shared::check_physics(tick);
    const double push = std::max({check.momentum, check.energy, check.work});
    results.add("check_fall_error_percent", check.fall);
    results.add("check_sliding_error_percent", check.sliding);
    results.add("check_push_error_percent", push);
    results.add("check_max_error_percent", std::max({check.fall, check.sliding, push}));
    results.add("spring_energy_loss_percent", check.spring_loss);
}

}  // namespace

int main(int count, char** arguments) {
    shared::Options options(count, arguments);
    const bool quick = options.has("quick");
    const std::string only = options.text("only");
    if (!options.understood())
        return 2;
    const int rounds = quick ? 5 : 60;
    Results results;
    prepare(ground());  // starts Jolt
    const auto part = [&only](std::string_view name) { return only.empty() || only == name; };
    if (part("tick")) {
        tick_over_jolt(results, "one_box", 1, rounds);
        tick_over_jolt(results, "ten_boxes", 10, rounds);
    }
    if (part("crowd")) {
        idle_crowd(results, rounds);
        idle_crowd_no_hand(results, rounds);
        idle_crowd_step(results, rounds);
    }
    if (part("changes"))
        changes(results);
    if (part("feel")) {
        push(results);
        press(results, "press_20mm", 0.02);
        press(results, "press_5mm", 0.005);
    }
    if (part("rollback"))
        rollback(results, quick);
    if (part("checks"))
        checks(results);
    if (part("awake"))
        awake_bodies(results, quick);
    return results.report.write_json(shared::result_path("physics")) ? 0 : 1;
}
