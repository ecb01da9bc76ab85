// A robot that is not there: a delta arm with a Falcon's geometry, encoders and motors, with friction and
// backlash, that is pushed by its motors and by what it runs into. Behind the same port as the driver of a
// real one.
//
// With the platform's place p, angles theta of the legs, their Jacobian J = d theta / d p and torques tau:
//     (m I + I_leg J^T J) p'' = J^T tau - f(p') + h
// The gears' play hides the last of a leg's turn from the encoders whenever it turns back.
//
// Threads: read() and write() belong to the haptic thread, and the surroundings are asked on it.
#pragma once

#include <memory>

#include "core/ports/device.hpp"
#include "core/teleop/robot_drive.hpp"
#include "devices/falcon/falcon_arm.hpp"

namespace tactus {

// What an emulated robot can run into: a world of its own.
class RobotSurroundings {
public:
    virtual ~RobotSurroundings() = default;
    // Once a tick: what pushes the tip, which is there now; held until it is asked again (unit: newtons).
    virtual Vec3 push(Nanoseconds now, const Vec3& tip, const Vec3& velocity) = 0;
};

struct EmulatedRobotSettings {
    FalconData data;
    RobotBody body{0.15, 1.0, 0.15};  // of platform and grip
    double leg_inertia =
        1.2e-4;              // of a leg with its motor behind the gear (unit: kilogram square meters), >= 0
    double backlash = 5e-4;  // of a leg's gear (unit: radians), >= 0
    // What its controller takes mass and friction for, as factors of what they are, > 0 and >= 0.
    double believed_mass = 1.0, believed_friction = 1.0;
};

class EmulatedRobot final : public Device {
public:
    EmulatedRobot(const EmulatedRobotSettings& settings, std::shared_ptr<RobotSurroundings> surroundings);

    DeviceSample read(Nanoseconds now) override;
    void write(Nanoseconds now, const Vec3& force) override;
    DeviceCapabilities capabilities() const override;

    // Where the tip really is, in the frame of DeviceSample (unit: meters).
    Vec3 tip() const { return place_ - middle_; }
    const Vec3& contact() const { return contact_; }

private:
    void move(double seconds);
    FalconReport encoders();

    EmulatedRobotSettings settings_;
    std::shared_ptr<RobotSurroundings> surroundings_;
    FalconArm arm_;
    Vec3 middle_;  // of the workspace, in the arm's own frame
    Vec3 place_, velocity_{0.0};
    DeltaPose pose_;     // of place_
    Vec3 shown_;         // angles before the gears' play (unit: radians)
    Vec3 torques_{0.0};  // of the legs (unit: newton meters)
    Vec3 contact_{0.0};  // (unit: newtons)
    Nanoseconds previous_ = 0;
    bool started_ = false;
};

}  // namespace tactus
