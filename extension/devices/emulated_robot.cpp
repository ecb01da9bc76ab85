#include "devices/emulated_robot.hpp"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

namespace tactus {

namespace {

// Short enough for friction at rest (unit: seconds).
constexpr double longest_step = 250e-6;

// In which the arm's levers are those of its start: it moves by a millimeter or so (unit: seconds).
constexpr double longest_move = 1e-3;

// Of the legs amid the workspace, for what their inertia is in the hand (unit: meters).
constexpr double mean_lever = 0.09;

// After a pause it goes on from where it was (unit: seconds).
constexpr double longest_tick = 0.01;

}  // namespace

EmulatedRobot::EmulatedRobot(const EmulatedRobotSettings& settings,
                             std::shared_ptr<RobotSurroundings> surroundings)
    : settings_(settings),
      surroundings_(std::move(surroundings)),
      arm_(settings.data),
      middle_(delta_centre(settings.data.geometry)),
      place_(middle_),
      pose_(delta_pose(settings.data.geometry, place_)),
      shown_(pose_.angles) {}

DeviceCapabilities EmulatedRobot::capabilities() const {
    DeviceCapabilities robot = falcon_capabilities();
    robot.mass = settings_.believed_mass *
                 (settings_.body.mass + 3.0 * settings_.leg_inertia / (mean_lever * mean_lever));
    robot.viscous = settings_.believed_friction * settings_.body.viscous;
    robot.coulomb = settings_.believed_friction * settings_.body.coulomb;
    return robot;
}

DeviceSample EmulatedRobot::read(Nanoseconds now) {
    const double seconds = started_ ? std::clamp(to_seconds(now - previous_), 0.0, longest_tick) : 0.0;
    const int moves = static_cast<int>(std::ceil(seconds / longest_move));
    for (int i = 0; i < moves; ++i) {
        move(seconds / moves);
    }
    previous_ = now;
    started_ = true;
    contact_ = surroundings_->push(now, tip(), velocity_);
    DeviceSample sample;
    sample.connected = arm_.read(encoders(), std::max(seconds, longest_step), sample);
    return sample;
}

// What of a command the motors can do is what a driver would have sent.
void EmulatedRobot::write(Nanoseconds, const Vec3& force) {
    const auto counts = arm_.counts(force);
    torques_ = Vec3(counts[0], counts[1], counts[2]) *
               (settings_.data.torque_a_count * settings_.data.geometry.gear);
}

FalconReport EmulatedRobot::encoders() {
    const FalconData& data = settings_.data;
    const Vec3& angles = pose_.angles;
    FalconReport report;
    report.homed = 7;
    for (int leg = 0; leg < 3; ++leg) {
        shown_[leg] = std::clamp(shown_[leg], angles[leg] - 0.5 * settings_.backlash,
                                 angles[leg] + 0.5 * settings_.backlash);
        const double turned = (shown_[leg] - data.zero_angles[leg]) * data.counts_a_turn * data.geometry.gear;
        report.encoders[static_cast<std::size_t>(leg)] =
            static_cast<std::int16_t>(std::lround(turned / (360.0 * delta_degrees)));
    }
    return report;
}

void EmulatedRobot::move(double seconds) {
    const Mat3 jacobian = delta_jacobian(pose_);
    const Mat3 mass =
        Mat3(settings_.body.mass) + settings_.leg_inertia * (glm::transpose(jacobian) * jacobian);
    const Mat3 mobility = glm::inverse(mass);
    const Vec3 driven = delta_force(pose_, torques_) + contact_;
    const int steps = static_cast<int>(std::ceil(seconds / longest_step));
    const double step = seconds / steps;
    Vec3 next = place_;
    for (int i = 0; i < steps; ++i) {
        velocity_ += step * (mobility * (driven - friction_of(settings_.body, velocity_)));
        next += step * velocity_;
    }
    const DeltaPose there = delta_pose(settings_.data.geometry, next);
    if (there.state == DeltaState::sound) {
        place_ = next;
        pose_ = there;
    } else {
        velocity_ = Vec3(0.0);  // against its stops
    }
}

}  // namespace tactus
