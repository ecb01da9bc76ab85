#include "core/haptics/force_law.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/haptics/surface_way.hpp"

namespace tactus {

Wall under_pad(const Wall& surface, double pad_stiffness) {
    if (pad_stiffness <= 0.0 || surface.stiffness <= 0.0) {
        return surface;
    }
    const double share = pad_stiffness / (pad_stiffness + surface.stiffness);
    return {share * surface.stiffness, share * share * surface.damping};
}

HandForce contact_force(const TouchScene& scene, std::span<const Touch> touching, const Vec3& slide,
                        const Vec3& hand_velocity, double seconds, const SafeWalls& safe) {
    HandForce force;
    double all_pressure = 0.0;
    for (const Touch& contact : touching) {
        all_pressure += contact.pressure;
    }
    for (const Touch& contact : touching) {
        if (force.contact_count == HandForce::max_contacts) {
            break;
        }
        const TouchBody& body = scene.body(contact.body);
        const TouchMaterial& material = body.material;
        const Wall wall = safe_wall(safe.lag, safe.device_damping,
                                    under_pad({material.stiffness, material.damping}, safe.pad_stiffness));
        const Vec3 surface_way = way_of_surface(scene, contact);
        const double approach = -glm::dot(hand_velocity - surface_way / seconds, contact.normal);
        const double spring = wall.stiffness * contact.pressure;
        const double damper = wall.damping * approach;
        const Vec3 held = slide * (contact.pressure / all_pressure);
        ContactForce& part = force.contacts[force.contact_count++];
        part.body = contact.body;
        part.point = contact.point;
        part.on_hand = contact.force_direction * std::max(0.0, spring + damper) - held * wall.stiffness;
        part.wall = wall;
        force.source += glm::dot(part.on_hand, surface_way);
        force.total += part.on_hand;
    }
    return force;
}

void smooth(HandForce& force, const Vec3& before) {
    const Vec3 change = 0.5 * (before - force.total);
    double all = 0.0;
    for (int i = 0; i < force.contact_count; ++i) {
        all += glm::length(force.contacts[i].on_hand);
    }
    for (int i = 0; i < force.contact_count && all > 0.0; ++i) {
        force.contacts[i].on_hand += change * (glm::length(force.contacts[i].on_hand) / all);
    }
    force.total += change;
}

Vec3 limited_force(const Vec3& force, double limit) {
    const double length = glm::length(force);
    if (!std::isfinite(length)) {
        return Vec3(0.0);
    }
    return length > limit ? force * (limit / length) : force;
}

}  // namespace tactus
