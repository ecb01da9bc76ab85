#include "core/geometry/empty_ball.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// A ball that holds a point by less than this share of its radius may hold none but for rounding.
constexpr double margin = 1e-6;
// Balls looked at for one patch. Where so many do not tell, it counts as one that can be touched.
constexpr int max_looks = 48;
// A look that takes more (see WorkBudget) goes by what it has found.
constexpr std::int64_t work_a_look = 2'000;
// What is nearer to the centre than this share of the radius lies in the balls around as well as the nearest.
constexpr double deep_enough = 0.99;
// Patches are not cut finer than that (of the radius, and radians).
constexpr double finest = 1e-4;

struct Farthest {
    double distance = 0.0;
    std::size_t first = 0, second = 0;
};

template <std::size_t N>
Farthest farthest_two(const std::array<Vec3, N>& points, int count) {
    Farthest farthest;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        for (std::size_t k = i + 1; k < static_cast<std::size_t>(count); ++k) {
            if (const double apart = glm::distance(points[i], points[k]); apart > farthest.distance) {
                farthest = {apart, i, k};
            }
        }
    }
    return farthest;
}

template <std::size_t N>
Vec3 sum_of(const std::array<Vec3, N>& vectors, int count) {
    Vec3 sum(0.0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        sum += vectors[i];
    }
    return sum;
}

}  // namespace

bool EmptyBall::may_touch(const TouchPatch& patch) {
    int looks = max_looks;
    return !holds_some(patch, looks);
}

bool EmptyBall::is_in_all(const Vec3& point, const TouchPatch& patch) const {
    for (std::size_t i = 0; i < static_cast<std::size_t>(patch.place_count); ++i) {
        const Vec3 way = point - patch.places[i];
        const double squared = glm::dot(way, way);
        const double least =
            squared * (1.0 + margin) / (2.0 * radius_) + patch.doubt * std::sqrt(squared) + rounding_;
        for (std::size_t k = 0; k < static_cast<std::size_t>(patch.direction_count); ++k) {
            if (!(glm::dot(patch.directions[k], way) > least)) {
                return false;
            }
        }
    }
    return true;
}

bool EmptyBall::find_inside(const Vec3& center, Vec3& point) {
    const double far = radius_ * (1.0 - margin);
    WorkBudget work(work_a_look);
    const NearestTriangle nearest = tree_.nearest(center, far, work, deep_enough * radius_);
    work_ += work_a_look - work.left();
    if (!(nearest.distance < far)) {
        return false;
    }
    const PackOffset offset = tree_.offset_from_pack(nearest.pack, splat(center));
    point = center - lane(offset.offset, lane_of_smallest(offset.squared));
    return true;
}

void EmptyBall::remember(const Vec3& point) {
    const auto known = found_.begin() + static_cast<std::ptrdiff_t>(found_count_);
    if (std::any_of(found_.begin(), known,
                    [&](const Vec3& other) { return glm::distance(other, point) <= rounding_; })) {
        return;
    }
    found_[next_] = point;
    next_ = (next_ + 1) % found_.size();
    found_count_ = std::max(found_count_, next_ == 0 ? found_.size() : next_);
}

bool EmptyBall::holds_some(const TouchPatch& patch, int& looks) {
    const auto known = found_.begin() + static_cast<std::ptrdiff_t>(found_count_);
    if (std::any_of(found_.begin(), known, [&](const Vec3& point) { return is_in_all(point, patch); })) {
        return true;
    }
    const Vec3 direction = sum_of(patch.directions, patch.direction_count);
    const double length = glm::length(direction);
    if (--looks < 0 || !(length > 1e-9)) {
        return false;
    }
    const Vec3 middle = sum_of(patch.places, patch.place_count) / static_cast<double>(patch.place_count);
    Vec3 inside;
    if (!find_inside(middle + direction * (radius_ / length), inside)) {
        return false;
    }
    remember(inside);
    TouchPatch first = patch;
    TouchPatch second = patch;
    return is_in_all(inside, patch) ||
           (cut(patch, first, second) && holds_some(first, looks) && holds_some(second, looks));
}

// Across what makes f differ most: a turn by a makes up to a |q - p|, a way of w up to w / R |q - p|. A cone
// of more than three directions is cut by who made it.
bool EmptyBall::cut(const TouchPatch& patch, TouchPatch& first, TouchPatch& second) const {
    const Farthest way = farthest_two(patch.places, patch.place_count);
    const Farthest turn = farthest_two(patch.directions, patch.direction_count);
    if (turn.distance * radius_ > way.distance) {
        const Vec3 sum = patch.directions[turn.first] + patch.directions[turn.second];
        const double length = glm::length(sum);
        if (patch.direction_count > 3 || turn.distance < finest || !(length > 1e-6)) {
            return false;
        }
        first.directions[turn.first] = second.directions[turn.second] = sum / length;
        return true;
    }
    first.places[way.first] = second.places[way.second] =
        0.5 * (patch.places[way.first] + patch.places[way.second]);
    return way.distance >= finest * radius_;
}

}  // namespace tactus
