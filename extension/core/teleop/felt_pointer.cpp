#include "core/teleop/felt_pointer.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// What is hidden below this is gone (unit: newtons): a thousandth of what is noticed.
constexpr double nothing_hidden = 1e-5;

// The tank gives what it has within this time at the fastest (unit: seconds).
constexpr double tank_reserve = 0.02;

// Fading never takes more of what is just noticed.
constexpr double nearly_noticed = 0.95;

}  // namespace

void FeltPointer::hide(const Vec3& before, const Vec3& after) {
    const Vec3 change = before - after;
    hidden_ += change;
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
    begins_to_let_go_ = false;
    faded_ = 0.0;
    const double modelled = glm::length(in.modelled);
    const double stored = in.stiffness > 0.0 ? 0.5 * modelled * modelled / in.stiffness : 0.0;
    tank_.fill(in.modelled, in.hand_velocity, stored, in.seconds, settings.tank);
    if (in.stiffness <= 0.0) {
        tank_.let_go();
    }
    drift_.pass(settings, in.seconds);
    if (modelled < modelled_before_) {
        // As the hand moves away and the model's force with it, so does what is hidden.
        hidden_ *= modelled / modelled_before_;
    }
    if (hidden_ != Vec3(0.0)) {
        const double most = fading(settings, in, glm::length(in.modelled + hidden_));
        const double before = glm::length(hidden_);
        hidden_ = tactus::faded(hidden_, most);
        if (glm::length(hidden_) < nothing_hidden) {
            hidden_ = Vec3(0.0);
        }
        hidden_ =
            tank_.allow(hidden_, in.hand_velocity, in.seconds, tank_reserve, settings.tank, energy_.damped_J);
        faded_ = std::abs(before - glm::length(hidden_));
    }
    if (hidden_ == Vec3(0.0)) {
        state_ = FeltState::together;
    }
    modelled_before_ = modelled;
    const Vec3 felt = in.modelled + hidden_;
    energy_.tank_J = tank_.level();
    energy_.hidden_J += glm::dot(hidden_, in.hand_velocity) * in.seconds;
    energy_.hand_J += glm::dot(felt, in.hand_velocity) * in.seconds;
    return felt;
}

// How much of what is hidden goes in this tick (unit: newtons).
double FeltPointer::fading(const StealthSettings& settings, const FeltInput& in, double felt) {
    const double size = glm::length(hidden_);
    const double modelled = glm::length(in.modelled);
    const double unnoticed = unnoticed_change(settings, felt, in.seconds);
    // No more is hidden than is felt: it would be a force of its own.
    const double bound = std::max(just_noticeable(settings, modelled), settings.bound * modelled);
    if (size > bound || state_ == FeltState::letting_go) {
        if (state_ != FeltState::letting_go) {
            state_ = FeltState::letting_go;
            begins_to_let_go_ = true;
            letting_go_rate_ = 0.0;
        }
        letting_go_rate_ = std::max(letting_go_rate_, size / settings.let_go_seconds);
        return std::max(unnoticed, letting_go_rate_ * in.seconds);
    }
    state_ = FeltState::bridged;
    // Where a model drifts, fading as fast as corrections come changes nothing that can be felt; somewhat
    // faster, so that what has gathered gets less.
    constexpr double catching_up = 1.5;
    // What the hand's own way changes of the force hides some more, all in all still less than is noticed.
    const double masked = settings.masked * std::abs(modelled_before_ - modelled);
    const double most = nearly_noticed * just_noticeable(settings, felt) * in.seconds / settings.window;
    return std::max(unnoticed, std::min(unnoticed + masked, most)) +
           catching_up * drift_.rate(settings) * in.seconds;
}

void FeltPointer::forget() {
    const EnergyFigures energy = energy_;
    *this = {};
    energy_ = energy;
}

}  // namespace tactus
