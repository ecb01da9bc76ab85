#include "core/teleop/passivity.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/math/shortened.hpp"

namespace tactus {

namespace {

// Below this nothing moves or presses: nothing can be damped or yielded to (units: m^2/s^2, N^2).
constexpr double nothing = 1e-12;

// Forces and positions are rounded on their way: of the work that they tell of, so much has been done.
constexpr double surely_taken = 1.0 - 1e-4;

// Between two samples a force is held so long at most (unit: samples).
constexpr double longest_held = 4.0;

constexpr double two_pi = 6.28318530717958648;

}  // namespace

const OperatorPassivity::Past* OperatorPassivity::past(std::uint64_t sample) const {
    const Past& found = past_[sample % samples];
    return sample != 0 && found.sample == sample ? &found : nullptr;
}

void OperatorPassivity::rest(Passivity scheme, const PassivitySettings& settings, const In& in) {
    if (now_.begun) {
        now_ = {};
        for (Past& one : past_) {
            one.sample = 0;
        }
    }
    const bool has_waves = scheme == Passivity::wave_variables && resting_;
    told_ = has_waves ? (in.hand - *resting_) * (settings.impedance / in.seconds) : Vec3(0.0);
    resting_ = in.hand;
}

// The wave that is left is that of the force which the hand has felt, and so is the one that was played.
void OperatorPassivity::given(const PassivitySettings& settings, const Vec3& force, double seconds) {
    if (!now_.begun) {
        return;
    }
    told_ = force;
    if (force == now_.given) {
        return;
    }
    const double b = settings.impedance, root = std::sqrt(2.0 * b);
    const Vec3 played = (force + b * now_.way_velocity) / root;
    now_.wave_energy += 0.5 * seconds * (glm::dot(now_.played, now_.played) - glm::dot(played, played));
    now_.played = played;
    now_.given = force;
    past_[now_.sample % samples].wave = (b * now_.way_velocity - force) / root;
}

Vec3 OperatorPassivity::force(Passivity scheme, const PassivitySettings& settings, const In& in) {
    if (!now_.begun) {
        now_.hand = resting_.value_or(in.hand);
        now_.begun = true;
        resting_.reset();
    }
    now_.way_velocity = (in.hand - now_.hand) / in.seconds;
    // The environment is passive: in a contact it gives back no more than this end has given.
    now_.net = now_.given == Vec3(0.0) ? 0.0 : now_.net + glm::dot(now_.given, in.hand - now_.hand);
    hear(scheme, settings, in);
    Vec3 force(0.0);
    switch (scheme) {
        case Passivity::none:
            force = soft_force(settings, in);
            break;
        case Passivity::wave_variables:
            force = wave_force(settings, in);
            break;
        case Passivity::time_domain:
            force = damped_force(settings, in);
            break;
        case Passivity::two_layers:
            force = tank_force(settings, in);
            break;
    }
    Past& past = past_[in.sample % samples];
    past.sample = in.sample;
    past.hand = in.hand;
    past.wave = (settings.impedance * now_.way_velocity - force) / std::sqrt(2.0 * settings.impedance);
    now_.sample = in.sample;
    now_.hand = in.hand;
    now_.velocity = in.velocity;
    now_.given = force;
    return force;
}

// What the newest answer says about the far end: its wave, and the energy it has taken in. A wave that was
// lost is no energy.
void OperatorPassivity::hear(Passivity scheme, const PassivitySettings& settings, const In& in) {
    if (!now_.begun || in.far_sample <= now_.heard) {
        return;
    }
    if (now_.heard != 0) {
        const double taken = std::max(0.0, in.far_taken - now_.far_taken);
        now_.far_in += taken;
        now_.tank += scheme == Passivity::two_layers ? settings.shared * taken : 0.0;
    }
    if (const Past* const then = past(in.far_sample)) {
        const Vec3 wave = free_reflection * then->wave +
                          ((1.0 + free_reflection) / std::sqrt(2.0 * settings.impedance)) * in.far_force;
        now_.wave_energy += 0.5 * in.seconds * glm::dot(wave, wave);
        now_.wave = wave;
    }
    now_.far_taken = in.far_taken;
    now_.heard = in.far_sample;
}

Vec3 OperatorPassivity::soft_force(const PassivitySettings& settings, const In& in) {
    if (in.far_sample == 0 || in.far_sample > in.sample) {
        return Vec3(0.0);
    }
    const double age = static_cast<double>(in.sample - in.far_sample) * in.seconds;
    return softened_share(settings.softening, age) * in.far_force;
}

Vec3 OperatorPassivity::wave_force(const PassivitySettings& settings, const In& in) {
    const double b = settings.impedance;
    const double share = 1.0 - std::exp(-two_pi * settings.wave_cutoff * in.seconds);
    now_.smooth += share * (now_.wave - now_.smooth);
    Vec3 wave = now_.smooth;
    const double energy = 0.5 * in.seconds * glm::dot(wave, wave);
    if (const double left = std::max(0.0, now_.wave_energy); energy > left) {
        wave *= std::sqrt(left / energy);
    }
    now_.wave_energy -= 0.5 * in.seconds * glm::dot(wave, wave);
    now_.played = wave;
    return std::sqrt(2.0 * b) * wave - b * now_.way_velocity;
}

// Of a force, what gives no more than `energy` in a tick in which the hand goes on as it does (unit: joules).
// Less than none is owed: it is damped away, no faster than the device can. Where the hand is about to turn,
// its velocity says little: a free hand of mass m that comes with v against the force turns where f dt > m v,
// and what f has beyond that gives it f^2 dt^2 / m. No force is larger than half of what this end has left
// for that; the other half is for a hand that goes on.
Vec3 OperatorPassivity::affordable(const PassivitySettings& settings, const In& in, const Vec3& force,
                                   double energy) const {
    const double left = std::max(0.0, std::min(energy, -now_.net - settings.reserve) + settings.reserve);
    const double size = glm::length(force);
    // It goes on getting slower as it has done.
    const Vec3 next = in.velocity + (in.velocity - now_.velocity);
    const double comes = -std::max(glm::dot(force, in.velocity), glm::dot(force, next));
    const double against = size > 0.0 ? std::max(0.0, comes / size) : 0.0;
    const double mass = settings.lightest_hand;
    const double largest = (std::sqrt(0.5 * left * mass) + 0.5 * mass * against) / in.seconds;
    Vec3 affordable = size > largest ? force * (largest / size) : force;
    const double speed2 = glm::dot(in.velocity, in.velocity);
    const double power = glm::dot(affordable, in.velocity);
    if (speed2 < nothing || power <= 0.0) {
        return affordable;
    }
    const double allowed = 0.5 * left / in.seconds;
    const double owed = std::max(0.0, -settings.reserve - std::min(energy, -now_.net - settings.reserve));
    const double damping = std::max(0.0, power - allowed) / speed2 +
                           std::min(owed / (speed2 * in.seconds), settings.largest_damping);
    return affordable - damping * in.velocity;
}

Vec3 OperatorPassivity::damped_force(const PassivitySettings& settings, const In& in) {
    now_.out += std::max(0.0, glm::dot(now_.given, in.hand - now_.hand));
    const Vec3 wanted = in.far_sample != 0 ? in.far_force : Vec3(0.0);
    return affordable(settings, in, wanted, now_.far_in - now_.out);
}

Vec3 OperatorPassivity::tank_force(const PassivitySettings& settings, const In& in) {
    // What the hand was given comes out of the tank; of what it gave, the far end gets its share.
    const double given = glm::dot(now_.given, in.hand - now_.hand);
    now_.tank -= given > 0.0 ? given : (1.0 - settings.shared) * given;
    const Vec3 wanted = in.far_sample != 0 ? in.far_force : Vec3(0.0);
    const Vec3 force = affordable(settings, in, wanted, now_.tank);
    return force - settings.refill * std::max(0.0, settings.tank - now_.tank) * in.velocity;
}

Vec3 FarPassivity::hand(Passivity scheme, const PassivitySettings& settings, const In& in) {
    if (!begun_) {
        begun_ = true;
        operator_hand_ = own_ = in.hand;
        operator_force_ = in.force;
        sample_ = in.sample;
        tip_ = in.coupled.tip;
    }
    const Vec3 before = own_;
    if (scheme == Passivity::none) {
        own_ = in.hand;
    } else {
        // Of one sample to the next, the force was held and the hand went its way.
        const bool is_known = in.is_exact && was_exact_ && in.sample == sample_ + 1;
        const double work = -glm::dot(operator_force_, in.hand - operator_hand_);
        const double taken = is_known ? surely_taken * std::max(0.0, work) : 0.0;
        operator_in_ += taken;
        tank_ += settings.shared * taken;
        if (scheme == Passivity::wave_variables) {
            own_ += wave_way(settings, in, in.sample > sample_ ? in.sample - sample_ : 0);
        } else if (scheme == Passivity::time_domain) {
            own_ += yielding_way(settings, in);
        } else {
            const Vec3 way = in.hand - own_;
            const double left = tank_ + settings.far_store;
            own_ += way + too_far(in, way, in.coupled.stiffness > 0.0 ? left : std::max(0.0, left));
        }
        // What a spring is asked to store is paid as if the robot's drive got there in this tick.
        const double given = in.coupled.stiffness > 0.0 ? in.coupled.stored(own_) - in.coupled.stored(before)
                                                        : -glm::dot(in.own_force, own_ - before);
        const double unseen = in.coupled.done_unseen(tip_);
        out_ += std::max(0.0, given) + unseen;
        taken_ += std::max(0.0, -given);
        // Of what is taken in here, the operator's end gets its share.
        tank_ -= unseen + (given > 0.0 ? given : (1.0 - settings.shared) * given);
    }
    tip_ = in.coupled.tip;
    operator_hand_ = in.hand;
    operator_force_ = in.force;
    sample_ = in.sample;
    was_exact_ = in.is_exact;
    return own_;
}

// Of several samples at once the waves are those of their mean, which has no more energy than they had. What
// is played in one tick is scaled so that it has no more than has come.
Vec3 FarPassivity::wave_way(const PassivitySettings& settings, const In& in, std::uint64_t ticks) {
    const double b = settings.impedance;
    const double passed = std::max<double>(1.0, static_cast<double>(ticks));
    // Of many that were lost it is not known how long the force was held.
    const double held = std::min(passed, longest_held) * in.seconds;
    const Vec3 force = ticks > 1 ? 0.5 * (operator_force_ + in.force) : in.force;
    // sqrt(2/b) u = x' + F / b, and F = -f.
    Vec3 wave = (in.hand - operator_hand_) - force * (held / b);  // sqrt(2/b) u dt
    const double per_square = 0.25 * b / in.seconds;              // |u|^2 dt / 2 of that
    wave_energy_ += ticks > 0 ? per_square * glm::dot(wave, wave) / passed : 0.0;
    const double energy = per_square * glm::dot(wave, wave);
    // Rounding may leave a little less than nothing.
    if (const double left = std::max(0.0, wave_energy_); energy > left) {
        wave *= std::sqrt(left / energy);
    }
    wave_energy_ -= per_square * glm::dot(wave, wave);
    // b / (b + d) = (1 + r) / 2.
    Vec3 way = 0.5 * (1.0 + free_reflection) * (wave + in.own_force * (in.seconds / b));
    const double damping = b * (1.0 - free_reflection) / (1.0 + free_reflection);  // d
    damped_ += damping * glm::dot(way, way) / in.seconds;
    if (in.is_free || in.own_force == Vec3(0.0)) {
        // What the way back costs is paid by what d has taken.
        Vec3 back = (in.hand - own_ - way) * std::min(1.0, settings.drift_rate * in.seconds);
        const double cost = -glm::dot(in.own_force, back);
        back *= cost > damped_ ? damped_ / cost : 1.0;
        damped_ -= std::clamp(cost, 0.0, damped_);
        way += back;
    }
    return way;
}

Vec3 FarPassivity::yielding_way(const PassivitySettings& settings, const In& in) const {
    Vec3 way = in.hand - operator_hand_;
    way += (operator_hand_ - own_) * std::min(1.0, settings.drift_rate * in.seconds);
    const Vec3 yield = too_far(in, way, operator_in_ + settings.far_store - out_);
    const double most = settings.largest_yield * in.seconds * glm::length(in.own_force);
    return way + (in.coupled.stiffness > 0.0 ? yield : shortened(yield, most));
}

// What a way must be changed by so that no more than `left` is given (unit: joules). Below zero: a robot that
// touches has done more than that, and is led by no more than its friction.
Vec3 FarPassivity::too_far(const In& in, const Vec3& way, double left) const {
    const Coupled& coupled = in.coupled;
    if (coupled.stiffness > 0.0) {
        const double energy = coupled.stored(own_) + std::max(0.0, left);
        const Vec3 extension = own_ + way - coupled.tip;
        const bool owes = left < 0.0 && coupled.touches();
        const double spared = owes ? coupled.friction / coupled.stiffness : coupled.spared();
        const double most = spared + std::sqrt(2.0 * energy / coupled.stiffness);
        return shortened(extension, most) - extension;
    }
    const double size = glm::length(in.own_force);
    if (size * size < nothing) {
        return Vec3(0.0);
    }
    const Vec3 against = in.own_force / size;
    return against * std::max(0.0, -glm::dot(way, against) - left / size);
}

double FarPassivity::Coupled::stored(const Vec3& target) const {
    const double extension = std::max(0.0, glm::distance(target, tip) - spared());
    return 0.5 * stiffness * extension * extension;
}

double FarPassivity::Coupled::done_unseen(const Vec3& tip_before) const {
    const double size = glm::length(contact);
    return touches() ? std::max(0.0, glm::dot(contact, tip_before - tip)) * (unseen / size) : 0.0;
}

}  // namespace tactus
