// Sessions that tests share: a hand that is put somewhere, ordinary bodies, time that is counted.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>

#include "session/session.hpp"

namespace tactus::session_test {

constexpr Nanoseconds period = 1'000'000;

// A device whose handle is where the test says, and which keeps the force it was given.
class HeldDevice final : public Device {
public:
    DeviceSample read(Nanoseconds) override { return {position, rotation, velocity, buttons, connected}; }
    void write(Nanoseconds, const Vec3& given) override { force = given; }
    void twist(const Vec3& given) override { torque = given; }
    DeviceCapabilities capabilities() const override { return can; }
    std::optional<DisplayedForce> displayed() const override { return shown; }

    std::optional<DisplayedForce> shown;  // as a driver's last stage would know
    DeviceCapabilities can;
    Vec3 position{0.0};
    Quat rotation{1.0, 0.0, 0.0, 0.0};
    Vec3 velocity{0.0};
    Vec3 force{0.0};
    Vec3 torque{0.0};
    std::uint32_t buttons = 0;
    bool connected = true;
};

// It turns, and gives torque.
inline void let_turn(HeldDevice& device) {
    device.can.rotates = true;
    device.can.max_torque = 10.0;
}

inline BodyAddition body(const Shape& shape, const Vec3& position, Motion motion, double mass = 1.0) {
    BodyAddition addition;
    addition.description.shapes = {PlacedShape{shape, Pose{}}};
    addition.description.pose.position = position;
    addition.description.motion = motion;
    addition.description.mass = mass;
    addition.touch_material = {500.0, 0.0, 0.0, 0.0};
    return addition;
}

inline BodyAddition ground() {
    return body(PlaneShape{}, Vec3(0.0), Motion::Static);
}

class SessionRig {
public:
    explicit SessionRig(const SessionSettings& settings = {}, InputRecorder* recorder = nullptr,
                        std::unique_ptr<TeleopSide> side = nullptr)
        : session(settings, recorder) {
        if (side) {
            session.attach(std::move(side));
        }
        Workspace workspace;
        workspace.force_limit = 1e6;
        hand = session.add_device(device, workspace).handle;
        ProxyDescription description;
        description.device = hand;
        description.settings.radius = 0.01;
        proxy = session.add_proxy(description).handle;
    }

    SessionHandle add(const BodyAddition& addition) {
        const AddResult result = session.add_body(addition);
        EXPECT_EQ(result.error, "");
        return result.handle;
    }

    TickStatus tick() { return session.tick(now += period); }
    void ticks(int count) {
        for (int i = 0; i < count; ++i) {
            tick();
        }
    }
    // The hand goes there at a steady pace.
    void draw(const Vec3& to, int count) {
        const Vec3 from = device.position;
        for (int i = 1; i <= count; ++i) {
            device.position = from + (to - from) * (static_cast<double>(i) / count);
            device.velocity = (to - from) * (1e3 / count);
            tick();
        }
        device.velocity = Vec3(0.0);
    }

    const SessionSnapshot& newest() {
        session.refresh();
        return session.snapshot();
    }
    const ProxyState& proxy_state() { return newest().proxies[0]; }
    const BodyState* state_of(SessionHandle handle) {
        const SessionSnapshot& snapshot = newest();
        return tactus::state_of(snapshot.bodies, snapshot.body_count, handle);
    }

    HeldDevice device;
    Session session;
    SessionHandle hand = no_handle;
    SessionHandle proxy = no_handle;
    Nanoseconds now = 0;
};

}  // namespace tactus::session_test
