#include "world/seen_mass.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace tactus {

void SeenMass::note(const Vec3& impulse, const Vec3& change, double told) {
    constexpr double doubt = 1e-3;   // pushes of less tell nothing (unit: meters per second)
    constexpr double notice = 0.02;  // of the factor
    constexpr double least_count = 1.5;
    constexpr double scatter = 0.03;  // about the line, of what such pushes change
    if (glm::length(impulse) < doubt * told) {
        rest_ = change;
        return;
    }
    if (rest_) {
        add(Vec3(0.0), *std::exchange(rest_, std::nullopt));
    }
    add(impulse, change);
    const double weight = doubt * doubt * told * told;
    const double slope = std::max(0.0, of_both_ + weight / told) / (of_impulses_ + weight);
    const double factor = std::clamp(1.0 / std::max(slope * told, 1e-9), least_factor, most_factor);
    const double besides = of_changes_ - slope * of_both_;
    const bool is_line = count_ > least_count && besides < scatter * of_impulses_ / (told * told);
    if (is_line && factor < most_factor && std::abs(factor - factor_) > notice * factor_) {
        factor_ = factor;
    }
}

void SeenMass::add(const Vec3& impulse, const Vec3& change) {
    constexpr double kept = 0.95;  // from one frame to the next
    count_ = kept * count_ + 1.0;
    impulse_ += (impulse - impulse_) / count_;
    change_ += (change - change_) / count_;
    of_impulses_ = kept * of_impulses_ + glm::dot(impulse - impulse_, impulse - impulse_);
    of_both_ = kept * of_both_ + glm::dot(impulse - impulse_, change - change_);
    of_changes_ = kept * of_changes_ + glm::dot(change - change_, change - change_);
}

}  // namespace tactus
