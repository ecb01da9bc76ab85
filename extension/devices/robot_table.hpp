// The least that a robot can run into: a table.
#pragma once

#include <algorithm>

#include "devices/emulated_robot.hpp"

namespace tactus {

// Flat, at this height of the device's own frame; it gives way like a spring, and holds by friction.
class RobotTable final : public RobotSurroundings {
public:
    struct Settings {
        double height = -0.01;      // (unit: meters)
        double stiffness = 1200.0;  // (unit: newtons per meter), > 0
        double damping = 3.0;       // (unit: newton seconds per meter), >= 0
        double friction = 0.3;      // coefficient, >= 0
    };

    explicit RobotTable(const Settings& settings) : settings_(settings) {}

    Vec3 push(Nanoseconds, const Vec3& tip, const Vec3& velocity) override {
        const double depth = settings_.height - tip.y;
        if (depth <= 0.0) {
            return Vec3(0.0);
        }
        const double up = std::max(0.0, settings_.stiffness * depth - settings_.damping * velocity.y);
        const Vec3 sliding(velocity.x, 0.0, velocity.z);
        return Vec3(0.0, up, 0.0) - friction_of({0.0, 0.0, settings_.friction * up}, sliding);
    }

private:
    Settings settings_;
};

}  // namespace tactus
