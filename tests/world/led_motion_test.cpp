// Bodies that an engine of 30 to 120 frames a second moves, pushed by a hand of 1 kHz.
#include "world/led_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "physics/physics_world.hpp"
#include "session/session.hpp"

namespace tactus::led_motion_test {
namespace {

constexpr double edge = 0.1;  // of the box (unit: meters)

// A device whose handle is where the test has it.
class HeldDevice final : public Device {
public:
    DeviceSample read(Nanoseconds) override { return {position, {1.0, 0.0, 0.0, 0.0}, velocity, 0, true}; }
    void write(Nanoseconds, const Vec3&) override {}

    Vec3 position{0.0};
    Vec3 velocity{0.0};
};

struct Scene {
    double frames_a_second = 60.0;
    double mass = 0.5;         // (unit: kilograms)
    double heavier = 1.0;      // the engine's body than the model was told
    double friction = 0.5;     // of ground and box
    double damping = 0.0;      // of its surface (unit: newton seconds per meter)
    double gravity = 9.81;     // (unit: meters per square second); 0: no ground
    double stiffness = 500.0;  // of its surface (unit: newtons per meter)
    Vec3 wind{0.0};            // that only the engine knows (unit: newtons)
    double off_middle = 0.0;   // of the hand, across (unit: meters)
    bool in_bursts = false;    // two frames at once, then none
    bool is_led = true;        // false: the session's own physics moves it
};

BodyAddition box(const Scene& scene) {
    BodyAddition box;
    box.description.shapes = {PlacedShape{BoxShape{Vec3(0.5 * edge)}, Pose{}}};
    box.description.pose.position = {0.0, 0.5 * edge, 0.0};
    box.description.motion = Motion::Dynamic;
    box.description.mass = scene.mass;
    box.description.material.friction = scene.friction;
    box.description.linear_damping = box.description.angular_damping = 0.0;
    box.touch_material = {scene.stiffness, scene.damping, 0.5, 0.5};
    return box;
}

BodyAddition floor_of(const Scene& scene) {
    BodyAddition floor;
    floor.description.shapes = {PlacedShape{PlaneShape{}, Pose{}}};
    floor.description.motion = Motion::Static;
    floor.description.material.friction = scene.friction;
    return floor;
}

SessionSettings settings_of(const Scene& scene) {
    SessionSettings settings;
    settings.physics.gravity = {0.0, -scene.gravity, 0.0};
    return settings;
}

// The engine: physics in steps of a frame.
class Engine {
public:
    explicit Engine(const Scene& scene) : scene_(scene), world_(settings_of(scene).physics) {
        if (scene.gravity > 0.0) {
            PreparedBody floor = prepare(floor_of(scene).description);
            world_.add(floor);
        }
        BodyAddition addition = box(scene);
        addition.description.mass *= scene.heavier;
        PreparedBody added = prepare(addition.description);
        box_ = world_.add(added);
    }
    BodyMotion motion() const { return world_.state(box_); }
    void put(const Pose& pose) { world_.set_pose(box_, pose); }
    void push(const Vec3& impulse, const Vec3& turn) {
        given += impulse;
        world_.apply_force(box_, impulse * scene_.frames_a_second, world_.center_of_mass(box_));
        world_.apply_torque(box_, turn * scene_.frames_a_second);
    }
    void step() {
        world_.apply_force(box_, scene_.wind, world_.center_of_mass(box_));
        world_.step(1.0 / scene_.frames_a_second);
    }

