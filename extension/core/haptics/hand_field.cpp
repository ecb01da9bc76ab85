#include "core/haptics/hand_field.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/math/shortened.hpp"

namespace tactus {

namespace {

// In no direction is it steeper.
double steepness(const Mat3& slope) {
    return std::sqrt(glm::dot(slope[0], slope[0]) + glm::dot(slope[1], slope[1]) +
                     glm::dot(slope[2], slope[2]));
}

double safe_share(double steepest, double safe) {
    return steepest > safe ? safe / steepest : 1.0;
}

}  // namespace

void HandField::weigh(Nanoseconds now) {
    const double silent = to_seconds(now - since_);
    const double left = std::clamp(2.0 - silent / to_seconds(lives), 0.0, 1.0);
    const double gone_over = std::clamp(silent / to_seconds(over_), 0.0, 1.0);
    of_last_ = left * gone_over;
    of_before_ = left * (1.0 - gone_over);
}

// What is between two moments is one itself: both are linear in place and velocity.
void HandField::take(Nanoseconds now) {
    FieldMoment between;
    between.place = next_.place;
    between.velocity = next_.velocity;
    if (over_ == 0) {
        over_ = longest_over;
    } else {
        weigh(now);
        between.force = felt({next_.place, next_.velocity});
        between.by_place = before_.by_place * of_before_ + last_.by_place * of_last_;
        between.by_velocity = before_.by_velocity * of_before_ + last_.by_velocity * of_last_;
        over_ = std::clamp(now - since_, shortest_over, longest_over);
    }
    since_ = now;
    before_ = between;
    last_ = next_;
    is_new_ = false;
}

Wall HandField::begin_tick(Nanoseconds now) {
    if (is_new_) {
        take(now);
    }
    if (over_ == 0) {
        return {};
    }
    weigh(now);
    steepest_ = {of_before_ * steepness(before_.by_place) + of_last_ * steepness(last_.by_place),
                 of_before_ * steepness(before_.by_velocity) + of_last_ * steepness(last_.by_velocity)};
    return steepest_;
}

Vec3 HandField::force(const HandMotion& hand, const Wall& safe) {
    if (over_ == 0) {
        return Vec3(0.0);
    }
    stiff_share_ = safe_share(steepest_.stiffness, safe.stiffness);
    damped_share_ = safe_share(steepest_.damping, safe.damping);
    return felt(hand);
}

Vec3 HandField::felt(const HandMotion& hand) const {
    const auto of = [&](const FieldMoment& moment) {
        return moment.force +
               stiff_share_ * (moment.by_place * shortened(hand.position - moment.place, reach)) +
               damped_share_ * (moment.by_velocity * shortened(hand.velocity - moment.velocity, speed_reach));
    };
    return of_before_ * of(before_) + of_last_ * of(last_);
}

}  // namespace tactus
