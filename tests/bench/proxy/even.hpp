// Even meshes: a box, spheres and a terrain, whose error is known to the last digits.
#pragma once

#include <optional>
#include <string>

#include "proxy/three_pass.hpp"
#include "shared/bench_kit.hpp"

namespace tactus::bench {

struct EvenSettings {
    std::string only;  // see is_chosen()
    int ticks = 20'000;
    int rounds = 5;      // whose median counts, of the proxy's ticks as of the others' queries
    int checks = 1'500;  // ticks held against exact descent
    int max_triangles = 1'310'720;
    std::optional<Epsilons> three_pass;  // the thesis's proxy in place of ours, and of the others' queries
};

// Sets box_12_rR.*, sphere_TRIANGLES_rR.* and terrain_524288_rR.*, and the last two as single_… again with
// corners in single precision, as meshes come from Godot and as Jolt keeps them. The thesis's proxy sets
// three_pass.CASE.*.
void measure_even(const shared::SpanClock& clock, const EvenSettings& settings, shared::Report& report);

// Sets friction.*: the largest deviation from Coulomb's law.
void measure_friction(shared::Report& report);

// Sets still.movement_max: how far the proxy strays while the hand rests for a million ticks (unit: meters).
void measure_still_hand(shared::Report& report);

}  // namespace tactus::bench
