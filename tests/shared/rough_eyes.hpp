// Sees poses with normally distributed chance.
#pragma once

#include <glm/geometric.hpp>
#include <random>

#include "core/math/body_motion.hpp"

namespace tactus::shared {

class RoughEyes {
public:
    // Standard deviations along each axis (unit: meters, radians).
    RoughEyes(double of_place, double of_turn, unsigned seed = 3)
        : of_place_(of_place), of_turn_(of_turn), random_(seed) {}

    Pose see(const Pose& pose) {
        return {pose.position + of_place_ * vector(),
                glm::normalize(turn_by(of_turn_ * vector(), 1.0) * pose.rotation)};
    }

    double of_place() const { return of_place_; }
    double of_turn() const { return of_turn_; }

private:
    Vec3 vector() { return {normal_(random_), normal_(random_), normal_(random_)}; }

    double of_place_, of_turn_;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_{0.0, 1.0};
};

}  // namespace tactus::shared
