#include <glm/geometric.hpp>

#include "nodes/body_mirrors.hpp"

namespace tactus {

using namespace godot;

namespace {

// A ray that has come so near to a surface has met it (unit: meters), and a share of its way for what single
// precision leaves of it.
constexpr double met_within = 1e-6;
constexpr double met_within_share = 1e-7;

// A ray that grazes a surface comes nearer in ever smaller steps.
constexpr int max_steps = 1000;

}  // namespace

template <class Use>
void BodyMirrors::for_each_touchable(std::uint32_t mask, Use&& use) const {
    for (const auto& mirror : bodies_) {
        if (mirror->touch() != nullptr && (mirror->layers() & mask) != 0) {
            use(*mirror);
        }
    }
}

BodyPoint BodyMirrors::nearest_of(const std::vector<const BodyMirror*>& bodies, const Vec3& point,
                                  double max_distance) {
    BodyPoint best;
    best.at.distance = max_distance;
    for (const BodyMirror* mirror : bodies) {
        const SurfaceHit found = nearest_surface(*mirror->touch(), mirror->pose(), point, best.at.distance);
        if (found.hit) {
            best = {mirror->body(), found};
        }
    }
    return best;
}

BodyPoint BodyMirrors::nearest(const Vec3& point, double max_distance, std::uint32_t mask) const {
    std::vector<const BodyMirror*> bodies;
    for_each_touchable(mask, [&bodies](const BodyMirror& mirror) { bodies.push_back(&mirror); });
    return nearest_of(bodies, point, max_distance);
}

// As far as the nearest surface is away, the way is free: steps of that length never pass one.
BodyPoint BodyMirrors::first_on_way(const Vec3& from, const Vec3& to, std::uint32_t mask) const {
    const double length = glm::length(to - from);
    const Vec3 direction = length > 0.0 ? (to - from) / length : Vec3(0.0, 0.0, 1.0);
    std::vector<const BodyMirror*> bodies;
    for_each_touchable(mask, [&](const BodyMirror& mirror) {
        if (may_meet_ray(*mirror.touch(), mirror.pose(), from, direction, length)) {
            bodies.push_back(&mirror);
        }
    });
    double gone = 0.0;
    for (int step = 0; step < max_steps; ++step) {
        const double enough = met_within + met_within_share * gone;
        BodyPoint found = nearest_of(bodies, from + gone * direction, length - gone + 2.0 * enough);
        if (found.body == nullptr) {
            return {};
        }
        if (found.at.distance <= enough) {
            found.at.distance = gone;
            return found;
        }
        gone += found.at.distance;
    }
    return {};
}

std::vector<CollisionObject3D*> BodyMirrors::within(const Vec3& center, double radius,
                                                    std::uint32_t mask) const {
    std::vector<CollisionObject3D*> found;
    for_each_touchable(mask, [&](const BodyMirror& mirror) {
        if (nearest_surface(*mirror.touch(), mirror.pose(), center, radius).hit) {
            found.push_back(mirror.body());
        }
    });
    return found;
}

}  // namespace tactus
