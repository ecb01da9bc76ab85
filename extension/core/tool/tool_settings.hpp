// How a tool is set up, and what it reports of a tick: plain values, without what moves it.
#pragma once

#include <cstdint>

namespace tactus {

struct ToolSettings {
    std::uint32_t mask = 0xffff'ffffu;  // layers it touches
    std::uint32_t layer = 1;            // that it is in for other tools
    // Coulomb's, where it touches another tool, see ToolPair::friction. A body's is that of its material.
    double static_friction = 0.4;
    double dynamic_friction = 0.3;
    // Of the virtual coupling between hand and tool.
    double stiffness = 1000.0;       // (unit: newtons per meter), > 0
    double turning_stiffness = 1.0;  // (unit: newton meters per radian), > 0
    int max_steps = 32;              // a tick; what is missing then is made up in the next
    // A look within a sweep counts as any look here: the figures of docs/tool.md are by that.
    std::int64_t max_work = 12'000;  // a tick (see WorkBudget): below 0.25 ms
};

enum ToolStatus : std::uint32_t {
    tool_absent = 1u << 0,      // it began inside a body: no touch until the hand is out
    tool_touching = 1u << 1,    // at least one contact holds it back
    tool_sliding = 1u << 2,     // dynamic friction applies
    tool_unfinished = 1u << 3,  // this tick's steps or work did not suffice
    tool_squeezed = 1u << 4,    // a body that moves, or has come there, leaves it no room: it begins anew
};

}  // namespace tactus
