// A tool among many bodies: hundreds of spheres beside hundreds of shapes must take no longer than a tick
// has.
#pragma once

#include <string>

#include "shared/bench_kit.hpp"

namespace tactus::bench {

// Those cases that `only` chooses (see is_chosen).
void measure_among(const std::string& only, shared::Report& report);

}  // namespace tactus::bench
