// The far side of scenario 3 in experiments: a session whose device is an emulated robot, in a world that is
// a session of its own and knows nothing of the link.
#pragma once

#include <memory>

#include "devices/emulated_robot.hpp"
#include "session/robot_side.hpp"
#include "shared/teleop_place.hpp"

namespace tactus::shared {

// The robot's tip, as the hand of the world that it is in.
class RobotTip final : public Device {
public:
    DeviceSample read(Nanoseconds) override { return sample; }
    void write(Nanoseconds, const Vec3&) override {}

    DeviceSample sample;
};

// That world: ticks when the robot asks for what pushes it.
class SurroundingPlace final : public RobotSurroundings {
public:
    SurroundingPlace(TeleopPlace& place, RobotTip& tip) : place_(place), tip_(tip) {}

    Vec3 push(Nanoseconds now, const Vec3& at, const Vec3& velocity) override {
        tip_.sample.position = at;
        tip_.sample.velocity = velocity;
        tip_.sample.connected = true;
        place_.session.tick(now);
        return place_.device.force;
    }

private:
    TeleopPlace& place_;
    RobotTip& tip_;
};

class TeleopRobot {
public:
    TeleopRobot(TeleopPlace& world, RobotTip& tip, const EmulatedRobotSettings& robot,
                const TeleopSettings& settings, Link& link, std::shared_ptr<TeleopPort> port,
                const EndpointSettings& endpoint)
        : world_(world),
          session_(teleop_session_settings()),
          robot_(robot, std::make_shared<SurroundingPlace>(world, tip)) {
        ProxyDescription pointer;
        pointer.device = session_.add_device(robot_, Workspace{}).handle;
        session_.add_proxy(pointer);
        session_.attach(
            std::make_unique<RobotSide>(session_.settings(), settings, link, std::move(port), endpoint));
    }

    void tick(Nanoseconds now) {
        session_.tick(now);
        world_.session.refresh();
    }

private:
    TeleopPlace& world_;
    Session session_;
    EmulatedRobot robot_;
};

}  // namespace tactus::shared
