// One experiment of teleoperation in virtual time: a scene, a case, and what came of it. Both sides and,
// beside them, the same hand that touches the environment directly tick in one thread; two runs give the same
// bits.
#pragma once

#include "shared/teleop_case.hpp"
#include "shared/teleop_figures.hpp"

namespace tactus::shared {

// Needs a scene without mistakes. `bins`, where given, gets how the ticks spread, for pooling over cases.
TeleopFigures run_teleop(const TeleopScene& scene, const TeleopCase& experiment, TeleopBins* bins = nullptr);

}  // namespace tactus::shared
