// Keeps the wrench that comes back over a link from making energy in a hand that holds a tool: over all
// directions together the hand is given no more than it has put in before.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/math/wrench.hpp"

namespace tactus {

class WrenchPassivity {
public:
    // Since the last tick the hand has gone this way (unit: meters) and turned so (unit: radians) with what
    // it was given then.
    void moved(const Wrench& given, const Vec3& way, const Vec3& turn) {
        constexpr double most = 0.05;  // that counts as put in before (unit: joules)
        taken_ = std::min(taken_ - glm::dot(given.force, way) - glm::dot(given.torque, turn), most);
    }

    // The wrench for this tick. What would be too much as the hand goes on is taken from it along that
    // motion, turns counted as ways of `length` a radian (see FeltTool).
    Wrench pass(const Wrench& wrench, const Vec3& velocity, const Vec3& spin, double length,
                double seconds) const {
        const Vec3 turning = spin * length;
        const double speed2 = glm::dot(velocity, velocity) + glm::dot(turning, turning);
        const double power = glm::dot(wrench.force, velocity) + glm::dot(wrench.torque, spin);
        const double allowed = std::max(0.0, taken_) / seconds;
        if (power <= allowed || !(speed2 > 0.0)) {
            return wrench;
        }
        const double damping = (power - allowed) / speed2;
        return {wrench.force - velocity * damping, wrench.torque - turning * (damping * length)};
    }
    void rest() { taken_ = 0.0; }

private:
    double taken_ = 0.0;  // from the hand, less what it was given (unit: joules)
};

}  // namespace tactus
