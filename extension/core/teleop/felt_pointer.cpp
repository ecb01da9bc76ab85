#include "core/teleop/felt_pointer.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace tactus {

namespace {

// What is hidden below this is gone (unit: newtons): a thousandth of what is noticed.
constexpr double nothing_hidden = 1e-5;

// The tank gives what it has within this time at the fastest (unit: seconds).
constexpr double tank_reserve = 0.02;

// However wildly a model changes, nothing that is hidden comes faster; with a leap of touch that fades in the
// model meanwhile (fading_force.hpp: 250) still less than half a newton a tick (unit: newtons per second).
constexpr double steepest = 200.0;

// Fading never takes more of what is just noticed.
constexpr double nearly_noticed = 0.95;

}  // namespace

void FeltPointer::hide(const Vec3& before, const Vec3& after) {
    const Vec3 change = before - after;
    hidden_ += change;
    if (state_ == FeltState::letting_go) {
        kept_ += change;
    }
    modelled_before_ = glm::length(after);
    drift_.carried(glm::length(change));
}

void FeltPointer::hide_size(const Vec3& before, const Vec3& after) {
    const double now = glm::length(after);
    const double felt = glm::length(before + hidden_);
    const Vec3 kept = now > 0.0 ? after * (felt / now) : before + hidden_;
    hide(before, after);
    hidden_ = kept - after;
}

Vec3 FeltPointer::feel(const StealthSettings& settings, const FeltInput& in) {
    faded_ = 0.0;
    const double modelled = glm::length(in.modelled);
    const double own_change = glm::distance(in.modelled + hidden_, felt_);
    const double stored = in.stiffness > 0.0 ? 0.5 * modelled * modelled / in.stiffness : 0.0;
    // What was held has acted on the way since.
    const Vec3 way = in.hand_velocity * in.seconds;
    tank_.fill(felt_ - held_hidden_, held_hidden_, way, stored, settings.tank);
    energy_.hidden_J += glm::dot(held_hidden_, way);
    energy_.hand_J += glm::dot(felt_, way);
    if (in.stiffness <= 0.0) {
        tank_.let_go();
    }
    drift_.pass(settings, in.seconds);
    const double whole = glm::length(hidden_);
    if (modelled < modelled_before_) {
        // As the hand moves away and the model's force with it, so does what is hidden.
        hidden_ *= modelled / modelled_before_;
        kept_ *= modelled / modelled_before_;
    }
    const double before = glm::length(hidden_), fallen = whole - before;
    begin_to_let_go(settings, in);
    if (state_ == FeltState::letting_go) {
        hidden_ = left_of_felt(in, own_change);
        state_ = left_ > 0.0 || hidden_ != kept_ ? state_ : FeltState::bridged;
    } else if (hidden_ != Vec3(0.0)) {
        state_ = FeltState::bridged;
        hidden_ = tactus::faded(hidden_, fading(settings, in, fallen));
    }
    if (hidden_ != Vec3(0.0)) {
        if (glm::length(hidden_) < nothing_hidden) {
            hidden_ = Vec3(0.0);
        }
        const Vec3 asked = hidden_;
        hidden_ = tank_.allow(asked, in.hand_velocity, in.seconds, tank_reserve, energy_.damped_J);
        if (state_ == FeltState::letting_go && left_ <= 0.0 && hidden_ != asked) {
            state_ = FeltState::bridged;  // what the tank takes back is not kept
        }
        faded_ = std::abs(before - glm::length(hidden_));
    }
    if (hidden_ == Vec3(0.0) && state_ != FeltState::letting_go) {
        state_ = FeltState::together;
    }
    modelled_before_ = modelled;
    const Vec3 felt = in.modelled + hidden_;
    change_ = felt - std::exchange(felt_, felt);
    held_hidden_ = hidden_;
    energy_.tank_J = tank_.level();
    return felt_;
}

// What was falling already goes on falling at least as fast.
void FeltPointer::begin_to_let_go(const StealthSettings& settings, const FeltInput& in) {
    const bool is_letting_go = state_ == FeltState::letting_go;
    const Vec3& stays = is_letting_go ? kept_ : hidden_;
    const bool too_much = glm::length(stays) > max_hidden(settings, glm::length(in.modelled));
    begins_to_let_go_ = (std::exchange(lets_go_, false) && !is_letting_go) || too_much;
    if (!begins_to_let_go_) {
        return;
    }
    state_ = FeltState::letting_go;
    const double rise = glm::length(in.modelled) - glm::length(felt_);
    left_ = std::max(settings.let_go_seconds, rise / steepest);
    kept_ = Vec3(0.0);
    const Vec3 going = felt_ - in.modelled;
    const double size2 = glm::dot(going, going);
    const double falling = -glm::dot(change_, going);
    if (falling > 0.0) {
        left_ = std::clamp(size2 / falling * in.seconds, in.seconds, left_);
    }
    pace_ = std::sqrt(size2) / left_;
}

// What was felt, as the hand's own way has changed it since, goes over into what is modelled now. What has
// been changed since then is hidden as ever. A model that goes away meanwhile by its own change is not caught
// up with at any price.
Vec3 FeltPointer::left_of_felt(const FeltInput& in, double own_change) {
    const double before = std::exchange(left_, std::max(0.0, left_ - in.seconds));
    const double share = before > 0.0 ? left_ / before : 0.0;
    const double size = glm::length(in.modelled);
    Vec3 hidden = felt_;
    if (size > 0.0) {
        const double leaving = std::max(0.0, glm::dot(in.hand_velocity, in.modelled) / size) * in.seconds;
        const double from = size + in.stiffness * leaving;
        hidden = (felt_ - in.modelled * (from / size)) * (size / from);
    }
    const Vec3 left = kept_ + (hidden - kept_) * share;
    const Vec3 step = in.modelled + left - felt_;
    const double length = glm::length(step);
    const double longest = std::max(own_change + steepest * in.seconds, pace_ * in.seconds);
    return length > longest ? felt_ + step * (longest / length) - in.modelled : left;
}

// How much of what is hidden goes in this tick, besides what has fallen with the model (unit: newtons).
double FeltPointer::fading(const StealthSettings& settings, const FeltInput& in, double fallen) const {
    const double modelled = glm::length(in.modelled);
    const double felt = glm::length(in.modelled + hidden_);
    const double unnoticed = unnoticed_change(settings, felt, in.seconds);
    // Where a model drifts, fading as fast as corrections come changes nothing that can be felt; somewhat
    // faster, so that what has gathered gets less.
    constexpr double catching_up = 1.5;
    // What the hand's own way changes of the force hides some more, all in all still less than is noticed.
    const double masked = settings.masked * std::abs(modelled_before_ - modelled);
    const double most = nearly_noticed * just_noticeable(settings, felt) * in.seconds / settings.window;
    const double drift = std::min(catching_up * drift_.rate(settings), steepest) * in.seconds;
    return std::max(unnoticed, std::min(unnoticed + masked, most)) + std::max(0.0, drift - fallen);
}

void FeltPointer::forget() {
    const EnergyFigures energy = energy_;
    *this = {};
    energy_ = energy;
}

}  // namespace tactus
