#include "core/teleop/passive_update.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace tactus {

namespace {

// Of what is no more, the hand is given at most so many times what is.
constexpr double max_over = 2.0;

double stored_in(double force, double stiffness) {
    return 0.5 * force * force / stiffness;
}

// |f| (unit: newtons)
double felt_size(double force, double stiffness, double unpaid, double over) {
    return over * std::sqrt(std::max(0.0, force * force - 2.0 * stiffness * unpaid));
}

// U (unit: joules)
double potential_of(double force, double stiffness, double unpaid, double over) {
    const double stored = stored_in(force, stiffness);
    if (unpaid <= 0.0) {
        return over * stored;
    }
    if (unpaid >= stored) {
        return 0.0;
    }
    const double felt = felt_size(force, stiffness, unpaid, 1.0);
    return 0.5 * force * felt / stiffness -
           unpaid * std::log((force + felt) / std::sqrt(2.0 * stiffness * unpaid));
}

}  // namespace

void PassiveUpdate::changed(const Vec3& before, double k_before, const Vec3& after, double k_after) {
    if (!(k_before > 0.0) || !(k_after > 0.0)) {
        return;
    }
    const double from = glm::length(before), to = glm::length(after);
    const double had = potential_of(from, k_before, unpaid_, over_);
    const double felt = felt_size(from, k_before, unpaid_, over_);
    const double stored = stored_in(to, k_after);
    if (had >= stored) {
        unpaid_ = 0.0;
        over_ = stored > 0.0 ? std::clamp(std::min(felt / to, had / stored), 1.0, max_over) : 1.0;
    } else {
        over_ = 1.0;
        unpaid_ = std::max(0.0, stored - std::min(stored_in(felt, k_after), had));
    }
    pace_ = fading_ = 0.0;
}

Vec3 PassiveUpdate::feel(const PassiveUpdateSettings& settings, const FeltInput& in) {
    const double size = glm::length(in.modelled);
    const bool touches = size > 0.0 && in.stiffness > 0.0;
    // As the hand leaves, what it would not have got back is gone with the touch.
    unpaid_ = touches ? std::min(unpaid_, stored_in(size, in.stiffness)) : 0.0;
    // What the hand has done against the felt force, less what the felt spring holds more and less what was
    // damped, which has paid for what was owed.
    const double taken = -glm::dot(felt_, in.hand_velocity) * in.seconds - std::exchange(damped_, 0.0);
    const double held = touches ? potential_of(size, in.stiffness, unpaid_, over_) : 0.0;
    tank_ = std::clamp(tank_ + taken - (held - potential_), -settings.tank, settings.tank);
    if (!touches) {
        over_ = 1.0;
        owed_ = potential_ = tank_ = 0.0;  // each contact has an account of its own
        return felt_ = in.modelled;
    }
    pay(settings, in);
    potential_ = potential_of(size, in.stiffness, unpaid_, over_);
    const bool as_it_is = unpaid_ == 0.0 && over_ == 1.0;
    felt_ = as_it_is ? in.modelled : in.modelled * (felt_size(size, in.stiffness, unpaid_, over_) / size);
    owed_ = std::max(0.0, owed_);
    if (const double power = glm::dot(felt_, in.hand_velocity); owed_ > 0.0 && power > 0.0) {
        damped_ = std::min(power * in.seconds, owed_);
        const double speed2 = glm::dot(in.hand_velocity, in.hand_velocity);
        felt_ -= in.hand_velocity * (damped_ / (speed2 * in.seconds));
        owed_ -= damped_;
        damped_J_ += damped_;
    }
    return felt_;
}

void PassiveUpdate::pay(const PassiveUpdateSettings& settings, const FeltInput& in) {
    const double size = glm::length(in.modelled), k = in.stiffness;
    const double held = potential_of(size, k, unpaid_, over_);
    fading_ = std::max(fading_, (over_ - 1.0) / settings.take_out);
    over_ = std::max(1.0, over_ - fading_ * in.seconds);
    pace_ = std::max(pace_, unpaid_ / settings.bring_in);
    const double left = std::max(0.0, unpaid_ - pace_ * in.seconds);
    const double cost = potential_of(size, k, left, over_) - held;
    const double funds = std::max(0.0, tank_);
    if (unpaid_ > 0.0 && cost > 0.0) {
        // U is convex in D: of a part of the way, no more than that part of the cost.
        unpaid_ += (left - unpaid_) * std::min(1.0, funds / cost);
    }
    tank_ = std::min(tank_ - (potential_of(size, k, unpaid_, over_) - held), settings.tank);
    const double for_motion = std::clamp(tank_, 0.0, std::max(0.0, owed_));
    owed_ -= for_motion;
    tank_ -= for_motion;
}

}  // namespace tactus
