// Rough meshes: what the proxy costs and does where nothing is even. See tests/shared/rough_meshes.hpp, and
// unseen_meshes.hpp for those of kinds that nothing was tuned on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/proxy/proxy.hpp"
#include "proxy/three_pass.hpp"
#include "shared/bench_kit.hpp"

namespace tactus::bench {

struct RoughSettings {
    std::string only;  // see is_chosen()
    int ticks = 4'000;
    int replays = 3;
    std::int64_t max_work = ProxySettings{}.max_work;  // of a tick, see WorkBudget
    int checks = 48;  // finished ticks in contact held against exact descent, a case; unfinished ones besides
    int max_triangles = 3'000'000;
    // As worlds touch large meshes: through what a sphere of that radius can touch of them (narrowed()).
    bool narrowed = true;
    std::optional<Epsilons> three_pass;  // the thesis's proxy in place of ours
};

// Sets rough_NAME_TRIANGLES_rR_PATH.*, rough_NAME_TRIANGLES_rR.* and, over all of them, rough.*; the same
// with unseen. The thesis's proxy sets three_pass.….
void measure_rough(const shared::SpanClock& clock, const RoughSettings& settings, shared::Report& report);

}  // namespace tactus::bench
