// A hand that presses and holds still while something else changes: the far scene, the far hand, the link, or
// who is there. Every step of its force is then one that its own motion does not explain. In virtual time,
// the same bits each run.
#pragma once

#include <string>
#include <vector>

namespace tactus::shared {

enum class StillChange {
    put_2mm_aside,      // a script moves the far body, every 150 ms
    put_10mm_aside,     // likewise
    put_10mm_up,        // likewise
    mask_off,           // the far hand touches nothing, and again all, every 500 ms
    led,                // the far body is kinematic: +-20 mm, twice a second
    pushed,             // another hand pushes the far body with 2 N, on and off
    limits_changed,     // a hinge that holds the body has other limits, at both sides
    stiffness_changed,  // of the body, at both sides
    far_side_restarts,  // away for 150 ms
    line_dead_short,    // 150 ms
    line_dead_long,     // 1.5 s
    pointer_disabled,   // the operator's, for 1 s
    pointer_freed,      // the operator's
    device_gone,        // the operator's, for 1.5 s
    operator_restarts,  // while its hand is inside the body
};

struct StillCase {
    std::string name;
    StillChange change = StillChange::mask_off;
    double delay = 0.0;  // there and back (unit: seconds)
    int scenario = 4;    // 2 or 4
    bool tool = false;   // in place of the fingertip
};

struct StillFigures {
    double pressed = 0.0;    // by the operator before anything changes (unit: newtons)
    double near_step = 0.0;  // largest change of the operator's force in a tick (unit: newtons)
    double far_step = 0.0;   // likewise of the far hand's, while a hand of the operator comes or goes
    double told_step = 0.0;  // the link's own figure of near_step (unit: newtons)
    double far_alone = 0.0;  // most that the far hand presses while the operator feels nothing, where that
                             // lasts for more than 1 s and the delay (unit: newtons)
};

std::vector<StillCase> still_cases();
StillFigures run_still(const StillCase& one);

}  // namespace tactus::shared
