// The hand that a scene has chosen: its port, and where it is led to if it has no device of its own. Owner's
// thread only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/driver_device.hpp"
#include "devices/drivers.hpp"
#include "devices/following_device.hpp"
#include "devices/robot_tip.hpp"
#include "devices/simulated_arm.hpp"
#include "devices/steering.hpp"
#include "session/session_types.hpp"

namespace tactus {

enum class HandKind : std::uint8_t {
    path,
    mouse,
    arm,
    automatic,  // a path where there is one, else the mouse
    keyboard,
    gamepad,
    node,
    space_mouse,
    falcon = 16,  // those with a driver are in the order of DriverKind
    force_dimension,
    openhaptics,
    inverse3,
    emulated_robot,
    robot_tip,  // of an emulated robot in another world
};

constexpr bool follows_path(HandKind kind) {
    return kind == HandKind::path || kind == HandKind::arm;
}
constexpr bool is_steered(HandKind kind) {
    return kind == HandKind::keyboard || kind == HandKind::gamepad || kind == HandKind::space_mouse;
}
// What leads it has to be plugged in.
constexpr bool may_be_missing(HandKind kind) {
    return kind == HandKind::gamepad || kind == HandKind::space_mouse;
}
constexpr bool has_driver(HandKind kind) {
    return kind >= HandKind::falcon && kind <= HandKind::inverse3;
}
constexpr HandKind hand_of(DriverKind kind) {
    return static_cast<HandKind>(static_cast<int>(HandKind::falcon) + static_cast<int>(kind));
}

struct HandPlan {
    HandKind kind = HandKind::mouse;  // not automatic
    HandPath path;                    // of those that follow one; problem_with() finds nothing wrong with it
    ArmSettings arm;
    DriverSettings driver;
    double table_height = -0.01;  // of an emulated robot's (unit: meters)
    // What its controller takes its mass and friction for too much, as shares of them.
    double robot_mass_error = 0.0, robot_friction_error = 0.0;
    // Of an emulated robot, and of the hand that is its tip: the same one.
    std::shared_ptr<TipExchange> tip = std::make_shared<TipExchange>();
    Vec3 start{0.0};                  // where one that is led begins, in the scene (unit: meters)
    Quat turned{1.0, 0.0, 0.0, 0.0};  // how one that follows a node begins, in the scene
};

class SceneHand {
public:
    SceneHand() = default;  // none
    SceneHand(HandPlan plan, const Workspace& mapping);

    const std::shared_ptr<Device>& port() const { return port_; }  // null: there is none

    void change(const ArmSettings& arm);
    // Of one that follows a path: it begins anew with the next tick.
    void restart_path();
    // How long it has been on its way; 0 of any other hand.
    Nanoseconds path_time() const { return clock_ != nullptr ? clock_->elapsed() : 0; }

    // Of its driver; of any other hand there is nothing to say.
    DriverHealth health() const { return driver_ != nullptr ? driver_->health() : DriverHealth{}; }

    // From readings to forces, of a device of its own; null: it has none.
    const DurationHistogram* delays() const { return driver_ != nullptr ? &driver_->delays() : nullptr; }

    // Where a hand goes that is led; any other hears none of it. `mapping` is that of now.
    bool is_led() const { return follower_ != nullptr; }
    // To a place in the scene, with the rotation there. Far beyond it there is none, and the hand stays.
    void lead(const Pose& place, const Workspace& mapping, std::uint32_t buttons);
    // Under a pointer, deeper by this much than it was.
    void point(const ScreenRay& ray, double deeper, const Workspace& mapping, std::uint32_t buttons);
    // Along a deflection in the scene's axes. `is_there`: what leads it is plugged in; else there is no hand.
    void steer(const Vec3& deflection, const SteeringSettings& steering, double seconds,
               const Workspace& mapping, std::uint32_t buttons, bool is_there = true);

private:
    std::shared_ptr<Device> port_;
    std::shared_ptr<FollowingDevice> follower_;  // the same as port_, or null; likewise these
    std::shared_ptr<SimulatedArm> arm_;
    std::shared_ptr<DriverDevice> driver_;
    PathClock* clock_ = nullptr;  // of port_; null: it follows no path
    void aim(const Vec3& place, std::uint32_t buttons, bool is_there = true);
    void turn_to(const Quat& turned, const Workspace& mapping);

    Vec3 aimed_at_{0.0};                  // in the device's own frame (unit: meters)
    Quat turned_to_{1.0, 0.0, 0.0, 0.0};  // the rotation, in the same frame
    Vec3 pointed_at_{0.0};                // in the scene (unit: meters)
    Vec3 steered_to_{0.0};                // in the device's own frame (unit: meters)
};

// Of a hand's workspace in its own frame, as far as it is known before the device is there (unit: meters); 0:
// it has none, or only the device knows.
double usual_radius(HandKind kind, const SteeringSettings& steering);

// Why there is no such gamepad, and what to do; empty where it is among those that are there.
struct Gamepad {
    int number = 0;
    std::string name;
};
std::string problem_of_gamepad(int wanted, const std::vector<Gamepad>& there);

// What a hand does, or why it gives no force, and what of the scene is too stiff for it. `said`: what its
// driver has to say.
std::string state_of_hand(const DeviceState& state, bool has_driver, const std::string& said);

// Behind what a hand does: how often its force was cut, and why most often; empty where it never was.
std::string text_of_cuts(const ForceSlot::Cuts& cuts);

// What a fingertip or a tool does, or why it is not felt.
std::string state_of_fingertip(const ProxyState& state);
std::string state_of_tool(const ToolState& state);

}  // namespace tactus
