// FeltPointer for a hand that holds a tool: no change of the model is felt as a step, neither in the force
// nor in the torque.
//
// A torque t is felt like the force t / L, with L the root of the coupling's stiffness in turns over that in
// ways (docs/tool.md): the hand's turn w is the way L w then, and both springs are of the same stiffness. So
// what is noticed, hidden and paid for is the same in turns as in ways, each by energy of its own.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/math/wrench.hpp"
#include "core/teleop/felt_pointer.hpp"

namespace tactus {

struct FeltToolInput {
    Wrench modelled;          // by the model as it is now, about the hand
    Vec3 hand_velocity{0.0};  // (unit: meters per second)
    Vec3 hand_spin{0.0};      // (unit: radians per second)
    double stiffness = 0.0;   // of the coupling (unit: newtons per meter); 0: nothing is touched
    double length = 1.0;      // L (unit: meters), > 0
    double seconds = 0.0;     // of a tick
};

class FeltTool {
public:
    // See FeltPointer, for which the calls stand.
    void hide(const Wrench& before, const Wrench& after, double length) {
        force_.hide(before.force, after.force);
        turning_.hide(before.torque / length, after.torque / length);
    }
    void let_go() {
        force_.let_go();
        turning_.let_go();
    }
    Wrench feel(const StealthSettings& settings, const FeltToolInput& in) {
        const Vec3 force =
            force_.feel(settings, {in.modelled.force, in.hand_velocity, in.stiffness, in.seconds});
        const Vec3 turning = turning_.feel(
            settings, {in.modelled.torque / in.length, in.hand_spin * in.length, in.stiffness, in.seconds});
        const bool hides = turning_.hidden() != Vec3(0.0);
        return {force, hides ? turning * in.length : in.modelled.torque};
    }
    void forget() {
        force_.forget();
        turning_.forget();
    }

    // Of the two the one that is farther from being together.
    FeltState state() const { return std::max(force_.state(), turning_.state()); }
    // (unit: newtons)
    double hidden() const { return std::hypot(glm::length(force_.hidden()), glm::length(turning_.hidden())); }
    double faded() const { return force_.faded() + turning_.faded(); }
    bool begins_to_let_go() const { return force_.begins_to_let_go() || turning_.begins_to_let_go(); }
    EnergyFigures energy() const {
        EnergyFigures sum = force_.energy();
        const EnergyFigures& turning = turning_.energy();
        sum.hand_J += turning.hand_J;
        sum.tank_J += turning.tank_J;
        sum.hidden_J += turning.hidden_J;
        sum.damped_J += turning.damped_J;
        return sum;
    }

private:
    FeltPointer force_, turning_;
};

}  // namespace tactus
