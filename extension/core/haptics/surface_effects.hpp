// What a surface adds to the force of its contact: texture, viscosity, vibration, stick-slip, rings, magnet.
// The proxy itself stays where the geometry puts it; effects change the force only. What no contact's
// material asks for is not computed.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/haptics/force_law.hpp"

namespace tactus {

// What a body rings with since the hand has met it.
struct Ringing {
    int body = -1;           // slot; -1: none
    double amplitude = 0.0;  // at its start (unit: newtons)
    Nanoseconds since = 0;
};

// What effects remember of one proxy from tick to tick.
struct EffectMemory {
    int stuck_body = -1;  // slot of the body that stick-slip holds the hand to
    Vec3 stuck_at{0.0};   // where, in that body's frame (unit: meters)
    std::array<Ringing, HandForce::max_contacts> rings{};  // of the bodies that are touched
    Vec3 besides{0.0};          // what has acted on the hand and came from no contact (unit: newtons)
    Vec3 pulled{0.0};           // by magnets (unit: newtons)
    std::uint64_t magnets = 0;  // those magnets, by the count of their changes
};

struct HandMotion {
    Vec3 position{0.0};  // in the world (unit: meters)
    Vec3 velocity{0.0};  // in the world (unit: meters per second)
};

// Adds to each contact of `force` what its material's effects give, and updates the total. `force` is that of
// the contacts in `touching`, in the same order; `now` and `seconds` are the tick's time and length.
void add_surface_effects(const TouchScene& scene, std::span<const Touch> touching, const HandMotion& hand,
                         Nanoseconds now, double seconds, EffectMemory& memory, HandForce& force);

// The pull of a magnetic body on a proxy whose surface is `gap` away from it, along -normal (unit: newtons).
double magnet_pull(const TouchMaterial& material, double gap);

// A pull acts from a distance, so nothing that the hand does has to announce it: a magnet that spins, appears
// or is passed by at its middle line would turn it within a tick. A hand feels it change no faster (unit:
// newtons per second), which a hand that comes near as fast as hands do does not notice, and together with a
// leap of touch that fades meanwhile (fading_force.hpp) by less than half a newton in a tick.
constexpr double max_pull_rate = 200.0;

// What is left of `pull` in this tick, after what it was in the one before, from which it differs by at most
// `max_change` (unit: newtons). `magnets` counts how often one
// came, went or was described anew: where one has, all of the pull is left, since such a change is for others
// to hide.
Vec3 gradual_pull(const Vec3& pull, double max_change, std::uint64_t magnets, EffectMemory& memory);

}  // namespace tactus
