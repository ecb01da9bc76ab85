#include "core/haptics/force_law.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/haptics/surface_feel.hpp"
#include "core/haptics/surface_spring.hpp"
#include "core/haptics/surface_way.hpp"

namespace tactus {

namespace {

// A wall at the depth that it is pressed to, and the force over the way there.
struct Pressing {
    Wall wall;
    double wanted = 0.0;  // stiffness of the wall, were it safe (unit: newtons per meter)
    double secant = 0.0;  // (unit: newtons per meter)
};

// Too steep a curve is weakened as a whole, so that its peaks and valleys stay where they are.
Pressing press_curve(const ForceCurve& curve, const TouchMaterial& material, double stretch,
                     const SafeWalls& safe) {
    const double wanted = std::max(curve.steepest, material.stiffness);
    const Wall bound =
        safe_wall(safe.lag, safe.device_damping, {std::numeric_limits<double>::infinity(), material.damping});
    const double share = wanted > bound.stiffness ? bound.stiffness / wanted : 1.0;
    const ForceCurve::At at = curve.at(stretch, material.stiffness);
    const double stiffness = share * std::abs(at.slope);
    return {{stiffness, bound.damping}, wanted, stretch > 0.0 ? share * at.force / stretch : stiffness};
}

// `stretch`: from proxy to hand, of which the pad has its share (unit: meters).
Pressing press_surface(const Feel& feel, double stretch, const SafeWalls& safe) {
    const TouchMaterial& material = *feel.material;
    if (const ForceCurve* const curve = feel.curve()) {
        return press_curve(*curve, material, stretch, safe);
    }
    const SurfaceSpring surface = spring_of(material);
    const double pad = safe.pad_stiffness;
    if (surface.is_linear()) {
        const Wall wanted = under_pad({material.stiffness, material.damping}, pad);
        const Wall wall = safe_wall(safe.lag, safe.device_damping, wanted);
        return {wall, wanted.stiffness, wall.stiffness};
    }
    const auto wall_of = [&](const SurfaceSpring& spring, double depth) {
        return under_pad({spring.slope(depth), material.damping}, pad);
    };
    const Wall wanted = wall_of(surface, depth_under_pad(surface, pad, stretch));
    const Wall bound =
        safe_wall(safe.lag, safe.device_damping, {std::numeric_limits<double>::infinity(), wanted.damping});
    const SurfaceSpring safely = no_steeper(surface, pad, bound.stiffness);
    const double depth = depth_under_pad(safely, pad, stretch);
    const double stiffness = wall_of(safely, depth).stiffness;
    const double secant = stretch > 0.0 ? safely.force(depth) / stretch : stiffness;
    return {{stiffness, bound.damping}, wanted.stiffness, secant};
}

// A soft body gives by what its cells do not show as well: a pad whose stiffness grows with the force. Found
// is the s of indentation_at() at which both hold the same force, by halves: each of them only grows.
Pressing press(const Feel& feel, const LocalCompliance& give, double stretch, const SafeWalls& safe) {
    if (give.is_none() || safe.radius <= 0.0 || feel.curve() != nullptr || stretch <= 0.0) {
        return press_surface(feel, stretch, safe);
    }
    const auto force_of = [](const Pressing& pressing, double depth) { return pressing.secant * depth; };
    double low = 0.0;
    double high = std::max(safe.radius, force_of(press_surface(feel, stretch, safe), stretch) /
                                            (4.0 / 3.0 * give.modulus * safe.radius));
    for (int halving = 0; halving < 40; ++halving) {
        const double middle = 0.5 * (low + high);
        const Indentation local = indentation_at(give, safe.radius, middle);
        const double left = stretch - local.depth;
        const bool deeper = left > 0.0 && force_of(press_surface(feel, left, safe), left) > local.force;
        (deeper ? low : high) = middle;
    }
    const Indentation local = indentation_at(give, safe.radius, high);
    const double left = std::max(0.0, stretch - local.depth);
    const Pressing surface = press_surface(feel, left, safe);
    return {under_pad(surface.wall, local.stiffness),
            under_pad({surface.wanted, 0.0}, local.stiffness).stiffness, force_of(surface, left) / stretch};
}

}  // namespace

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
    Vec3 stretch = slide;
    for (const Touch& contact : touching) {
        all_pressure += contact.pressure;
        stretch -= contact.normal * contact.pressure;
    }
    const double stretched = glm::length(stretch);
    for (const Touch& contact : touching) {
        if (force.contact_count == HandForce::max_contacts) {
            break;
        }
        const auto [wall, wanted, secant] =
            press(feel_at(scene, contact), scene.body(contact.body).shape->give, stretched, safe);
        const Vec3 surface_way = way_of_surface(scene, contact);
        const double approach = -glm::dot(hand_velocity - surface_way / seconds, contact.normal);
        const double spring = secant * contact.pressure;
        const double damper = wall.damping * approach;
        const Vec3 held = slide * (contact.pressure / all_pressure);
        ContactForce& part = force.contacts[force.contact_count++];
        part.body = contact.body;
        part.feature = contact.feature;
        part.point = contact.point;
        part.on_hand = contact.force_direction * std::max(0.0, spring + damper) - held * secant;
        part.wall = wall;
        part.wanted_stiffness = wanted;
        force.source += glm::dot(part.on_hand, surface_way);
        force.of_speed += contact.normal * (wall.damping / seconds * glm::dot(surface_way, contact.normal));
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

}  // namespace tactus
