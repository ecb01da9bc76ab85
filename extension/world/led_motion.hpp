// A body that an engine's own physics moves a few dozen times a second, and its local model in the session
// that answers hands in between (Session::lead_body): what each frame gives the one and puts right of the
// other.
//
// What hands have given the model until a frame goes to the engine's body in that frame, once. So the state S
// that the engine has in a frame contains what hands did until the frame before. S is compared with the model
// M as it was one frame ago, and with all that it has been corrected by since:
//
//     e = S[n] - (M[n-1] + corrections that were not in M[n-1] yet)
//
// An engine changes the velocity first and then goes with the new one for the whole frame of T seconds, where
// the model, in ticks of t, gains it little by little. So the engine's body is ahead of the model's by
// (T - t) / 2 times its velocity, which is no error of the model: that much of the place counts as its own.
// That is so where a force is even within a frame, and a frame comes when its time has passed. Between two
// stiff fingers a light body swings within a few frames; frames come late and in bursts. So the place also
// counts by which a body whose velocity changes evenly between two frames goes farther in T than the model
// went in between. The sum of this fades. The game's time may be one frame ahead of the model's or behind it;
// where it is more, it goes at another rate, and the difference counts no more.
//
// A right model has e = 0, however hard a hand presses and whatever rubs against the body. The model is put
// right by e. The part of e in the velocity divided by the frame is the acceleration that the model did not
// know: a spring, a wheel, a script. What two frames agree on of it acts on the model from then on; what only
// one says, an impulse, does not.
//
// A joint of the model can undo a correction within the frame, which e then still counts as given. So e takes
// back of the last correction at most what the model has kept: else the two would change signs for ever, and
// a chain of bodies would be shaken apart.
//
// The part of e that goes with what hands gave is no acceleration but another mass (seen_mass.hpp). As an
// acceleration it would come two frames late, and make a body swing between two fingers. What the found mass
// explains is left out of the acceleration: it would count twice.
//
// Plain values.
#pragma once

#include "session/session_types.hpp"
#include "world/seen_mass.hpp"

namespace tactus {

class LedMotion {
public:
    struct Frame {
        Vec3 impulse{0.0};  // for the engine's body, at its centre of mass (unit: newton seconds)
        Vec3 turn{0.0};     // angular, about it (unit: newton meter seconds)
        BodyCorrection correction;
        bool corrects = false;  // false: the model is right
    };

    // `engines`: the engine's body in this frame, before it has the impulse. `model`: as it is now.
    // `seconds`: of a frame, `tick`: of one of the model's ticks, > 0. A frame in which the engine's body has
    // something that is no number is left out.
    Frame frame(const BodyMotion& engines, const LedState& model, double seconds, double tick);

    // Farther off than this within a frame, a body has been put there and has not gone (units: meters,
    // radians).
    static constexpr double farthest_way = 0.1;
    static constexpr double farthest_turn = 1.0;

private:
    BodyMotion expected() const;
    void leave_what_is_lost(BodyCorrection& next, const LedState& model) const;
    Vec3 without_mass(const Vec3& besides, bool is_seen);
    void note_unknown(const Vec3& besides, const Vec3& angular, double seconds);
    void note_lead(const LedState& model, double seconds, double tick);
    BodyMotion without_lead(const BodyMotion& body, double lead) const;

    bool is_known_ = false;
    LedState before_;                    // one frame ago
    BodyCorrection sent_;                // sums
    Vec3 ahead_{0.0}, ahead_turn_{0.0};  // the engine's body is, besides the lead of an even force
    double late_ = 0.0;                  // the engine's time is so far ahead of the model's (unit: seconds)
    Vec3 given_{0.0};                    // to the engine's body so far
    Vec3 given_turn_{0.0};               // angular
    Vec3 pushed_{0.0};                   // of given_, in the last frame
    SeenMass mass_;
    Vec3 pull_{0.0},
        pull_before_{0.0};  // the model has been accelerated by since the last frame, the one before
    Vec3 spin_up_{0.0}, spin_up_before_{0.0};
    Vec3 unknown_{0.0}, unknown_spin_{0.0};  // accelerations, as of the last frame
};

}  // namespace tactus
