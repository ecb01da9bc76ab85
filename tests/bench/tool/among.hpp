// A tool among many bodies: hundreds of spheres beside hundreds of shapes must take no longer than a tick
// has.
#pragma once

#include <string>

#include "shared/bench_kit.hpp"

namespace tactus::bench {

struct AmongSettings {
    std::string only;
    int ticks = 1'500;
    int replays = 3;
};

void measure_among(const AmongSettings& settings, shared::Report& report);

}  // namespace tactus::bench
