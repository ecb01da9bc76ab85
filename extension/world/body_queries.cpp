#include "world/body_queries.hpp"

#include <glm/geometric.hpp>

namespace tactus {

namespace {

// A ray that has come so near to a surface has met it (unit: meters), and a share of its way for what single
// precision leaves of it.
constexpr double met_within = 1e-6;
constexpr double met_within_share = 1e-7;

// A ray that grazes a surface comes nearer in ever smaller steps.
constexpr int max_steps = 1000;

}  // namespace

BodyPoint nearest_of(const std::vector<QueriedBody>& bodies, const Vec3& point, double max_distance) {
    BodyPoint best;
    best.at.distance = max_distance;
    for (const QueriedBody& body : bodies) {
        const SurfaceHit found = nearest_surface(*body.touch, body.pose, point, best.at.distance);
        if (found.hit) {
            best = {body.index, found};
        }
    }
    return best;
}

// As far as the nearest surface is away, the way is free: steps of that length never pass one.
BodyPoint first_on_way(const std::vector<QueriedBody>& bodies, const Vec3& from, const Vec3& to) {
    const double length = glm::length(to - from);
    const Vec3 direction = length > 0.0 ? (to - from) / length : Vec3(0.0, 0.0, 1.0);
    std::vector<QueriedBody> near;
    for (const QueriedBody& body : bodies) {
        if (may_meet_ray(*body.touch, body.pose, from, direction, length)) {
            near.push_back(body);
        }
    }
    double gone = 0.0;
    for (int step = 0; step < max_steps; ++step) {
        const double enough = met_within + met_within_share * gone;
        BodyPoint found = nearest_of(near, from + gone * direction, length - gone + 2.0 * enough);
        if (!found.at.hit) {
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

std::vector<std::size_t> within(const std::vector<QueriedBody>& bodies, const Vec3& center, double radius) {
    std::vector<std::size_t> found;
    for (const QueriedBody& body : bodies) {
        if (nearest_surface(*body.touch, body.pose, center, radius).hit) {
            found.push_back(body.index);
        }
    }
    return found;
}

std::vector<PlacedTreeBox> tree_boxes(const std::vector<QueriedBody>& bodies, const Vec3& point,
                                      double radius, std::size_t most) {
    std::vector<PlacedTreeBox> found;
    for (const QueriedBody& body : bodies) {
        for (const TouchPart& part : body.touch->parts) {
            if (part.tree() == nullptr || found.size() >= most) {
                continue;
            }
            const Pose pose = compose(body.pose, part.pose);
            std::vector<TreeBox> boxes;
            TreeBoxes::around(*part.tree(), to_local(pose, point), radius, most - found.size(), boxes);
            for (const TreeBox& box : boxes) {
                found.push_back({box, pose});
            }
        }
    }
    return found;
}

}  // namespace tactus
