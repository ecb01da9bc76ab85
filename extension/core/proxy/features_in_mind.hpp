// Features that count as contacts whatever a search finds: what has held the sphere back or stopped it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "core/haptics/contact.hpp"

namespace tactus {

class FeaturesInMind {
public:
    // A feature that has just held the sphere back or stopped it counts as far above it as the sphere may be:
    // in a groove it is the other wall. The oldest are forgotten for new ones.
    void keep(const FeatureId& feature) {
        if (std::ranges::find(kept(), feature) != kept().end()) {
            return;
        }
        if (kept_count_ == kept_.size()) {
            std::shift_left(kept_.begin(), kept_.end(), 1);
            --kept_count_;
        }
        kept_[kept_count_++] = feature;
    }
    void let_go() { kept_count_ = 0; }

    // What stops the sphere at once, although no contact does, counts until the sphere has moved. False where
    // it did so already.
    bool insist_on(const FeatureId& feature, const Vec3& center) {
        if (center != insisted_at_) {
            insisted_count_ = 0;
            insisted_at_ = center;
        }
        const std::span<const FeatureId> before = insisted_at(center);
        if (before.size() == insisted_.size() || std::ranges::find(before, feature) != before.end()) {
            return false;
        }
        insisted_[insisted_count_++] = feature;
        return true;
    }
    void scene_has_changed() { insisted_count_ = 0; }

    std::span<const FeatureId> kept() const { return {kept_.data(), kept_count_}; }
    std::span<const FeatureId> insisted_at(const Vec3& center) const {
        return {insisted_.data(), center == insisted_at_ ? insisted_count_ : 0};
    }
    int count() const { return static_cast<int>(kept_count_ + insisted_count_); }

private:
    static constexpr std::size_t max_kept = 6;
    static constexpr std::size_t max_insisted = 16;

    std::array<FeatureId, max_kept> kept_{};
    std::size_t kept_count_ = 0;
    std::array<FeatureId, max_insisted> insisted_{};
    std::size_t insisted_count_ = 0;
    Vec3 insisted_at_{0.0};
};

}  // namespace tactus
