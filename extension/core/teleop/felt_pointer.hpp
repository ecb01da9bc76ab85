// What stands between a model that may change at any time and the hand: no change of it is felt as a step.
//
// The hand is given felt = modelled + hidden. Whenever the model is changed - corrected, described anew,
// taken away, exchanged for the far side's own force - `hidden` takes up what the change would have made of
// the force, in the same tick and for the same hand. From then on it fades, no faster than is noticed.
//
// States and their transitions:
//     together    -> bridged      the model has changed and `hidden` makes up for it
//     bridged     -> together     it has faded
//     bridged     -> letting_go   more is hidden than is felt, or nothing is touched any more
//     letting_go  -> together     it is gone
//     together    -> carried      a second pointer is carried along with the object
//     (session/carried_pointer.hpp)
// Letting go fades within `let_go_seconds` however much there is; whoever feels it is told so.
//
// What is hidden lives on energy that touch has taken from the hand before (energy.hpp).
#pragma once

#include <cstdint>

#include "core/math/types.hpp"
#include "core/teleop/energy.hpp"
#include "core/teleop/stealth.hpp"

namespace tactus {

enum class FeltState : std::uint8_t { together, carried, bridged, letting_go };

struct FeltInput {
    Vec3 modelled{0.0};       // by the model as it is now (unit: newtons)
    Vec3 hand_velocity{0.0};  // (unit: meters per second)
    double stiffness = 0.0;   // of what is touched (unit: newtons per meter); 0: nothing is
    double seconds = 0.0;     // of a tick
};

class FeltPointer {
public:
    // The model has changed under the hand: in this tick `modelled` is `after`, and would have been `before`.
    void hide(const Vec3& before, const Vec3& after);
    // The same, but only the size of what is felt is kept.
    void hide_size(const Vec3& before, const Vec3& after);

    // One tick: the force on the hand (unit: newtons).
    Vec3 feel(const StealthSettings& settings, const FeltInput& input);

    // Nobody holds it any more.
    void forget();

    FeltState state() const { return state_; }
    const Vec3& hidden() const { return hidden_; }  // (unit: newtons)
    double faded() const { return faded_; }         // in the last tick (unit: newtons)
    bool begins_to_let_go() const { return begins_to_let_go_; }
    const EnergyFigures& energy() const { return energy_; }

private:
    double fading(const StealthSettings& settings, const FeltInput& input, double felt);

    Vec3 hidden_{0.0};
    FeltState state_ = FeltState::together;
    DriftRate drift_;               // of what corrections bring
    double modelled_before_ = 0.0;  // size of the modelled force, one tick ago (unit: newtons)
    double letting_go_rate_ = 0.0;  // (unit: newtons per second)
    double faded_ = 0.0;
    bool begins_to_let_go_ = false;
    EnergyTank tank_;
    EnergyFigures energy_;
};

}  // namespace tactus
