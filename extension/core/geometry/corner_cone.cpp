#include "core/geometry/corner_cone.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tactus {

CornerCone::CornerCone(const SharedMesh& shared, std::uint32_t vertex) : place_(shared.place(vertex)) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t triangle : shared.triangles_at(vertex)) {
        for (const std::uint32_t other : shared.mesh.triangles[triangle]) {
            if (other != vertex) {
                const Vec3 way = shared.place(other) - place_;
                shortest = std::min(shortest, glm::length(way));
                if (const Vec3 edge = unit(way); std::ranges::find(edges_, edge) == edges_.end()) {
                    edges_.push_back(edge);
                }
            }
        }
    }
    rounding_ = shared.rounding / std::max(shortest, 1e-300);
    for (std::size_t i = 0; i < edges_.size(); ++i) {
        for (std::size_t k = i + 1; k < edges_.size(); ++k) {
            add_perpendicular(edges_[i], edges_[k]);
        }
    }
}

bool CornerCone::may_touch(EmptyBall& ball) {
    if (!(doubt_ <= max_doubt) || !(rounding_ <= max_doubt) || rays_.size() > TouchPatch::max_directions) {
        return true;
    }
    const auto opposite = std::ranges::find_if(
        rays_, [&](const Vec3& ray) { return glm::length(ray + rays_.front()) < parallel_sine; });
    return opposite != rays_.end() ? may_touch_in_plane(rays_.front(), ball) : may_touch_in_cone(ball);
}

void CornerCone::add_perpendicular(const Vec3& e, const Vec3& f) {
    const Vec3 across = glm::cross(e, f);
    if (const double sine = glm::length(across); sine > parallel_sine) {
        add(across / sine, rounding_ / sine);
        add(-across / sine, rounding_ / sine);
    }
}

void CornerCone::add(const Vec3& ray, double doubt) {
    const bool leads_away =
        std::ranges::all_of(edges_, [&](const Vec3& e) { return glm::dot(ray, e) <= parallel_sine; });
    if (leads_away && std::ranges::none_of(rays_, [&](const Vec3& known) {
            return glm::distance(known, ray) < parallel_sine;
        })) {
        rays_.push_back(ray);
        doubt_ = std::max(doubt_, doubt);
    }
}

// All edges lie in one plane. Where they leave an angle of more than half a turn the surface ends, and the
// cone is between its normals and the perpendiculars of both rims; else its faces have said all.
bool CornerCone::may_touch_in_plane(const Vec3& up, EmptyBall& ball) {
    rays_.clear();
    for (const Vec3& edge : edges_) {
        const Vec3 across = unit(glm::cross(up, edge));
        add(across, rounding_);
        add(-across, rounding_);
    }
    if (rays_.empty()) {
        return false;
    }
    const auto touches_on_side = [&](const Vec3& normal) {
        return ball.may_touch({{place_}, 1, {normal, rays_.front(), rays_.back()}, 3, doubt_});
    };
    return rays_.size() > 2 || touches_on_side(up) || touches_on_side(-up);
}

bool CornerCone::may_touch_in_cone(EmptyBall& ball) {
    TouchPatch whole{{place_}, 1, {}, 0, doubt_};
    Vec3 middle(0.0);
    for (const Vec3& ray : rays_) {
        whole.add(ray);
        middle += ray;
    }
    if (rays_.empty() || !ball.may_touch(whole)) {
        return false;
    }
    if (rays_.size() <= 3) {
        return true;
    }
    middle = unit(middle);
    const Vec3 right = unit(rays_.front() - middle * glm::dot(middle, rays_.front()));
    const Vec3 up = glm::cross(middle, right);
    std::ranges::sort(rays_, {},
                      [&](const Vec3& ray) { return std::atan2(glm::dot(ray, up), glm::dot(ray, right)); });
    bool touches = false;
    for (std::size_t i = 0; i < rays_.size() && !touches; ++i) {
        const Vec3& next = rays_[(i + 1) % rays_.size()];
        touches = ball.may_touch({{place_}, 1, {middle, rays_[i], next}, 3, doubt_});
    }
    return touches;
}

}  // namespace tactus
