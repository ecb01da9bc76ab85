#include "core/haptics/hand_field.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/math/shortened.hpp"

namespace tactus {

namespace {

// In no direction is it steeper.
double steepness(const Mat3& slope) {
    return std::sqrt(glm::dot(slope[0], slope[0]) + glm::dot(slope[1], slope[1]) +
                     glm::dot(slope[2], slope[2]));
}

// What of it is not along that direction.
Mat3 across(const Mat3& slope, const Vec3& direction) {
    return slope - glm::outerProduct(slope * direction, direction);
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

HandField::Model HandField::model_of(const FieldMoment& told) {
    Model model;
    model.place = told.place;
    model.velocity = told.velocity;
    model.across = across(told.by_place, told.line.direction);
    model.by_velocity = told.by_velocity;
    model.moving = told.by_velocity * shortened(told.velocity, speed_reach);
    model.line =
        told.line.count > 0 ? FieldProfile(told.place, told.line) : FieldProfile(told.place, told.force);
    return model;
}

// What is felt at this moment, as a model: at the places of the next one's line.
HandField::Model HandField::felt_now(const Model& next) const {
    Model now = next;
    now.line.resample([&](const Vec3& place) { return felt({place, next.velocity}); });
    now.across = across(before_.across * of_before_ + last_.across * of_last_, next.line.direction());
    now.by_velocity = before_.by_velocity * of_before_ + last_.by_velocity * of_last_;
    return now;
}

void HandField::take(Nanoseconds now, double strongest) {
    Model next = model_of(next_);
    const bool begins = over_ == 0 || now - since_ >= 2 * lives;
    next.line.make_safe(safe_stiffness_, strongest, last_.line);
    if (begins) {
        began_ = now;
        before_ = last_ = Model{};
        of_before_ = of_last_ = 0.0;
        hand_.reset();
    } else {
        weigh(now);
    }
    // A force that grows from nothing is not yet that of the script.
    is_whole_ = now - began_ > 2 * longest_over;
    account(next);
    before_ = felt_now(next);
    over_ = now == began_ ? longest_over : std::clamp(now - since_, shortest_over, longest_over);
    last_ = next;
    since_ = now;
    is_new_ = false;
}

Wall HandField::begin_tick(Nanoseconds now, double strongest) {
    if (is_new_) {
        take(now, strongest);
    }
    if (over_ == 0) {
        is_limited_ = false;
        return {};
    }
    weigh(now);
    const auto stiffness = [](const Model& model) {
        return std::hypot(model.line.steepest(), steepness(model.across));
    };
    steepest_ = {of_before_ * stiffness(before_) + of_last_ * stiffness(last_),
                 of_before_ * steepness(before_.by_velocity) + of_last_ * steepness(last_.by_velocity)};
    return {std::min(steepest_.stiffness, stiffest), steepest_.damping};
}

// Of the force itself, at rest (unit: joules).
double HandField::work(const Model& model, const Vec3& from, const Vec3& to) const {
    const FieldProfile& line = model.line;
    const double begin = line.along(from), end = line.along(to);
    const Vec3 beside = model.across * line.across(from), beyond = model.across * line.across(to);
    const Vec3 aside = line.across(to) - line.across(from);
    return glm::dot(line.direction(), line.integral(end) - line.integral(begin)) +
           0.5 * glm::dot(line.force(begin) + line.force(end), aside) +
           glm::dot(0.5 * (beside + beyond) - model.moving, to - from);
}

// W reaches to where the newest moment was told, the hand has gone on since.
void HandField::account(const Model& next) {
    if (!hand_) {
        return;
    }
    const double due = work(next, next.place, *hand_);
    const double done = 0.5 * (work(last_, last_.place, next.place) + work(next, last_.place, next.place));
    balance_ = is_whole_ ? std::max(balance_ - done, due - tolerated) : due;
}

void HandField::observe(const Vec3& place) {
    if (hand_ && glm::distance(place, *hand_) < reach) {
        balance_ += glm::dot(given_, place - *hand_);
        excess_ = is_whole_ ? std::max(0.0, balance_ - work(last_, last_.place, place) - tolerated) : 0.0;
    } else {
        balance_ = work(last_, last_.place, place);
        excess_ = 0.0;
    }
    hand_ = place;
}

// How little is known of the force there, from 0 to 1: it is rough, and the hand has got about as far as it
// was looked at closely, since the next moment is late.
double HandField::unknown(const Vec3& place) const {
    constexpr double known = 0.6;  // share of FieldLine::near
    if (!last_.line.is_weaker()) {
        return 0.0;
    }
    const double gone = std::abs(last_.line.along(place)) / last_.line.near();
    return std::clamp((gone - known) / (1.0 - known), 0.0, 1.0);
}

// What it takes is known when the hand has gone: nothing at rest.
Vec3 HandField::damper(const HandMotion& hand, double most_damping) {
    constexpr double smoothed = 0.2;  // share of a change that comes in a tick
    const double squared = glm::dot(hand.velocity, hand.velocity);
    const double power = excess_ / taken_back_within;
    const double most = excess_ > 0.0 ? most_damping : 0.0;
    const double wanted = std::min(most, power / std::max(squared, 1e-12));
    damping_ += smoothed * (std::max(wanted, most_damping * unknown(hand.position)) - damping_);
    return -damping_ * hand.velocity;
}

Vec3 HandField::force(const HandMotion& hand, const Wall& safe, double most_damping) {
    if (over_ == 0) {
        return Vec3(0.0);
    }
    is_limited_ = steepest_.stiffness > safe.stiffness || steepest_.damping > safe.damping;
    // What is safe of a weaker field than the device bears is not known: all of that is.
    const double used = is_limited_ ? safe.stiffness : std::max(safe_stiffness_, safe.stiffness);
    safe_stiffness_ = std::clamp(used, 1.0, stiffest);
    across_share_ = safe_share(of_before_ * steepness(before_.across) + of_last_ * steepness(last_.across),
                               safe.stiffness);
    damped_share_ = safe_share(steepest_.damping, safe.damping);
    observe(hand.position);
    given_ = felt(hand) + damper(hand, most_damping);
    is_limited_ = is_limited_ || excess_ > 0.0;
    return given_;
}

Vec3 HandField::felt(const Model& model, const HandMotion& hand) const {
    // Beside the line it is believed no farther than the hand is expected, where there is a line.
    const double near = model.line.near();
    const Vec3 beside = shortened(model.line.across(hand.position), near > 0.0 ? near : reach);
    return model.line.rendered(model.line.along(hand.position)) + across_share_ * (model.across * beside) +
           damped_share_ * (model.by_velocity * shortened(hand.velocity - model.velocity, speed_reach));
}

Vec3 HandField::felt(const HandMotion& hand) const {
    return of_before_ * felt(before_, hand) + of_last_ * felt(last_, hand);
}

}  // namespace tactus
