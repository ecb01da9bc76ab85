// Passive changes of a model (Willaert and others 2012; Xu and others 2014): a correction under a pressing
// hand may not add energy that the hand could take out again.
//
// The modelled force F of a surface of stiffness k holds S = |F|^2 / 2k, which the hand gets back as it
// leaves. A correction that makes F larger puts in what nobody has paid for. The hand is then given
//     f = F sqrt(1 - D / S)
// with D such that the size of f goes on without a step. As long as D stays, f is that of a spring whose
// potential U, the work to press it from nothing, is less than |f|^2 / 2k, which is what the hand had put in:
//     U = |F| |f| / 2k - D ln((|F| + |f|) / sqrt(2 k D)) <= S - D
// so that no way of the hand takes out more. D goes as a tank pays for what U grows by. The tank holds what
// friction and the surface have taken from the hand for good in this contact, and what corrections have taken
// out of U: in no contact the hand gets more than it has put in.
//
// A correction that makes F smaller takes something out: f = s F with an s > 1 that fades, which has U = s S.
// Both take the times of Willaert, 500 and 300 ms.
//
// What a correction has given a touched body in speed would reach the hand as work: the tank pays for it,
// else it is damped away as it comes.
#pragma once

#include "core/math/types.hpp"
#include "core/teleop/felt_pointer.hpp"

namespace tactus {

struct PassiveUpdateSettings {
    double bring_in = 0.5;  // within which the tank pays for a correction (unit: seconds), > 0
    double take_out = 0.3;  // within which a force that is no more goes (unit: seconds), > 0
    double tank = 0.02;     // most that is kept (unit: joules), >= 0
};

class PassiveUpdate {
public:
    // The model has changed under the hand: in this tick its force is `after`, and would have been `before`
    // (unit: newtons). Of a spring that is not linear, k at a force is that of one that stores as much.
    void changed(const Vec3& before, double k_before, const Vec3& after, double k_after);
    // A correction has given a touched body so much energy of motion (unit: joules).
    void sped_up(double energy) { owed_ += energy; }

    // One tick: the force on the hand (unit: newtons).
    Vec3 feel(const PassiveUpdateSettings& settings, const FeltInput& input);
    void forget() { *this = {}; }

    double tank() const { return tank_; }        // (unit: joules)
    double unpaid() const { return unpaid_; }    // D (unit: joules)
    double damped() const { return damped_J_; }  // so far (unit: joules)

private:
    void pay(const PassiveUpdateSettings& settings, const FeltInput& input);

    double unpaid_ = 0.0;  // D (unit: joules)
    double over_ = 1.0;    // s; 1 where D is not 0
    double pace_ = 0.0;    // at which D goes (unit: watts)
    double fading_ = 0.0;  // at which s goes (unit: 1/seconds)
    double owed_ = 0.0;    // of bodies' motion (unit: joules)
    double tank_ = 0.0;
    double potential_ = 0.0;  // U, one tick ago (unit: joules)
    Vec3 felt_{0.0};          // one tick ago (unit: newtons)
    double damped_ = 0.0;     // in the last tick (unit: joules)
    double damped_J_ = 0.0;
};

}  // namespace tactus