    Vec3 given{0.0};

private:
    Scene scene_;
    PhysicsWorld world_;
    BodyId box_;
};

class Rig {
public:
    explicit Rig(const Scene& scene) : engine(scene), session(settings_of(scene)), scene_(scene) {
        Workspace workspace;
        workspace.force_limit = 1e6;
        ProxyDescription description;
        description.device = session.add_device(device, workspace).handle;
        description.settings.radius = 0.01;
        session.add_proxy(description);
        if (scene.gravity > 0.0) {
            session.add_body(floor_of(scene));
        }
        handle = session.add_body(box(scene)).handle;
        if (scene.is_led) {
            session.lead_body(handle, true);
        }
        device.position = {-0.1, 0.5 * edge, scene.off_middle};
        tick();
    }
    void tick() {
        session.tick(now_ += 1'000'000);
        session.refresh();
    }
    void frame() {
        const LedState* const model = state_of(session.snapshot().led, session.snapshot().led_count, handle);
        ASSERT_NE(model, nullptr);
        const double seconds = 1.0 / scene_.frames_a_second;
        const LedMotion::Frame frame = led_.frame(engine.motion(), *model, seconds, 1e-3);
        if (frame.corrects) {
            session.correct_body(handle, frame.correction);
        }
        engine.push(frame.impulse, frame.turn);
        engine.step();
    }
    void tick_with_frames() {
        const double period_of_frames = (scene_.in_bursts ? 2.0 : 1.0) / scene_.frames_a_second;
        if (scene_.is_led && ++ticks_ >= next_ * 1e3) {
            next_ += period_of_frames;
            frame();
            if (scene_.in_bursts) {
                frame();
            }
        }
        tick();
        const Vec3 force = session.snapshot().proxies[0].force;
        forces.push_back(force);
        impulse -= force * 1e-3;
    }
    // At a steady speed, and stays there.
    void push(double meters, double seconds, double stays) {
        const Vec3 from = device.position;
        const int count = static_cast<int>(1e3 * seconds);
        for (int i = 1; i <= count + static_cast<int>(1e3 * stays); ++i) {
            const double share = std::min(1.0, static_cast<double>(i) / count);
            device.position = from + Vec3(meters * share, 0.0, 0.0);
            device.velocity = i <= count ? Vec3(meters / seconds, 0.0, 0.0) : Vec3(0.0);
            tick_with_frames();
        }
    }
    // The hand goes on, and the engine makes no frame.
    void hang(double meters, double seconds) {
        for (int i = 0; i < static_cast<int>(1e3 * seconds); ++i) {
            device.position.x += 1e-3 * meters / seconds;
            tick();
        }
    }
    Vec3 place() { return scene_.is_led ? engine.motion().pose.position : of_session().pose.position; }
    BodyState of_session() const {
        const SessionSnapshot& snapshot = session.snapshot();
        return *state_of(snapshot.bodies, snapshot.body_count, handle);
    }
    double largest_step() const {
        double most = 0.0;
        for (std::size_t i = 1; i < forces.size(); ++i) {
            most = std::max(most, glm::distance(forces[i], forces[i - 1]));
        }
        return most;
    }

    Engine engine;
    HeldDevice device;
    Session session;
    SessionHandle handle = no_handle;
    std::vector<Vec3> forces;
    Vec3 impulse{0.0};  // given to the box by the hand (unit: newton seconds)

private:
    Scene scene_;
    LedMotion led_;
    Nanoseconds now_ = 0;
    int ticks_ = 0;
    double next_ = 0.0;
};

double mean_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += glm::distance(a[i], b[i]);
    }
    return sum / static_cast<double>(a.size());
}

TEST(LedMotion, WhatTheHandGivesIsTheMomentumOfTheEnginesBody) {
    for (const double frames : {30.0, 60.0, 120.0}) {
        Rig rig({.frames_a_second = frames, .gravity = 0.0, .off_middle = 0.02});
        rig.push(0.08, 0.4, 0.4);
        const Vec3 momentum = 0.5 * rig.engine.motion().linear_velocity;
        ASSERT_GT(glm::length(rig.impulse), 0.01);
        EXPECT_LT(glm::distance(momentum, rig.impulse), 0.01 * glm::length(rig.impulse)) << frames;
        EXPECT_NEAR(glm::distance(rig.engine.given, momentum), 0.0, 1e-6) << frames;
    }
}

// Where a frame is longer, what it hears of friction comes later.
TEST(LedMotion, ABoxOnTheFloorFeelsAsThatOfTheHapticWorld) {
    Rig local({.damping = 10.0, .is_led = false});
    local.push(0.2, 2.0, 0.5);
    struct Limits {
        double frames, force, place;  // (units: hertz, newtons, meters)
    };
    for (const auto& [frames, force, place] :
         {Limits{30.0, 0.06, 5e-4}, Limits{60.0, 0.04, 1e-4}, Limits{120.0, 0.05, 5e-5}}) {
        Rig rig({.frames_a_second = frames, .damping = 10.0});
        rig.push(0.2, 2.0, 0.5);
        EXPECT_LT(mean_difference(rig.forces, local.forces), force) << frames;
        EXPECT_LT(glm::distance(rig.place(), local.place()), place) << frames;
        EXPECT_LT(rig.largest_step(), local.largest_step() + 0.1) << frames;
    }
}

// An engine goes with the new velocity for the whole frame: nothing that the model has to be corrected by.
TEST(LedMotion, AForceThatChangesWithinAFrameIsNoErrorOfTheModel) {
    for (const double stiffness : {500.0, 2000.0}) {
        for (const double frames : {30.0, 60.0, 120.0}) {
            const Scene scene{.frames_a_second = frames, .mass = 2.0, .gravity = 0.0, .stiffness = stiffness};
            Scene own = scene;
            own.is_led = false;
            Rig rig(scene), local(own);
            rig.push(0.08, 0.4, 0.4);
            local.push(0.08, 0.4, 0.4);
            const Vec3 most =
                *std::ranges::max_element(local.forces, {}, [](const Vec3& f) { return glm::length(f); });
            ASSERT_GT(glm::length(most), 1.0);
            EXPECT_LT(mean_difference(rig.forces, local.forces), 0.02) << stiffness << " " << frames;
        }
    }
}

