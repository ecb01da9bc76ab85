// A robot with a wrist that carries a tool in a real place: a rigid handle that its motors push and turn,
// with friction. The place is a session of its own, which knows nothing of a link, and where the tool is a
// hand's: what it touches there pushes the handle. Its owner refreshes it and collects.
//
// With mass m, inertia I, friction f and c, what the motors give F, t and what the place gives h, u:
//     m p'' = F + h - f(p'),    I w' = t + u - c w
// A stiff wrist does not turn. A loose one has no motors.
#pragma once

#include <algorithm>
#include <memory>

#include "core/math/body_motion.hpp"
#include "core/teleop/robot_drive.hpp"
#include "core/tool/tool_shape.hpp"
#include "session/session.hpp"

namespace tactus::shared {

struct PlayedRobotSettings {
    enum class Wrist : std::uint8_t { stiff, driven, loose };

    Wrist wrist = Wrist::driven;
    RobotBody body{0.2, 2.0, 0.15};
    double inertia = 1e-4;           // (unit: kilogram square meters)
    double turning_friction = 2e-3;  // (unit: newton meter seconds per radian)
    double radius = 0.15;            // of its workspace (unit: meters)
    double max_force = 8.0;          // (unit: newtons)
    double max_torque = 0.5;         // (unit: newton meters)
    double max_slew = 4000.0;        // (unit: newtons per second)
};

class PlayedRobot final : public Device {
public:
    // `tool` null: it carries none.
    PlayedRobot(const PlayedRobotSettings& settings, std::shared_ptr<const ToolShape> tool, const Pose& mount)
        : settings_(settings) {
        tip_.can.rotates = true;
        tip_.can.max_torque = DeviceCapabilities::any;
        Workspace workspace;
        workspace.force_limit = 1e6;
        const SessionHandle hand = place.add_device(tip_, workspace).handle;
        if (tool) {
            ToolUse use;
            use.device = hand;
            use.grasp = mount;
            use.settings.stiffness = 600.0;
            use.settings.turning_stiffness = 0.6;
            place.add_tool(std::move(tool), use);
        }
    }

    DeviceSample read(Nanoseconds now) override {
        constexpr int steps = 4;
        const double seconds = known_ ? std::min(to_seconds(now - before_), 0.01) : 0.0;
        before_ = now;
        known_ = true;
        for (int i = 0; i < steps; ++i) {
            move(seconds / steps);
        }
        tip_.sample = {position, rotation, velocity, 0, true};
        place.tick(now);
        DeviceSample sample = tip_.sample;
        sample.connected = powered;
        if (settings_.wrist == PlayedRobotSettings::Wrist::stiff) {
            sample.rotation = Quat(1.0, 0.0, 0.0, 0.0);
        }
        return sample;
    }
    void write(Nanoseconds, const Vec3& given) override { force = given; }
    void twist(const Vec3& given) override { torque = given; }

    DeviceCapabilities capabilities() const override {
        DeviceCapabilities can;
        can.feels = true;
        can.rotates = settings_.wrist != PlayedRobotSettings::Wrist::stiff;
        can.radius = settings_.radius;
        can.delay = 0.001;
        can.max_force = settings_.max_force;
        can.max_torque = settings_.wrist == PlayedRobotSettings::Wrist::driven ? settings_.max_torque : 0.0;
        can.max_slew = settings_.max_slew;
        can.damping = 4.5;
        can.max_damping = 20.0;
        can.mass = settings_.body.mass;
        can.viscous = settings_.body.viscous;
        can.coulomb = settings_.body.coulomb;
        return can;
    }

    const ToolState& tool() const { return place.snapshot().tools[0]; }
    const Vec3& pushed() const { return tip_.force; }    // by the place (unit: newtons)
    const Vec3& twisted() const { return tip_.torque; }  // likewise (unit: newton meters)

    Session place{small()};
    bool powered = true;
    Vec3 position{0.0}, velocity{0.0}, spin{0.0};
    Quat rotation{1.0, 0.0, 0.0, 0.0};
    Vec3 force{0.0}, torque{0.0};  // of its motors

private:
    class Tip final : public Device {
    public:
        DeviceSample read(Nanoseconds) override { return sample; }
        void write(Nanoseconds, const Vec3& given) override { force = given; }
        void twist(const Vec3& given) override { torque = given; }
        DeviceCapabilities capabilities() const override { return can; }

        DeviceCapabilities can;
        DeviceSample sample;
        Vec3 force{0.0}, torque{0.0};
    };

    static SessionSettings small() {
        SessionSettings settings;
        settings.max_bodies = 16;
        settings.max_parts = 32;
        return settings;
    }

    void move(double seconds) {
        velocity +=
            seconds / settings_.body.mass * (force + tip_.force - friction_of(settings_.body, velocity));
        position += seconds * velocity;
        if (settings_.wrist != PlayedRobotSettings::Wrist::stiff) {
            spin += seconds / settings_.inertia * (torque + tip_.torque - settings_.turning_friction * spin);
            rotation = glm::normalize(turn_by(spin, seconds) * rotation);
        }
    }

    PlayedRobotSettings settings_;
    Tip tip_;
    Nanoseconds before_ = 0;
    bool known_ = false;
};

}  // namespace tactus::shared
