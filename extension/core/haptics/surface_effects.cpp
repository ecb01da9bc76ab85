#include "core/haptics/surface_effects.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "core/haptics/surface_feel.hpp"
#include "core/haptics/surface_spring.hpp"
#include "core/haptics/surface_way.hpp"

namespace tactus {

namespace {

Vec3 along_surface(const Vec3& v, const Vec3& normal) {
    return v - normal * glm::dot(v, normal);
}

bool has_texture(const Feel& feel) {
    return feel.heights() && feel.material->texture_depth > 0.0;
}
bool has_stick_slip(const TouchMaterial& m) {
    return m.stick_slip_stiffness > 0.0 && m.stick_slip_force > 0.0;
}

// The relief stores energy like the spring it lies on: U(pressure + height), k d^2 / 2 of one that is linear.
// Its slope pushes the hand downhill, its height away from the surface.
Vec3 texture_force(const TouchScene& scene, const Feel& feel, const Touch& contact) {
    const TouchImage& image = *feel.heights();
    const ImagePlace place =
        image_place(scene, feel, image, contact.body, contact.feature, contact.point, contact.normal);
    const ImageSample relief = sample(image, place, feel.material->texture_depth);
    const Vec3 downhill =
        -along_surface(direction_to_parent(scene.body(contact.body).pose, relief.gradient), contact.normal);
    const SurfaceSpring spring = spring_of(*feel.material);
    if (!spring.is_linear()) {
        const double raised = spring.force(contact.pressure + relief.value);
        return contact.normal * (raised - spring.force(contact.pressure)) + downhill * raised;
    }
    return contact.normal * (spring.stiffness * relief.value) +
           downhill * (spring.stiffness * (contact.pressure + relief.value));
}

// A spring to the place where the hand stuck; when it is stretched beyond its force, the hand sticks anew
// where it is.
Vec3 stick_slip_force(const TouchBody& body, const TouchMaterial& material, const Touch& contact,
                      const Vec3& hand, EffectMemory& memory) {
    if (memory.stuck_body != contact.body) {
        memory.stuck_body = contact.body;
        memory.stuck_at = to_local(body.pose, hand);
    }
    const Vec3 stretched = along_surface(to_parent(body.pose, memory.stuck_at) - hand, contact.normal);
    const Vec3 force = stretched * material.stick_slip_stiffness;
    if (glm::length(force) > material.stick_slip_force) {
        memory.stuck_at = to_local(body.pose, hand);
        return Vec3(0.0);
    }
    return force;
}

const Ringing* ring_of(std::span<const Ringing> rings, int body) {
    const auto found = std::ranges::find(rings, body, &Ringing::body);
    return found != rings.end() ? &*found : nullptr;
}

// A surface that is met rings: a sine that decays, and begins at 0 (Okamura, Dennerlein and Howe 1998). One
// that goes on being touched rings on, one that was let go of is met anew. `met_at` is the speed into it.
double tap_force(const Touch& contact, const TouchMaterial& material, double met_at, Nanoseconds now,
                 std::span<const Ringing> before, Ringing& ring) {
    const Ringing* const known = ring_of(before, contact.body);
    ring = known ? *known : Ringing{contact.body, material.impact_strength * std::max(0.0, met_at), now};
    const double t = to_seconds(now - ring.since);
    return ring.amplitude * std::exp(-t / material.impact_decay) *
           std::sin(2.0 * std::numbers::pi * material.impact_frequency * t);
}

}  // namespace

double magnet_pull(const TouchMaterial& material, double gap) {
    return material.magnet_force * std::clamp(1.0 - gap / material.magnet_range, 0.0, 1.0);
}

Vec3 gradual_pull(const Vec3& pull, double max_change, std::uint64_t magnets, EffectMemory& memory) {
    const bool are_others = std::exchange(memory.magnets, magnets) != magnets;
    const Vec3 change = pull - memory.pulled;
    const double length = glm::length(change);
    memory.pulled =
        are_others || length <= max_change ? pull : memory.pulled + change * (max_change / length);
    return memory.pulled;
}

void add_surface_effects(const TouchScene& scene, std::span<const Touch> touching, const HandMotion& hand,
                         Nanoseconds now, double seconds, EffectMemory& memory, HandForce& force) {
    bool sticks = false;
    const std::array<Ringing, HandForce::max_contacts> rings = std::exchange(memory.rings, {});
    for (int i = 0; i < force.contact_count; ++i) {
        const Touch& contact = touching[static_cast<std::size_t>(i)];
        const Feel feel = feel_at(scene, contact);
        const TouchMaterial& material = *feel.material;
        Vec3 added(0.0);
        if (has_texture(feel)) {
            added += texture_force(scene, feel, contact);
        }
        if (material.viscosity > 0.0 || material.impact_strength > 0.0) {
            const Vec3 carried = way_of_surface(scene, contact) / seconds;
            const Vec3 speed = hand.velocity - carried;
            added -= along_surface(speed, contact.normal) * material.viscosity;
            if (material.impact_strength > 0.0 && !ring_of(memory.rings, contact.body)) {
                added += contact.normal * tap_force(contact, material, -glm::dot(speed, contact.normal), now,
                                                    rings, memory.rings[static_cast<std::size_t>(i)]);
            }
        }
        if (material.vibration_force > 0.0) {
            const double phase = 2.0 * std::numbers::pi * material.vibration_frequency * to_seconds(now);
            added += contact.normal * (material.vibration_force * std::sin(phase));
        }
        if (has_stick_slip(material) && !sticks) {
            added += stick_slip_force(scene.body(contact.body), material, contact, hand.position, memory);
            sticks = true;
        }
        force.contacts[i].on_hand += added;
        force.total += added;
    }
    if (!sticks) {
        memory.stuck_body = -1;
    }
}

}  // namespace tactus
