#include "core/teleop/robot_drive.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/math/body_motion.hpp"
#include "core/math/shortened.hpp"

namespace tactus {

namespace {

// Below it friction is held to grow with speed: at rest it takes whatever it is given, which nobody can tell
// from contact (unit: meters per second).
constexpr double creeping = 0.01;

}  // namespace

Vec3 friction_of(const RobotBody& body, const Vec3& velocity) {
    return velocity * (body.viscous + body.coulomb / std::max(glm::length(velocity), creeping));
}

Vec3 drive_force(const Wall& coupling, const Vec3& wanted, const Vec3& wanted_velocity, const Vec3& position,
                 const Vec3& velocity) {
    return coupling.stiffness * (wanted - position) + coupling.damping * (wanted_velocity - velocity);
}

double follow_speed(double told, double most) {
    constexpr double catching_up = 1.05, gentle = 0.2;
    return std::min(std::max(catching_up * told, gentle), most);
}

Vec3 next_target(const Vec3& before, const Vec3& hand, double speed, const Vec3& middle, double radius,
                 double seconds) {
    const Vec3 reachable = radius > 0.0 ? middle + shortened(hand - middle, radius) : hand;
    return before + shortened(reachable - before, speed * seconds);
}

Vec3 drive_torque(const Wall& coupling, const Quat& wanted, const Vec3& wanted_spin, const Quat& rotation,
                  const Vec3& spin) {
    return coupling.stiffness * turn_vector(wanted * glm::conjugate(rotation)) +
           coupling.damping * (wanted_spin - spin);
}

Quat next_turn(const Quat& before, const Quat& hand, double spin, double seconds) {
    const Vec3 turn = turn_vector(hand * glm::conjugate(before));
    return glm::normalize(turn_by(shortened(turn, spin * seconds), 1.0) * before);
}

Vec3 ContactObserver::observe(const RobotBody& body, const Vec3& drive, const Vec3& velocity,
                              double seconds) {
    const Vec3 momentum = body.mass * velocity;
    if (!begun_) {
        begun_ = true;
        drive_ = drive;
        explained_ = momentum;
        return contact_;
    }
    drive_ += seconds / (seconds + body.smoothed) * (drive - drive_);
    // r is taken at the end of the tick, so that no tick is too long: r = L (p - e - r T), solved for r.
    explained_ += seconds * (drive_ - friction_of(body, velocity));
    contact_ = bandwidth * (momentum - explained_) / (1.0 + bandwidth * seconds);
    explained_ += seconds * contact_;
    return contact_;
}

}  // namespace tactus
