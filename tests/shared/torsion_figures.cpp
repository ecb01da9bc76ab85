#include "shared/torsion_figures.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "session/session.hpp"
#include "shared/slow_torsion.hpp"

namespace tactus::shared {

namespace {

constexpr double stiffness = 1000.0;  // of what is held (unit: newtons per meter)
constexpr double tip = 0.005;         // radius of the sphere that touches (unit: meters)
constexpr double gap = 0.001;         // before it touches (unit: meters)
constexpr double static_friction = 0.9;
constexpr double dynamic_friction = 0.6;
constexpr SoftFinger skin{1e5, 0.008};

class Fingertip final : public Device {
public:
    DeviceSample read(Nanoseconds) override {
        return {position, Quat(1.0, 0.0, 0.0, 0.0), velocity, 0, true};
    }
    void write(Nanoseconds, const Vec3&) override {}
    void go(const Vec3& step) {
        position += step;
        velocity = step * 1e3;
    }

    Vec3 position{0.0};
    Vec3 velocity{0.0};
};

SessionSettings settings_with(const Vec3& gravity) {
    SessionSettings settings;
    settings.max_bodies = 4;
    settings.max_parts = 4;
    settings.physics.gravity = gravity;
    return settings;
}

// A box between two fingers that press along x.
class Pinch {
public:
    Pinch(const SoftFinger& finger, const Vec3& half, const Vec3& place, double beside, const Vec3& gravity)
        : session_(settings_with(gravity)) {
        for (const double side : {-1.0, 1.0}) {
            Fingertip& tip_device = side < 0.0 ? left_ : right_;
            tip_device.position = place + Vec3(side * (half.x + tip + gap), 0.0, beside);
            Workspace workspace;
            workspace.force_limit = 1e6;
            ProxyDescription description;
            description.device = session_.add_device(tip_device, workspace).handle;
            description.settings.radius = tip;
            description.finger = finger;
            session_.add_proxy(description);
        }
        BodyAddition box = made_of(BoxShape{half}, place, Motion::Dynamic);
        box.description.mass = 0.2;
        box_ = session_.add_body(box).handle;
    }

    void add_ground() { session_.add_body(made_of(PlaneShape{}, Vec3(0.0), Motion::Static)); }
    void tick(const Vec3& inward, const Vec3& together) {
        left_.go(inward + together);
        right_.go(together - inward);
        session_.tick(now_ += 1'000'000);
    }
    void press(double force) {
        for (int i = 0; i < 400; ++i) {
            tick({(gap + force / stiffness) / 400.0, 0.0, 0.0}, Vec3(0.0));
        }
    }
    void twist(double torque) { session_.set_body_push(box_, Vec3(0.0), {torque, 0.0, 0.0}); }
    BodyState box() {
        session_.refresh();
        const SessionSnapshot& snapshot = session_.snapshot();
        const BodyState* const state = state_of(snapshot.bodies, snapshot.body_count, box_);
        return state != nullptr ? *state : BodyState{};
    }

private:
    static BodyAddition made_of(const Shape& shape, const Vec3& place, Motion motion) {
        BodyAddition addition;
        addition.description.shapes = {PlacedShape{shape, Pose{}}};
        addition.description.pose.position = place;
        addition.description.motion = motion;
        addition.touch_material = {stiffness, 1.0, static_friction, dynamic_friction};
        return addition;
    }

    Fingertip left_, right_;
    Session session_;
    SessionHandle box_ = no_handle;
    Nanoseconds now_ = 0;
};

double error_percent(double found, double right) {
    return 100.0 * std::abs(found - right) / right;
}

}  // namespace

TorsionFigures turn_held_cube(double edge, double pressing) {
    Pinch pinch(skin, Vec3(0.5 * edge), Vec3(0.0), 0.0, Vec3(0.0));
    pinch.press(pressing);
    const double at_rest = 2.0 * slow_torsion(skin, static_friction, pressing);
    const double slipping = 2.0 * slow_torsion(skin, dynamic_friction, pressing);
    const auto still = [&] { pinch.tick(Vec3(0.0), Vec3(0.0)); };
    TorsionFigures figures;
    double torque = 0.0;
    for (int i = 0; i < 500; ++i) {
        pinch.twist(at_rest * 0.9 * i / 500.0);
        still();
    }
    // Then in steps of a 5,000th.
    for (int i = 0; i < 1'000 && std::abs(pinch.box().angular_velocity.x) < 0.1; ++i) {
        torque = at_rest * (0.9 + 2e-4 * i);
        pinch.twist(torque);
        for (int wait = 0; wait < 4; ++wait) {
            still();
        }
    }
    figures.break_away_error = error_percent(torque, at_rest);
    // It turns: what is left of the torque speeds it up.
    const double before = pinch.box().angular_velocity.x;
    constexpr int ticks = 20;
    for (int i = 0; i < ticks; ++i) {
        still();
    }
    const double inertia = 0.2 * edge * edge / 6.0;
    const double gained = (pinch.box().angular_velocity.x - before) * 1e3 / ticks;
    figures.slipping_error = error_percent(torque - inertia * gained, slipping);
    return figures;
}

LiftFigures lift_beside_middle(const SoftFinger& finger) {
    const Vec3 half{0.02, 0.02, 0.04};
    Pinch pinch(finger, half, {0.0, half.y, 0.0}, 0.02, {0.0, -9.81, 0.0});
    pinch.add_ground();
    pinch.press(8.0);
    const Pose start = pinch.box().pose;
    LiftFigures figures;
    for (int i = 0; i < 5'000; ++i) {
        pinch.tick(Vec3(0.0), {0.0, i < 1'000 ? 5e-5 : 0.0, 0.0});
        const Quat turned = pinch.box().pose.rotation * glm::conjugate(start.rotation);
        const double angle = 2.0 * std::asin(std::min(1.0, glm::length(Vec3(turned.x, turned.y, turned.z))));
        figures.turned = std::max(figures.turned, angle * 180.0 / std::numbers::pi);
    }
    figures.risen = pinch.box().pose.position.y - start.position.y;
    return figures;
}

}  // namespace tactus::shared
