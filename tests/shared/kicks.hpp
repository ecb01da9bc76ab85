// What a hand must never feel: a kick because the scene changed. Whole sessions in virtual time, with a
// device that keeps the force it is given; a body of any form appears over the hand, is put elsewhere, leaves
// no room; the sphere grows; a material changes; a mesh deforms; pointers come, go and change hands; the
// device's workspace is put elsewhere; all that to a tool in place of a sphere; a camera sees a body
// elsewhere than it was. And a hand that only drags, from one surface to another one that is as much softer
// or stiffer as can be: slowly over edges with friction, or as fast as a hand goes.
#pragma once

#include <cstdint>
#include <string_view>

namespace tactus::shared {

enum class KickCase {
    appears,
    teleports,
    grows,
    squeezed,
    vanishes,
    stiffens,
    deforms,
    crosses,
    hands,
    workspace,
    tool,
    seen,
    drags,
};

inline constexpr KickCase kick_cases[] = {
    KickCase::appears,  KickCase::teleports, KickCase::grows,   KickCase::squeezed, KickCase::vanishes,
    KickCase::stiffens, KickCase::deforms,   KickCase::crosses, KickCase::hands,    KickCase::workspace,
    KickCase::tool,     KickCase::seen,      KickCase::drags};

std::string_view name_of(KickCase kick);

struct KickFigures {
    double force_step_max = 0.0;   // largest change of the device's force in a tick (unit: newtons)
    double torque_step_max = 0.0;  // likewise (unit: newton meters)
    double force_max = 0.0;        // (unit: newtons)
    int events = 0;                // changes of the scene
    int let_out = 0;               // of them, such that a body let the sphere out
    // Ticks in which the sphere overlapped a body by more than half its radius, or was inside one, and did
    // not say that it is being let out.
    int overlaps = 0;
    int imprisoned = 0;   // runs that ended far from all bodies with a force
    int untouchable = 0;  // runs after which the body was not felt when pressed from outside
    int ticks = 0;

    void add(const KickFigures& other);
};

// One seeded run. The hand moves so slowly that its own way changes the force by at most 0.1 N a tick; in
// KickCase::drags it goes along a plane without friction, which changes none.
KickFigures play_kick(KickCase kick, std::uint64_t seed);

}  // namespace tactus::shared
