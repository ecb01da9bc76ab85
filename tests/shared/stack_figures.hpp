// A tool that pushes ten boxes off one another: a whole session in virtual time.
#pragma once

#include "shared/tool_figures.hpp"

namespace tactus::shared {

struct StackFigures {
    ToolFigures tool;      // each tick timed as the whole session's
    int lost = 0;          // ticks in which the tool was squeezed out or absent
    double highest = 0.0;  // of the boxes' middles, at the end (unit: meters)
};

// An upright peg is drawn through it at this speed (unit: meters per second), beside its middle (unit:
// meters).
StackFigures push_stack(double speed, double aside);

}  // namespace tactus::shared
