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
//     any         -> letting_go   let_go(): what the change leads to is too large to hide
//     letting_go  -> together     it is gone
//     letting_go  -> bridged      but for what has changed meanwhile, less what the tank takes back of it
//     letting_go  -> letting_go   that is more than is felt: it is let go as well
//     together    -> carried      a second pointer is carried along with the object
//     (session/carried_pointer.hpp)
// What is let go goes over into what is modelled within `let_go_seconds`, however much there is, and later
// only where the force would rise too steeply or the model goes away from it meanwhile; whoever feels it is
// told so.
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
    Vec3 hand_velocity{0.0};  // mean since the last tick (unit: meters per second)
    double stiffness = 0.0;   // of what is touched (unit: newtons per meter); 0: nothing is
    double seconds = 0.0;     // of a tick
};

class FeltPointer {
public:
    // The model has changed under the hand: in this tick `modelled` is `after`, and would have been `before`.
    void hide(const Vec3& before, const Vec3& after);
    // What the model will do now is not what it would have done, by more than can be hidden as it comes.
    void let_go() { lets_go_ = true; }
    // The same as hide(), but only the size of what is felt is kept.
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
    void begin_to_let_go(const StealthSettings& settings, const FeltInput& input);
    Vec3 left_of_felt(const FeltInput& input, double own_change);
    double fading(const StealthSettings& settings, const FeltInput& input, double fallen) const;

    Vec3 hidden_{0.0};
    Vec3 held_hidden_{0.0};  // of felt_, what was hidden (unit: newtons)
    Vec3 felt_{0.0};         // one tick ago (unit: newtons)
    Vec3 change_{0.0};       // of what is felt, in the last tick (unit: newtons)
    FeltState state_ = FeltState::together;
    DriftRate drift_;               // of what corrections bring
    double modelled_before_ = 0.0;  // size of the modelled force, one tick ago (unit: newtons)
    bool lets_go_ = false;          // is to
    double left_ = 0.0;             // of letting go (unit: seconds)
    double pace_ = 0.0;             // at which it began to go (unit: newtons per second)
    Vec3 kept_{0.0};                // what changes have added meanwhile (unit: newtons)
    double faded_ = 0.0;
    bool begins_to_let_go_ = false;
    EnergyTank tank_;
    EnergyFigures energy_;
};

}  // namespace tactus
