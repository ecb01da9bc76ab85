// What a tick is made of, each alone, on the triangles of a fine sphere that the proxy touches.
#pragma once

#include "shared/bench_kit.hpp"

namespace tactus::bench {

// Sets kernel.*_ns: the median of so many rounds, a call.
void measure_kernels(const shared::SpanClock& clock, int rounds, shared::Report& report);

}  // namespace tactus::bench
