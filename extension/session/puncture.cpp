#include "session/puncture.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/haptics/surface_way.hpp"

namespace tactus {

namespace {

bool is_felt_within(const TouchMaterial& material) {
    return material.shaft_friction > 0.0 || material.viscosity > 0.0;
}

bool is_broken_into(const TouchScene& scene, const PassedBodies::Passed& passed) {
    return passed.reason == PassedBecause::broken && scene.body(passed.body).shape &&
           is_felt_within(scene.body(passed.body).material);
}

// Of what surrounds the shaft, at the place of the hand.
Touch place_in(const PassedBodies::Passed& passed, const Vec3& hand) {
    Touch place;
    place.body = passed.body;
    place.point = hand;
    return place;
}

}  // namespace

Wall Punctures::steepest(const TouchScene& scene, Bodies passed) {
    Wall all;
    for (const PassedBodies::Passed& one : passed) {
        if (is_broken_into(scene, one)) {
            const TouchMaterial& material = scene.body(one.body).material;
            all.stiffness += material.shaft_friction > 0.0 ? material.stiffness : 0.0;
            all.damping += material.viscosity;
        }
    }
    return all;
}

Punctures::Shaft Punctures::shaft_of(const TouchBody& body, const PassedBodies::Passed& passed,
                                     const Vec3& hand) const {
    const auto known = std::span(shafts_).first(count_);
    const auto found = std::ranges::find(known, passed.body, &Shaft::body);
    return found != known.end() ? *found : Shaft{passed.body, to_local(body.pose, hand)};
}

void Punctures::tick(const TouchScene& scene, Bodies passed, const HandMotion& hand, double share,
                     double seconds) {
    std::array<Shaft, most> shafts;
    std::size_t count = 0;
    force_count_ = 0;
    for (const PassedBodies::Passed& one : passed) {
        if (!is_broken_into(scene, one)) {
            continue;
        }
        const TouchBody& body = scene.body(one.body);
        const TouchMaterial& material = body.material;
        const Vec3 here = to_local(body.pose, hand.position);
        const double depth = std::max(0.0, glm::dot(one.broken.point - here, one.broken.normal));
        Shaft shaft = shaft_of(body, one, hand.position);
        const double stiffness = share * material.stiffness;
        const double bears = material.shaft_friction * depth;
        const Vec3 stretched = here - shaft.anchor;
        const double longest = stiffness > 0.0 ? bears / stiffness : 0.0;
        if (const double length = glm::length(stretched); length > longest) {
            shaft.anchor = here - stretched * (longest / length);
        }
        const Vec3 way = way_of_surface(scene, place_in(one, hand.position));
        const Vec3 held = direction_to_parent(body.pose, (shaft.anchor - here) * stiffness);
        const Vec3 drag = (hand.velocity - way / seconds) * (share * material.viscosity);
        shafts[count++] = shaft;
        forces_[force_count_++] = {one.body, hand.position, depth > 0.0 ? held - drag : Vec3(0.0)};
    }
    shafts_ = shafts;
    count_ = count;
}

Vec3 Punctures::total() const {
    Vec3 total(0.0);
    for (const ShaftForce& force : forces()) {
        total += force.on_hand;
    }
    return total;
}

}  // namespace tactus