// A body between springs, as between two stiff fingers: a model of 1 kHz and an engine that has its impulses.
// `ticks`: of the model after each frame, over and over. `pulse`: radians per second. `heavier`: the engine's
// body than the model was told.
// Returns how far the model swings in its last second, of where it began.
double swing(double frames_a_second, double pulse, const std::vector<int>& ticks, double heavier = 1.0) {
    constexpr double tick = 1e-3, start = 1e-3;
    const double frame_seconds = 1.0 / frames_a_second;
    LedMotion led;
    LedState model;
    model.mass = model.corrected.mass = 1.0;
    BodyMotion engine;
    model.motion.pose.position.x = engine.pose.position.x = start;
    Vec3 left(0.0), given(0.0);
    double farthest = 0.0;
    for (std::size_t i = 0; model.seconds < 4.0; ++i) {
        engine.linear_velocity += std::exchange(given, Vec3(0.0)) / heavier;
        engine.pose.position += engine.linear_velocity * (i == 0 ? 0.0 : frame_seconds);
        const LedMotion::Frame frame = led.frame(engine, model, frame_seconds, tick);
        given = frame.impulse;
        left += frame.correction.by;
        model.motion.linear_velocity += frame.correction.linear;
        model.corrected.linear += frame.correction.linear;
        model.mass = model.corrected.mass = frame.correction.mass;
        for (int k = 0; k < ticks[i % ticks.size()]; ++k) {
            const Vec3 by = left * (tick / frame_seconds);
            left -= by;
            model.corrected.by += by;
            const Vec3 force = -pulse * pulse * (model.motion.pose.position + by);
            model.impulse += force * tick;
            model.motion.linear_velocity += (force / model.mass + frame.correction.acceleration) * tick;
            model.way += model.motion.linear_velocity * tick;
            model.seconds += tick;
            model.motion.pose.position += by + model.motion.linear_velocity * tick;
            farthest = model.seconds > 3.0 ? std::max(farthest, std::abs(model.motion.pose.position.x)) : 0.0;
        }
    }
    return farthest / start;
}

TEST(LedMotion, ABodyThatSwingsWithinAFewFramesSwingsNoFarther) {
    for (const double pulse : {50.0, 100.0}) {
        EXPECT_LT(swing(30.0, pulse, {33, 33, 34}), 1.2) << pulse;
        EXPECT_LT(swing(60.0, pulse, {17, 17, 16}), 1.2) << pulse;
        EXPECT_LT(swing(120.0, pulse, {8, 8, 9}), 1.2) << pulse;
    }
}

TEST(LedMotion, ABodySwingsNoFartherWhereFramesComeUnevenly) {
    EXPECT_LT(swing(60.0, 50.0, {33, 0, 34, 0, 33, 0}), 1.5) << "a screen of 30 Hz";
    EXPECT_LT(swing(60.0, 50.0, {22, 22, 0, 22}), 1.5) << "a screen of 45 Hz";
    EXPECT_LT(swing(60.0, 50.0, {14, 21, 14, 21, 14, 14}), 1.5) << "a screen of 144 Hz";
    EXPECT_LT(swing(120.0, 100.0, {17, 0, 16, 0, 17, 0}), 1.5) << "a screen of 60 Hz";
    EXPECT_LT(swing(60.0, 50.0, {50, 0, 0}), 1.5) << "a screen of 20 Hz";
}

// While the mass is found out it swings somewhat farther.
TEST(LedMotion, ABodyThatIsHeavierThanItIsToldSwingsNoFarther) {
    for (const double heavier : {1.5, 3.0}) {
        EXPECT_LT(swing(60.0, 50.0, {17, 17, 16}, heavier), 5.0) << heavier;
        EXPECT_LT(swing(60.0, 100.0, {17, 17, 16}, heavier), 5.0) << heavier;
        EXPECT_LT(swing(120.0, 100.0, {8, 8, 9}, heavier), 5.0) << heavier;
    }
}

