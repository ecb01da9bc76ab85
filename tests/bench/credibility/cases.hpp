// What the parts of the bench of credibility share.
#pragma once

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <utility>

#include "physics/scenes.hpp"
#include "shared/bodies.hpp"

namespace tactus::bench {

constexpr double gravity = 9.81;  // (unit: meters per square second)

// A body in a world of physics alone.
inline BodyId enter(PhysicsWorld& world, const BodyDescription& description) {
    PreparedBody body = prepare(description);
    const BodyId id = world.add(body);
    if (!id.valid()) {
        std::fprintf(stderr, "%s\n", body.error().c_str());
        std::exit(1);
    }
    return id;
}

// Steps of 1 ms until `done(seconds)` or the end (unit: seconds). Returns when that was.
template <class Done>
double run_until(PhysicsWorld& world, double end, Done&& done) {
    int i = 0;
    while (i * tick < end && !done(i * tick)) {
        world.step(tick);
        ++i;
    }
    return i * tick;
}

inline double deviation(double ours, double right) {
    return std::abs(ours / right - 1.0) * 100.0;
}

// CASE.ours, CASE.right and the deviation in percent, CASE.
inline void add_case(Results& results, const std::string& name, double ours, double right) {
    results.add(name + ".ours", ours);
    results.add(name + ".right", right);
    results.add(name, deviation(ours, right));
}

// A session with one hand and its fingertip, in virtual time.
class Stage {
public:
    // `period` is that of a tick.
    explicit Stage(double radius, const Vec3& start, const Vec3& gravity_there = {0.0, -gravity, 0.0},
                   const DeviceCapabilities& device = {}, Nanoseconds period = 1'000'000)
        : session_(settings(gravity_there, period)), period_(period) {
        hand.position = start;
        hand.can = device;
        ProxyDescription finger;
        Workspace workspace;
        workspace.force_limit = 1e6;
        finger.device = session_.add_device(hand, workspace).handle;
        finger.settings.radius = radius;
        session_.add_proxy(finger);
    }

    // `friction`: of the fingertip on it.
    SessionHandle add(const BodyDescription& description, double stiffness, double friction,
                      double damping = 0.0) {
        BodyAddition addition;
        addition.description = description;
        addition.touch_material.stiffness = stiffness;
        addition.touch_material.damping = damping;
        addition.touch_material.static_friction = addition.touch_material.dynamic_friction = friction;
        const AddResult result = session_.add_body(addition);
        if (!result.error.empty()) {
            std::fprintf(stderr, "%s\n", result.error.c_str());
            std::exit(1);
        }
        return result.handle;
    }

    // The hand goes there in the next tick. The work of the force that it holds meanwhile is counted, and
    // that of the mean of this force and the next one. In contact, motors have friction of their own.
    void go(const Vec3& to) {
        const Vec3 way = to - hand.position;
        const Vec3 before = hand.force;
        hand.velocity = way / seconds_a_tick();
        hand.position = to;
        session_.tick(now_ += period_);
        work_ += glm::dot(before, way);
        work_between_ += 0.5 * glm::dot(before + hand.force, way);
        if (hand.can.feels && before != Vec3(0.0))
            friction_ += hand.can.damping * glm::dot(way, way) / seconds_a_tick();
    }
    void wait(double seconds) {
        for (int i = 0; i < seconds / seconds_a_tick(); ++i)
            go(hand.position);
    }
    double seconds_a_tick() const { return 1e-9 * static_cast<double>(period_); }
    // On the hand since the beginning (unit: joules).
    double work() const { return work_; }
    // The same without what a force that is held for a tick adds (unit: joules).
    double work_between_ticks() const { return work_between_; }
    // Behind the friction of motors (unit: joules).
    double work_at_handle() const { return work_ - friction_; }

    BodyState state(SessionHandle handle) {
        session_.refresh();
        const SessionSnapshot& snapshot = session_.snapshot();
        const BodyState* const found = state_of(snapshot.bodies, snapshot.body_count, handle);
        return found != nullptr ? *found : BodyState{};
    }
    Session& session() { return session_; }

    Hand hand;

private:
    static SessionSettings settings(const Vec3& gravity_there, Nanoseconds period) {
        SessionSettings result;
        result.period = period;
        result.max_bodies = 64;
        result.max_parts = 64;
        result.physics.gravity = gravity_there;
        return result;
    }

    Session session_;
    Nanoseconds period_;
    Nanoseconds now_ = 0;
    double work_ = 0.0;
    double work_between_ = 0.0;
    double friction_ = 0.0;
};

void measure_friction(Results& results);
void measure_spin(Results& results);
void measure_rolling_bodies(Results& results);
void measure_hand(Results& results);
void measure_slowed(Results& results);
void measure_joints(Results& results);
void measure_stacks(Results& results);
void measure_soft(Results& results);

}  // namespace tactus::bench
