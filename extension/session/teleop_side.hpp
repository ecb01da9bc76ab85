// One side of a teleoperation, as the loop sees it: three calls a tick. Private to session/; made by its
// owner (operator_side.hpp, teleoperator_side.hpp) and handed to Session::attach().
#pragma once

#include "core/safety/force_exit.hpp"
#include "session/session_types.hpp"

namespace tactus {

class SessionLoop;

// Runs inside the tick: no allocation, no lock, no clock.
class TeleopSide {
public:
    virtual ~TeleopSide() = default;

    // The devices have been read. What the link has delivered is taken; hands may be put elsewhere.
    virtual void set_hands(SessionLoop& loop, Nanoseconds now) = 0;

    // The proxies have moved; neither bodies nor devices have got their force yet. The model is corrected,
    // forces may be others.
    virtual void set_forces(SessionLoop& loop, Nanoseconds now) = 0;

    // The step is done: what the far side is to know.
    virtual void report(SessionLoop& loop, Nanoseconds now) = 0;

    // False: bodies stay where they are put and nothing touches them; everything comes from the far side.
    virtual bool simulates() const { return true; }

    // True: an operator's hands hold this side's tools.
    virtual bool hears_tools() const { return false; }

    // True: this side's devices are robots. What moves them may give them energy.
    virtual bool drives() const { return false; }

    // What leaves for the devices is limited by this, besides each device's own longest force.
    virtual const ForceLimits& limits() const = 0;

    // A second loop with the same bodies, in which the past is replayed; null where there is none.
    virtual SessionLoop* twin() { return nullptr; }
};

}  // namespace tactus
