#include "shared/stress_judge.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus::shared {

double BodyJudge::look(const Vec3& local, double far) const {
    if (tree_) {
        return tree_->nearest(local, far).distance;
    }
    if (ball_ > 0.0) {
        return glm::length(local) - ball_;
    }
    const Vec3 beyond = glm::abs(local) - half_;
    return glm::length(glm::max(beyond, Vec3(0.0))) + std::min(0.0, std::max({beyond.x, beyond.y, beyond.z}));
}

double BodyJudge::distance(const Vec3& center, double radius) {
    const Vec3 local = to_local(pose_, center);
    const double moved = glm::distance(local, known_at_);
    // Coordinates themselves are only so exact; the skin keeps the proxy well above that.
    const double rounding =
        8.0 * 0x1p-52 *
        ((tree_ ? tree_->magnitude() : 0.0) + glm::length(local) + glm::length(pose_.position));
    constexpr int every = 64;
    if (known_ - moved > radius + rounding) {
        ++spared;
        if (spared % every == 0) {
            bound_faults += look(local, known_) < known_ - moved - rounding;
        }
        return known_ - moved;
    }
    ++looks;
    known_ = look(local, 2.0 * radius);
    known_at_ = local;
    return known_ < radius && known_ >= radius - rounding ? radius : known_;
}

bool BodyJudge::is_penetrated(const Vec3& center, double radius) {
    const bool in = distance(center, radius) < radius;
    excused_ = excused_ && in;
    return in && !excused_;
}

}  // namespace tactus::shared
