// What the parts of the bench of physics share: bodies, a session with a finger in it, figures.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "platform/clock.hpp"
#include "session/session.hpp"
#include "shared/bench_kit.hpp"
#include "shared/bodies.hpp"

namespace tactus::bench {

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

inline double percentile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

template <class Work>
double microseconds(Work&& work) {
    const Nanoseconds start = monotonic_now();
    work();
    return static_cast<double>(monotonic_now() - start) * 1e-3;
}

inline BodyDescription box(const Vec3& size, const Vec3& position, double mass) {
    return shared::box(size, position, mass, 0.5);
}
inline BodyDescription ground() {
    return shared::ground(0.5);
}

// A hand that is told where to be.
class Hand final : public Device {
public:
    DeviceSample read(Nanoseconds) override {
        return {position, Quat(1.0, 0.0, 0.0, 0.0), velocity, 0, true};
    }
    void write(Nanoseconds, const Vec3& value) override { force = value; }
    DeviceCapabilities capabilities() const override { return can; }

    Vec3 position{0.0, 1.0, 0.0};
    Vec3 velocity{0.0};
    Vec3 force{0.0};
    DeviceCapabilities can;
};

class Rig {
public:
    Rig(std::uint32_t max_bodies, double stiffness, bool with_hand = true)
        : session_(settings(max_bodies)), stiffness_(stiffness) {
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
        const BodyState* const state = state_of(snapshot.bodies, snapshot.body_count, handle);
        return state ? state->pose : Pose{};
    }

    static constexpr double radius = 0.005;
    Hand hand;

private:
    static SessionSettings settings(std::uint32_t max_bodies) {
        SessionSettings result;
        result.max_bodies = max_bodies;
        result.max_parts = max_bodies;
        result.physics.gravity = down;
        return result;
    }

    Session session_;
    double stiffness_;
    Nanoseconds now_ = 0;
    int sent_ = 0;
};

constexpr double edge = 0.15;  // of the box of the thesis (unit: meters)

inline Vec3 place(int i, double apart = 0.2) {
    return {apart * (i % 32), 0.5 * edge, -apart * (i / 32)};
}

// Whole ticks over Jolt's bare step; idle bodies; awake ones; arrivals.
void measure_ticks(Results& results, int rounds);
void measure_crowds(Results& results, int rounds);
void measure_awake(Results& results, bool quick);
void measure_rolling(Results& results, bool quick);
void measure_arrivals(Results& results);
// Pushing and pressing.
void measure_feel(Results& results);
void measure_rollback(Results& results, bool quick);

}  // namespace tactus::bench
