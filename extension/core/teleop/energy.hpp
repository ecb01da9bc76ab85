// Energy that flows at a hand, and the tank that what is added to touch has to live on.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/math/types.hpp"

namespace tactus {

// Published figures (unit: joules), since the pointer or the side came.
struct EnergyFigures {
    double hand_J = 0.0;    // given to the hand: the sum of F . v dt; below zero where the hand does the work
    double far_J = 0.0;     // the same at the far side's hand, which is that of the stand-in
    double tank_J = 0.0;    // in the tank now
    double hidden_J = 0.0;  // of hand_J, what hiding has put in (below zero: taken out)
    double damped_J = 0.0;  // that hiding would have put in, and the tank or a limit has refused
};

// Filled by what touch takes from the hand for good: the hand's work less what is stored in the spring of the
// touch. A release of the spring so never counts as energy that may be spent again.
//
// A force is held for a tick, so that its work is that of the force of the last tick over the displacement in
// this one: F_(t-1) . (x_t - x_(t-1)). What an added force will do is known only then; it is limited before
// by what it would do if the hand went on as it does, and what it has done more is a debt.
class EnergyTank {
public:
    // The hand has gone `way` with the force of the model that was held, and with what was added to it
    // (units: newtons, meters). `stored`: in the touch's spring now (unit: joules).
    void fill(const Vec3& modelled, const Vec3& added, const Vec3& way, double stored, double most) {
        level_ -= glm::dot(modelled + added, way) + (stored - stored_);
        stored_ = stored;
        level_ = std::clamp(level_, -most, most);
    }

    // Of an added force, what the tank allows in this tick; the rest of its part along the velocity is left
    // away. With a level E it gives the power E / reserve at most, so that it runs low instead of dry.
    Vec3 allow(const Vec3& added, const Vec3& hand_velocity, double seconds, double reserve,
               double& refused) const {
        const double power = glm::dot(added, hand_velocity);
        const double allowed = std::max(0.0, level_) / std::max(reserve, seconds);
        if (power <= allowed) {
            return added;
        }
        refused += (power - allowed) * seconds;
        return added - hand_velocity * ((power - allowed) / glm::dot(hand_velocity, hand_velocity));
    }

    // Nothing is touched: what a spring still held is gone, and so is a debt.
    void let_go() {
        stored_ = 0.0;
        level_ = std::max(0.0, level_);
    }

    double level() const { return level_; }  // (unit: joules)

private:
    double level_ = 0.0;
    double stored_ = 0.0;
};

}  // namespace tactus
