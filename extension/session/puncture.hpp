// A hand whose proxy has broken into bodies: what it feels within them, and which of them it has told.
// Private to session/.
//
// Along a shaft from where the surface broke to the proxy, friction sticks as a spring of the material's
// stiffness until it bears shaft_friction times that depth, and then slides; its anchor is in the body, so a
// hand at rest does not creep. Viscosity acts on the hand against the body.
#pragma once

#include <array>
#include <span>

#include "core/haptics/surface_effects.hpp"
#include "core/haptics/touch_scene.hpp"
#include "core/proxy/passed_bodies.hpp"
#include "core/safety/stiffness_limit.hpp"

namespace tactus {

// On the hand, of one body; that gets the opposite.
struct ShaftForce {
    int body = -1;      // slot in the TouchScene
    Vec3 point{0.0};    // in the world (unit: meters)
    Vec3 on_hand{0.0};  // (unit: newtons)
};

class Punctures {
public:
    using Bodies = std::span<const PassedBodies::Passed>;
    static constexpr std::size_t most = PassedBodies::capacity;

    // How steep all of them are at most, where friction sticks.
    static Wall steepest(const TouchScene& scene, Bodies passed);

    // One tick. `share`: what of that is safe, 0 to 1.
    void tick(const TouchScene& scene, Bodies passed, const HandMotion& hand, double share, double seconds);

    std::span<const ShaftForce> forces() const { return {forces_.data(), force_count_}; }
    Vec3 total() const;
    void clear() { *this = {}; }

private:
    struct Shaft {
        int body = -1;
        Vec3 anchor{0.0};  // in the body's frame (unit: meters)
    };

    Shaft shaft_of(const TouchBody& body, const PassedBodies::Passed& passed, const Vec3& hand) const;

    std::array<Shaft, most> shafts_{};
    std::size_t count_ = 0;
    std::array<ShaftForce, most> forces_{};
    std::size_t force_count_ = 0;
};

}  // namespace tactus
