#include <Jolt/Jolt.h>

#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/PhysicsSystem.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "physics/physics_world.hpp"
#include "physics/scenes.hpp"

namespace tactus::bench {

namespace {

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

// Jolt alone, metres for units, a force on the first box. Iterations and tables are those of a Session's
// world: Jolt empties its table of contacts in every step, so that a larger one costs more.
class BareJolt {
public:
    explicit BareJolt(int boxes) : scratch_(32 << 20) {
        const PhysicsSettings same;
        jobs_.Init(256);
        system_.Init(static_cast<JPH::uint>(boxes) + 9, 1, same.max_touching_pairs, same.max_contacts,
                     layers_, against_layer_, pairs_);
        JPH::PhysicsSettings settings;
        settings.mNumVelocitySteps = static_cast<JPH::uint>(same.velocity_iterations);
        settings.mNumPositionSteps = static_cast<JPH::uint>(same.position_iterations);
        settings.mUseLargeIslandSplitter = false;
        system_.SetPhysicsSettings(settings);
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

void tick_over_jolt(Results& results, const std::string& name, int boxes, int rounds, bool with_hand = true) {
    Boxes whole(boxes, 0, 0, with_hand);
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

}  // namespace

void measure_ticks(Results& results, int rounds) {
    tick_over_jolt(results, "one_box", 1, rounds);
    tick_over_jolt(results, "one_box_no_hand", 1, rounds, false);
    tick_over_jolt(results, "ten_boxes", 10, rounds);
}

void measure_crowds(Results& results, int rounds) {
    idle_crowd(results, rounds);
    idle_crowd_no_hand(results, rounds);
    idle_crowd_step(results, rounds);
}

// Over the number of awake boxes, at rest and thrown about: a tick, how many boxes are slowed, and Jolt's
// bare step of all of them (at rest).
void measure_awake(Results& results, bool quick) {
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

// Cans that roll at 50 mm/s, apart from each other: their contacts are found anew and their spin is followed
// in each step.
void measure_rolling(Results& results, bool quick) {
    constexpr double radius = 0.025;
    constexpr double speed = 0.05;
    const Quat lying(std::sqrt(0.5), std::sqrt(0.5), 0.0, 0.0);
    for (const int cans : {30, 300}) {
        Rig rig(static_cast<std::uint32_t>(cans) + 8, 500.0, false);
        rig.add(ground());
        for (int i = 0; i < cans; ++i) {
            BodyDescription can = box(Vec3(edge), {0.3 * (i % 20), radius, -0.15 * (i / 20)}, 0.1);
            can.shapes = shared::one(CylinderShape{radius, radius});
            can.pose.rotation = lying;
            can.linear_velocity = {speed, 0.0, 0.0};
            can.angular_velocity = {0.0, 0.0, -speed / radius};
            can.can_sleep = false;
            rig.add(can);
        }
        rig.settle();
        std::vector<double> times;
        for (int i = 0; i < (quick ? 400 : 2200); ++i) {
            const double time = rig.step();
            if (i >= 200)
                times.push_back(time);
        }
        results.add("rolling_" + std::to_string(cans) + "_tick_p50_us", percentile(times, 0.5));
        results.add("rolling_" + std::to_string(cans) + "_tick_p99_us", percentile(times, 0.99));
    }
}

// Boxes that are all sent in one tick, to a world that runs: the ticks until the last of them is there.
void measure_arrivals(Results& results) {
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

}  // namespace tactus::bench
