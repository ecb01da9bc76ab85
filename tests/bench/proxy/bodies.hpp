// Many bodies around one sphere: what is far must take no time, what is near no more than a tick has.
#pragma once

#include <string>

#include "shared/bench_kit.hpp"

namespace tactus::bench {

struct BodiesSettings {
    std::string only;
    int ticks = 3'000;
    int replays = 3;
};

void measure_bodies(const shared::SpanClock& clock, const BodiesSettings& settings, shared::Report& report);

}  // namespace tactus::bench
