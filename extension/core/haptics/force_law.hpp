// From where proxy and hand are to what the hand feels and what the touched bodies get.
#pragma once

#include <limits>
#include <span>

#include "core/haptics/contact.hpp"
#include "core/haptics/touch_scene.hpp"
#include "core/safety/stiffness_limit.hpp"

namespace tactus {

enum class ForceLaw {
    spring,    // thesis eq. 3.2: F = k (x_proxy - x_hand), positive away from the surface
    smoothed,  // thesis eq. 3.3: F = F_before / 2 + k (x_proxy - x_hand) / 2
};

struct ContactForce {
    int body = -1;      // slot in the TouchScene
    FeatureId feature;  // of the scene, now
    Vec3 point{0.0};    // in the world (unit: meters)
    Vec3 on_hand{0.0};  // (unit: newtons); the body gets the opposite
    // That has pressed, as stiff as it is at this depth: the material's, or what of it is safe.
    Wall wall;
    double wanted_stiffness = 0.0;  // of the material's (unit: newtons per meter)
};

struct HandForce {
    static constexpr int max_contacts = 3;

    Vec3 total{0.0};  // on the hand, in the world (unit: newtons)
    ContactForce contacts[max_contacts];
    int contact_count = 0;
    double source = 0.0;  // energy that bodies on their way give the hand in this tick (unit: joules)
    Vec3 of_speed{0.0};   // what dampers add because surfaces move (unit: newtons)
};

// What of a material's wall a hand may be given.
struct SafeWalls {
    LoopLag lag;
    double device_damping = std::numeric_limits<double>::infinity();  // (unit: newton seconds per meter)
    // Of the pad between hand and surface; 0: there is none (unit: newtons per meter).
    double pad_stiffness = 0.0;
    // Of the sphere that touches; 0: a point, under which nothing more gives (unit: meters).
    double radius = 0.0;
};

// A surface under a pad. Of the way that both give, the surface's share is s = k_pad / (k_pad + K): together
// they are s K stiff, and the surface's damper, which sees the share s of the speed, takes s^2 B.
Wall under_pad(const Wall& surface, double pad_stiffness);

// Each contact presses with its own material's stiffness and damping. What friction holds (`slide`, the pull
// left along the surfaces) is shared among the contacts by how much each presses. Damping acts against the
// speed of the hand into the surface, relative to the body, and never pulls. `seconds` is the tick (unit:
// seconds).
HandForce contact_force(const TouchScene& scene, std::span<const Touch> touching, const Vec3& slide,
                        const Vec3& hand_velocity, double seconds, const SafeWalls& safe = {});

// Eq. 3.3: the mean of what the hand felt before and what it would feel now. The contacts share the change by
// how hard each pushes, so that hand and bodies still feel opposite forces.
void smooth(HandForce& force, const Vec3& before);

}  // namespace tactus
