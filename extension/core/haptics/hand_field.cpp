#include "core/haptics/hand_field.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/math/shortened.hpp"

namespace tactus {

namespace {

// Smaller leaps, and smaller differences, are not seen as such (unit: newtons).
constexpr double smallest_leap = 0.1;

// In no direction is it steeper.
double steepness(const Mat3& slope) {
    return std::sqrt(glm::dot(slope[0], slope[0]) + glm::dot(slope[1], slope[1]) +
                     glm::dot(slope[2], slope[2]));
}

// What of the force does not come from the hand's velocity.
Vec3 at_rest(const FieldMoment& told) {
    return told.force - told.by_velocity * shortened(told.velocity, HandField::speed_reach);
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

// What is between two models is taken for linear in place and velocity, where the hand is.
void HandField::take(Nanoseconds now) {
    const Model model = over_ > 0 && now - since_ < 2 * lives ? fitted(next_) : Model{next_, {}};
    Model between;
    between.moment.place = next_.place;
    between.moment.velocity = next_.velocity;
    began_ = over_ == 0 || now - since_ >= 2 * lives ? now : began_;
    // A force that grows from nothing is not yet that of the script.
    if (now - began_ > 2 * longest_over) {
        account();
    } else {
        hand_.reset();
    }
    if (over_ == 0) {
        over_ = longest_over;
    } else {
        weigh(now);
        between.moment.force = felt({next_.place, next_.velocity});
        between.moment.by_place =
            slope(before_, next_.place) * of_before_ + slope(last_, next_.place) * of_last_;
        between.moment.by_velocity =
            before_.moment.by_velocity * of_before_ + last_.moment.by_velocity * of_last_;
        over_ = std::clamp(now - since_, shortest_over, longest_over);
    }
    since_ = now;
    before_ = between;
    last_ = model;
    told_ = next_;
    is_new_ = false;
}

// A force that rises against the hand's way, more steeply than is safe, is that of a border. Where it rises
// so everywhere it is that of a spring: its change is felt as far as it is safe.
HandField::Model HandField::fitted(const FieldMoment& told) const {
    Model model{told, {}};
    if (last_.border) {
        model.border = goes_on(*last_.border, told);
        return model;
    }
    const Vec3 moved = told.place - told_.place;
    const Vec3 change = at_rest(told) - at_rest(told_);
    const Vec3 by_slope = told.by_place * moved;
    if (steepness(told.by_place) > safe_stiffness_ && glm::dot(by_slope, moved) <= 0.0) {
        const Vec3 besides = change - by_slope;
        if (glm::length(besides) < 0.3 * glm::length(by_slope) + 2.0 * smallest_leap) {
            model.moment.force = felt(last_, {told.place, told.velocity}) + besides;
            return model;
        }
    }
    const double size = glm::length(change);
    const double against = -glm::dot(change, moved);
    if (size > smallest_leap && against > 0.0 && size * size > safe_stiffness_ * against) {
        const Vec3 normal = change / -size;
        model.border = Border{normal, at_rest(told_), at_rest(told), glm::dot(normal, told_.place),
                              glm::dot(normal, told.place)};
    }
    return model;
}

// The border, as far as what is told now fits it, and nearer to where it is; else none.
std::optional<HandField::Border> HandField::goes_on(Border border, const FieldMoment& told) {
    const Vec3 force = at_rest(told);
    const Vec3 leap = border.above - border.below;
    const double size = glm::length(leap);
    const double at = glm::dot(border.normal, told.place);
    const double share = glm::dot(force - border.below, leap) / (size * size);
    const double off = 0.1 + 0.5 * smallest_leap / size;  // share of the leap
    if (glm::distance(force, border.below + share * leap) > off * size) {
        return std::nullopt;
    }
    if (std::abs(share) < off && at <= border.to) {
        border.from = std::max(border.from, at);
    } else if (std::abs(share - 1.0) < off && at >= border.from) {
        border.to = std::min(border.to, at);
    } else if (share > 0.0 && share < 1.0 && at > border.from && at < border.to) {
        // It goes over through here.
        if (share * (border.to - border.from) < at - border.from) {
            border.from = (at - share * border.to) / (1.0 - share);
        } else {
            border.to = border.from + (at - border.from) / share;
        }
    } else if (share >= 1.0 && at >= border.to) {
        border.above = force;
        border.to = at;
    } else if (share <= 0.0 && at <= border.from) {
        border.below = force;
        border.from = at;
    } else {
        return std::nullopt;
    }
    return border;
}

double HandField::width(const Border& border) const {
    const double safe = glm::distance(border.above, border.below) / std::max(safe_stiffness_, 1.0);
    return std::max(border.to - border.from, safe);
}

Mat3 HandField::slope(const Model& model, const Vec3& place) const {
    if (!model.border) {
        return model.moment.by_place;
    }
    const Border& border = *model.border;
    const double off = glm::dot(border.normal, place) - 0.5 * (border.from + border.to);
    const double wide = width(border);
    return std::abs(off) < 0.5 * wide ? glm::outerProduct((border.above - border.below) / wide, border.normal)
                                      : Mat3(0.0);
}

Wall HandField::begin_tick(Nanoseconds now) {
    if (is_new_) {
        take(now);
    }
    if (over_ == 0) {
        is_limited_ = false;
        return {};
    }
    weigh(now);
    const auto stiffness = [](const Model& model) {
        if (!model.border) {
            return steepness(model.moment.by_place);
        }
        const double wide = std::max(model.border->to - model.border->from, 1e-9);
        return glm::distance(model.border->above, model.border->below) / wide;
    };
    steepest_ = {
        of_before_ * stiffness(before_) + of_last_ * stiffness(last_),
        of_before_ * steepness(before_.moment.by_velocity) + of_last_ * steepness(last_.moment.by_velocity)};
    return {std::min(steepest_.stiffness, stiffest), steepest_.damping};
}

// W reaches to where the newest moment was told, the hand has gone on since.
void HandField::account() {
    const Vec3 force = at_rest(next_);
    balance_ -= 0.5 * glm::dot(at_rest(told_) + force, next_.place - told_.place);
    if (hand_) {
        const double ahead = glm::dot(force, *hand_ - next_.place);
        balance_ = std::max(balance_, ahead - tolerated);
        excess_ = std::max(0.0, balance_ - ahead - tolerated);
    }
}

// Over a tick a force that is held is worth its mean: what holding adds, the device's damping takes
// (core/safety/stiffness_limit.hpp).
void HandField::observe(const Vec3& place) {
    const Vec3 given = felt({place, Vec3(0.0)});
    if (hand_) {
        const Vec3 way = place - *hand_;
        balance_ += glm::dot(0.5 * (given_ + given) + damped_, way);
        excess_ = std::max(0.0, excess_ + glm::dot(damped_, way));
    } else {
        balance_ = glm::dot(at_rest(told_), place - told_.place);
        excess_ = 0.0;
    }
    hand_ = place;
    given_ = given;
}

// What it takes is known when the hand has gone: nothing at rest.
Vec3 HandField::damper(const Vec3& velocity, double most_damping) {
    constexpr double smoothed = 0.2;  // share of a change that comes in a tick
    const double squared = glm::dot(velocity, velocity);
    const double power = excess_ / taken_back_within;
    const double most = excess_ > 0.0 ? most_damping : 0.0;
    damping_ += smoothed * (std::min(most, power / std::max(squared, 1e-12)) - damping_);
    return -damping_ * velocity;
}

Vec3 HandField::force(const HandMotion& hand, const Wall& safe, double most_damping) {
    if (over_ == 0) {
        return Vec3(0.0);
    }
    is_limited_ = steepest_.stiffness > safe.stiffness || steepest_.damping > safe.damping;
    // What is safe of a weaker field than the device bears is not known: all of that is.
    safe_stiffness_ = is_limited_ ? safe.stiffness : std::max(safe_stiffness_, safe.stiffness);
    stiff_share_ = safe_share(of_before_ * steepness(before_.moment.by_place) +
                                  (last_.border ? 0.0 : of_last_ * steepness(last_.moment.by_place)),
                              safe.stiffness);
    damped_share_ = safe_share(steepest_.damping, safe.damping);
    observe(hand.position);
    damped_ = damper(hand.velocity, most_damping);
    is_limited_ = is_limited_ || excess_ > 0.0;
    return felt(hand) + damped_;
}

Vec3 HandField::felt(const Model& model, const HandMotion& hand) const {
    const FieldMoment& moment = model.moment;
    if (!model.border) {
        return moment.force +
               stiff_share_ * (moment.by_place * shortened(hand.position - moment.place, reach)) +
               damped_share_ * (moment.by_velocity * shortened(hand.velocity - moment.velocity, speed_reach));
    }
    const Border& border = *model.border;
    const double off = glm::dot(border.normal, hand.position) - 0.5 * (border.from + border.to);
    const double share = std::clamp(off / width(border) + 0.5, 0.0, 1.0);
    return border.below + share * (border.above - border.below) +
           damped_share_ * (moment.by_velocity * shortened(hand.velocity, speed_reach));
}

Vec3 HandField::felt(const HandMotion& hand) const {
    return of_before_ * felt(before_, hand) + of_last_ * felt(last_, hand);
}

}  // namespace tactus
