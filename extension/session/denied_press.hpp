// How hard an operator's hand may press at the teleoperator where its device is not given the force that it
// presses with: stopped, ramping up, limited in slew, energy or power, or hidden as a correction. It is
// `allowed` more than what is displayed. What the largest force of a device, passivity and a leap of touch
// take from a force is taken from what the hand shall feel, and does not count. A correction hides forces all
// the time: one that is told within `patience` does not count either, else the far body would be pushed less
// than the operator pushes it, and the model would be wrong for being hidden.
//
// With a model the hand is sent nearer to its proxy, as far as that force. Without one the operator does not
// know how deep it is: the sample's force, which means nothing else there, is the bound. Plain values.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <optional>

#include "core/teleop/passivity.hpp"
#include "session/press_limit.hpp"

namespace tactus {

class DeniedPress {
public:
    static constexpr double allowed = 1.0;   // (unit: newtons)
    static constexpr double patience = 0.5;  // (unit: seconds)

    struct In {
        double pressed = 0.0;  // that the hand presses with (unit: newtons), >= 0
        double wanted = 0.0;   // of it, for the device (unit: newtons), >= 0
        double shown = 0.0;    // what corrections leave of that (unit: newtons), >= 0
        double given = 0.0;    // to the device (unit: newtons), >= 0
        double seconds = 0.001;
    };

    // Once a tick. It changes as the force of a hand that goes or comes.
    void step(const In& in) {
        const double change = PressLimit::slow_rate * in.seconds;
        const double least = (is_denied_ ? 0.5 : 1.0) * allowed;
        hidden_for_ = in.wanted - in.shown > least ? hidden_for_ + in.seconds : 0.0;
        is_denied_ = (hidden_for_ > patience ? in.wanted : in.shown) - in.given > least;
        if (is_denied_) {
            most_ = std::max(in.given + allowed, std::min(most_, in.pressed) - change);
        } else {
            most_ = binds_ ? most_ + change : in.pressed;
        }
        binds_ = most_ < in.pressed || is_denied_;
        most_ = binds_ ? most_ : in.pressed;
        share_ = most_ < in.pressed ? most_ / in.pressed : 1.0;
    }

    bool binds() const { return binds_; }
    double most() const { return most_; }    // (unit: newtons)
    double share() const { return share_; }  // of `pressed`

private:
    bool is_denied_ = false, binds_ = false;
    double most_ = 0.0, share_ = 1.0;
    double hidden_for_ = 0.0;  // (unit: seconds)
};

// The hand with this share of its depth, along the force on it.
inline Vec3 nearer(const Vec3& hand, const Vec3& proxy, const Vec3& force, double share) {
    const double size = glm::length(force);
    const Vec3 out = size > 0.0 ? force / size : Vec3(0.0);
    return hand + out * ((1.0 - share) * std::max(0.0, glm::dot(proxy - hand, out)));
}

// At the teleoperator: how hard the operator's hand presses, or may press, by the force of its sample (unit:
// newtons). Empty: it is not known.
inline std::optional<double> known_press(bool traditional, Passivity passivity, const Vec3& force) {
    const bool is_known = !traditional || (passivity == Passivity::none && force != Vec3(0.0));
    return is_known ? std::optional(glm::length(force)) : std::nullopt;
}

}  // namespace tactus
