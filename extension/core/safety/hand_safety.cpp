#include "core/safety/hand_safety.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <utility>

#include "core/math/body_motion.hpp"

namespace tactus {

namespace {

bool is_number(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Farther, or faster, is no hand's: its squares would not be numbers either (units: meters, meters per
// second).
constexpr double farthest = 1e6;

// A position may stay while the velocity says that the hand has gone so far (unit: meters): far above what an
// encoder resolves, and of a stiff wall a few newtons.
constexpr double longest_stay = 1e-3;

// Slower, it rests: a position that stays is right (unit: meters per second).
constexpr double resting = 1e-3;

bool is_hands(const Vec3& v) {
    return glm::all(glm::lessThanEqual(glm::abs(v), Vec3(farthest)));
}

}  // namespace

HandState HandSafety::state_of(const SafetySettings& settings, const SafetySample& sample) const {
    if (!sample.connected) {
        return HandState::disconnected;
    }
    if (!sample.sound || !is_hands(sample.position) || !is_hands(sample.velocity)) {
        return HandState::no_number;
    }
    const double speed = glm::length(sample.velocity);
    const double way = known_ ? glm::distance(sample.position, position_) : 0.0;
    const double turned =
        known_ ? glm::length(turn_vector(sample.rotation * glm::conjugate(rotation_))) : 0.0;
    if (speed > settings.max_speed || way > settings.max_speed * sample.seconds ||
        turned > settings.max_turn) {
        return HandState::jumped;
    }
    // A hand that stops dead at the speed v has a smoothed velocity for a while: its path is s v to first
    // order, and at most 2 s v by the mean over a window of 2 s.
    if (settings.sees_frozen && stayed_ > longest_stay + 2.0 * settings.velocity_smoothed * stopped_) {
        return HandState::frozen;
    }
    if (!sample.enabled) {
        return HandState::disabled;
    }
    return settings.dead_man == 0 || (sample.buttons & settings.dead_man) != 0 ? HandState::working
                                                                               : HandState::released;
}

SafeForce HandSafety::pass(const SafetySettings& settings, const SafetySample& sample) {
    SafeForce safe;
    const bool stays = known_ && sample.position == position_;
    const double speed = is_hands(sample.velocity) ? glm::length(sample.velocity) : 0.0;
    const bool seems_frozen = stays && speed > resting;
    stayed_ = seems_frozen ? stayed_ + speed * sample.seconds : 0.0;
    stopped_ = seems_frozen ? stopped_ : speed;
    safe.state = state_of(settings, sample);
    const bool was_known = known_;
    known_ = safe.state != HandState::disconnected && safe.state != HandState::no_number;
    if (was_known && known_ && safe.state != HandState::jumped) {
        work_ += glm::dot(given_, sample.position - position_);
    }
    position_ = known_ ? sample.position : position_;
    const Quat before = std::exchange(rotation_, known_ ? sample.rotation : rotation_);
    if (safe.state != HandState::working) {
        const bool known = known_;
        rest();
        known_ = known;
        return safe;
    }
    Vec3 force = sample.wanted;
    if (!is_number(force)) {
        force = Vec3(0.0);
        safe.limited |= hand_limited_command;
    }
    double share = 1.0;
    if (ramped_ < settings.ramp) {
        ramped_ += sample.seconds;
        share = std::min(1.0, ramped_ / settings.ramp);
        safe.state = HandState::ramping;
    }
    force *= share;
    if (settings.passive) {
        const Vec3 wanted = force;
        force = passivity_.pass({sample.position, sample.velocity, settings.damping, settings.max_damping,
                                 sample.source, sample.seconds},
                                wanted);
        safe.limited |= force != wanted ? hand_limited_passivity : 0u;
    }
    bool cut = false;
    safe.force = exit_.leave(settings.limits, force, settings.max_force, sample.velocity, sample.seconds,
                             sample.own_change, cut);
    safe.limited |= cut ? hand_limited_force : 0u;
    passivity_.given(safe.force);
    given_ = safe.force;
    if (settings.max_torque > 0.0) {
        const Vec3 turned = was_known ? turn_vector(sample.rotation * glm::conjugate(before)) : Vec3(0.0);
        safe.torque = torque_of(settings, sample, share, turned / sample.seconds, safe.limited);
    }
    return safe;
}

Vec3 HandSafety::torque_of(const SafetySettings& settings, const SafetySample& sample, double share,
                           const Vec3& spin, std::uint32_t& limited) {
    const bool sound = is_number(sample.torque) && is_hands(spin);
    bool cut = false;
    const Vec3 torque =
        torque_exit_.leave(settings.torque_limits, sound ? sample.torque * share : Vec3(0.0),
                           settings.max_torque, sound ? spin : Vec3(0.0), sample.seconds, 0.0, cut);
    limited |= (cut ? hand_limited_force : 0u) | (sound ? 0u : hand_limited_command);
    return torque;
}

void HandSafety::rest() {
    exit_.rest();
    torque_exit_.rest();
    passivity_.reset();
    given_ = Vec3(0.0);
    ramped_ = 0.0;
    known_ = false;
}

const char* text_of(HandState state) {
    switch (state) {
        case HandState::working:
            return "force is on";
        case HandState::ramping:
            return "the force grows from nothing: wait a moment";
        case HandState::disabled:
            return "the force is off: the clutch is held, or the force was switched off";
        case HandState::released:
            return "the force is off until the device's button is held (dead_man_buttons)";
        case HandState::disconnected:
            return "the device does not answer: check its cable and power; it goes on by itself";
        case HandState::no_number:
            return "the device says what is no place: the force is off until it makes sense again";
        case HandState::jumped:
            return "the hand has jumped farther than a hand can: the force begins anew";
        case HandState::frozen:
            return "the device repeats its position though the hand moves: plug it in again if that lasts";
    }
    return "";
}

}  // namespace tactus