// Another body hangs on it that only the engine knows; seven frames touch the finger.
TEST(LedMotion, ABodyThatIsHeavierThanItIsToldLeavesAFingerAsFast) {
    for (const double heavier : {1.5, 2.5}) {
        Rig local({.mass = 0.3 * heavier, .damping = 5.0, .gravity = 0.0, .is_led = false});
        local.session.set_body_velocity(local.handle, {-0.6, 0.0, 0.0}, Vec3(0.0));
        local.push(0.0, 0.001, 0.4);
        const double speed = local.of_session().linear_velocity.x;
        ASSERT_GT(speed, 0.2);
        Rig rig({.mass = 0.3, .heavier = heavier, .damping = 5.0, .gravity = 0.0});
        rig.engine.push({-0.6 * 0.3 * heavier, 0.0, 0.0}, Vec3(0.0));
        rig.push(0.0, 0.001, 0.4);
        EXPECT_NEAR(rig.engine.motion().linear_velocity.x, speed, 0.2 * speed) << heavier;
    }
}

TEST(LedMotion, FramesInBurstsKickNoHand) {
    Rig rig({.in_bursts = true});
    rig.push(0.2, 2.0, 0.5);
    EXPECT_LT(rig.largest_step(), 0.5);
    EXPECT_GT(rig.place().x, 0.09);
}

// The game loads a level while the hand pushes the box, which friction holds with 2.45 N: 4.9 Ns in all.
TEST(LedMotion, ABodyIsNotThrownByWhatItWasPressedInTimeThatTheEngineLost) {
    Rig rig({});
    rig.push(0.05, 0.3, 0.3);
    rig.hang(0.05, 2.0);
    ASSERT_GT(glm::length(rig.session.snapshot().proxies[0].force), 1.0);
    rig.push(0.0, 0.001, 1.0);
    EXPECT_LT(rig.place().x, rig.device.position.x + 0.15);
}

// A spring of the engine alone, or a wind, that the model finds out.
TEST(LedMotion, AForceThatOnlyTheEngineKnowsIsFelt) {
    Rig rig({.damping = 5.0, .gravity = 0.0, .wind = {-1.0, 0.0, 0.0}});
    rig.push(0.045, 0.1, 4.0);
    Vec3 last(0.0);
    for (std::size_t i = rig.forces.size() - 500; i < rig.forces.size(); ++i) {
        last += rig.forces[i] / 500.0;
    }
    EXPECT_NEAR(last.x, -1.0, 0.1);
}

TEST(LedMotion, ABodyThatIsPutElsewhereIsThereAtOnce) {
    Rig rig({});
    rig.push(0.05, 0.2, 0.2);
    rig.engine.put({{0.0, 0.5 * edge, 0.5}, {1.0, 0.0, 0.0, 0.0}});
    rig.push(0.0, 0.001, 0.06);
    EXPECT_NEAR(rig.of_session().pose.position.z, 0.5, 0.005);
    EXPECT_LT(rig.largest_step(), 0.5);
}

// The engine's body is struck for one frame. In the model a joint holds it, and undoes each correction.
// `turn`: what a hand changes the model's spin by in each frame, and the joint takes back.
double asked_of_what_a_joint_undoes(const Vec3& struck, const Vec3& turn) {
    constexpr double frame = 1.0 / 60.0, tick = 1e-3;
    LedMotion led;
    LedState model;
    double asked = 0.0;
    for (int i = 0; i < 30; ++i) {
        BodyMotion engines;
        if (i == 5) {
            engines.linear_velocity = engines.angular_velocity = struck;
        }
        const BodyCorrection correction = led.frame(engines, model, frame, tick).correction;
        if (i > 5) {
            asked = std::max({asked, glm::length(correction.linear), glm::length(correction.angular)});
        }
        model.seconds += frame;
        model.turn += 1e-3 * turn;
        model.spun += turn;
        model.corrected.linear += correction.linear;
        model.corrected.angular += correction.angular;
    }
    return asked;
}

TEST(LedMotion, AFrameInWhichTheEngineFailsIsLeftOut) {
    constexpr double frame = 1.0 / 60.0, tick = 1e-3, none = std::numeric_limits<double>::quiet_NaN();
    LedMotion led;
    LedState model;
    for (int i = 0; i < 10; ++i) {
        BodyMotion engines;
        engines.pose.position.x = i < 6 ? 0.0 : 0.01;
        engines.linear_velocity.y = i == 3 ? none : 0.0;
        const BodyCorrection correction = led.frame(engines, model, frame, tick).correction;
        model.seconds += frame;
        model.motion.pose.position += correction.by;
        model.corrected.by += correction.by;
    }
    EXPECT_NEAR(model.motion.pose.position.x, 0.01, 1e-6);
}

TEST(LedMotion, WhatAJointUndoesIsNotTakenBack) {
    const Vec3 struck(1.0, 0.5, -0.2);
    EXPECT_LT(asked_of_what_a_joint_undoes(struck, Vec3(0.0)), 0.01 * glm::length(struck));
    EXPECT_LT(asked_of_what_a_joint_undoes(struck, {0.2, 0.0, 0.0}), 0.01 * glm::length(struck));
}

}  // namespace
}  // namespace tactus::led_motion_test
