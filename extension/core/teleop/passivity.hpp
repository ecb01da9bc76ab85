// Direct teleoperation that bounds the energy it generates: the schemes of the field, at both ends.
//
// Both ends are ports: the operator's hand gives the link a velocity and is given a force; the far hand is
// moved by the link and feels the environment's force h. The work at a port is that of the force that was
// held over the displacement since; passive is what both ports together are given, not either alone. The far
// end tells how much energy it has taken in: its hand yields, so that the operator cannot work that out. All
// else follows from what is sent without a scheme.
//
//   wave variables  Niemeyer and Slotine 1991. With wave impedance b and F = -f the hand's force on the link:
//                   u = (b x' + F) / sqrt(2b) goes there, w = (b x' - F) / sqrt(2b) comes back. Decoded,
//                       far hand   x' = sqrt(2/b) u + h / b,    w = u + sqrt(2/b) h
//                       operator   f = sqrt(2b) w - b x'
//                   A free far hand would return all of u, which goes to and fro for long: it is damped by
//                   d = b (1 - r) / (1 + r) besides, so that
//                       x' = (sqrt(2b) u + h) / (b + d),    w = r u + (1 + r) h / sqrt(2b)
//                   and of a wave the share r comes back. A delay of |u|^2/2 and |w|^2/2 makes no energy.
//                   What is smoothed or held is scaled so that no more of it is played than has come.
//   time domain     Ryu, Artigas and Preusche 2010, after Hannaford and Ryu 2002. Each end splits its energy
//                   into what goes in and what comes out. What has come out may not exceed what the other
//                   end has taken in, as last heard: else the operator's end damps, alpha = dE / (v^2 dt),
//                   and the far end yields, beta = dE / (h^2 dt).
//   two layers      Franken, Stramigioli, Misra, Secchi and Macchelli 2011. The upper layer wants the far
//                   force and the operator's place; the lower has a tank at each end, and nothing is done
//                   that the tank cannot pay. What is taken in is shared between both tanks; below its
//                   wanted level the operator's is filled by -d x'.
//   A robot follows the far hand by a spring: in the time domain and with two layers the far hand goes only
//   so far that the spring has no more energy than is left, and what it has is what the far end has given.
//   none            the force as it comes, or through a network compensation spring (Kroep and others 2023):
//                   the older a force is, the softer is the spring that displays it. With its age T,
//                       f = h / (1 + T / tau)
//                   so that stiffness times delay, which decides whether the loop is stable, stays below
//                   k tau at any T. The hand may still be given more than it has put in.
//
// Pure values: no clock, no allocation after set-up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <optional>

#include "core/math/types.hpp"

namespace tactus {

// Of a wave, what a free far hand returns: r above. 1: it is not damped; 0: nothing, and d = b.
inline constexpr double free_reflection = 0.5;

enum class Passivity : std::uint8_t { none, wave_variables, time_domain, two_layers };

struct PassivitySettings {
    double impedance = 20.0;      // wave variables: b (unit: newton-seconds per meter), > 0
    double wave_cutoff = 20.0;    // above it returning waves are smoothed (unit: hertz), > 0
    double drift_rate = 10.0;     // at which a far hand that has yielded comes back (unit: 1/seconds), >= 0
    double reserve = 1e-3;        // time domain, two layers: never given to the operator (unit: joules), >= 0
    double lightest_hand = 0.05;  // and its handle (unit: kilograms), > 0
    double largest_damping = 30.0;  // of what is owed (unit: newton-seconds per meter), > 0
    double largest_yield = 1.0;     // time domain (unit: meters per newton-second), > 0
    double far_store = 0.005;  // that the far end may spend before it has heard of any (unit: joules), >= 0
    double tank = 0.01;        // two layers: the operator's wanted level (unit: joules), >= 0
    double refill = 200.0;     // two layers: d for each joule below it (unit: newton-seconds per meter joule)
    double shared = 0.5;       // two layers: of what is taken in, what the other end gets, 0 … 1
    double softening = 0.0;    // none: tau above; 0: not softened (unit: seconds), >= 0
};

// Of a force that is so old, what a network compensation spring displays, 0 … 1.
constexpr double softened_share(double softening, double age) {
    return softening > 0.0 ? softening / (softening + age) : 1.0;
}

class OperatorPassivity {
public:
    // More delay than this many ticks finds no wave of its own any more and gives no force.
    static constexpr std::size_t samples = 2048;

    struct In {
        std::uint64_t sample = 0;  // of this tick, > 0
        Vec3 hand{0.0};            // (unit: meters)
        Vec3 velocity{0.0};        // of the hand (unit: meters per second)
        // Heard last: the force on the far hand after it had applied `far_sample`; 0: nothing has come.
        Vec3 far_force{0.0};  // (unit: newtons)
        std::uint64_t far_sample = 0;
        double seconds = 0.001;  // of a tick
        double far_taken = 0.0;  // FarPassivity::taken(), as heard with it (unit: joules)
    };

    // An answer has come, which is heard last then (the far_ and `seconds` of `in`). Of several in a tick
    // each has a wave of its own. None is heard before the first force().
    void hear(Passivity scheme, const PassivitySettings& settings, const In& in);
    // The force on the hand in this tick (unit: newtons).
    Vec3 force(Passivity scheme, const PassivitySettings& settings, const In& in);
    // After limits behind it have changed what the hand is given.
    void given(const PassivitySettings& settings, const Vec3& force, double seconds);
    // A tick in which the far side does not answer: the hand is free, and all that was known is forgotten.
    void rest(Passivity scheme, const PassivitySettings& settings, const In& in);
    // The force that the far end is to be told of (unit: newtons): the one on the hand. At rest no waves go
    // there, since nothing opposes the hand: then it is b x', whose wave is 0.
    const Vec3& told() const { return told_; }

private:
    struct Past {
        std::uint64_t sample = 0;
        Vec3 hand{0.0};
        Vec3 wave{0.0};
    };
    const Past* past(std::uint64_t sample) const;
    Vec3 affordable(const PassivitySettings& settings, const In& in, const Vec3& force, double energy) const;
    static Vec3 soft_force(const PassivitySettings& settings, const In& in);
    Vec3 wave_force(const PassivitySettings& settings, const In& in);
    Vec3 damped_force(const PassivitySettings& settings, const In& in);
    Vec3 tank_force(const PassivitySettings& settings, const In& in);

    // All that a beginning forgets.
    struct State {
        bool begun = false;
        Vec3 hand{0.0};          // one tick ago
        Vec3 velocity{0.0};      // the same
        Vec3 given{0.0};         // force, one tick ago
        Vec3 way_velocity{0.0};  // of the hand's way in this tick
        Vec3 played{0.0};        // wave, in this tick
        std::uint64_t sample = 0;
        std::uint64_t heard = 0;  // the newest sample that was answered
        double far_taken = 0.0;   // In::far_taken, as heard last (unit: joules)
        double far_in = 0.0;      // taken in at the far end, as heard (unit: joules)
        Vec3 wave{0.0};           // that has come last
        Vec3 smooth{0.0};
        double wave_energy = 0.0;  // that has come and has not been played (unit: joules)
        double out = 0.0;          // given to the hand (unit: joules)
        double tank = 0.0;         // (unit: joules)
        double net = 0.0;          // given to the hand in this contact, less what it has given (unit: joules)
    };

    State now_;
    Vec3 told_{0.0};
    std::optional<Vec3> resting_;  // hand, one tick ago
    std::array<Past, samples> past_{};
};

class FarPassivity {
public:
    // Time domain, two layers: the far hand is the target of a spring that leads a robot's tip. Its energy is
    // that of the part of its extension e beyond what friction takes, k e^2 / 2. Friction is known up to
    // `unseen` alone: a contact force that is larger than it is none, and then `unseen` of it does work, too.
    struct Coupled {
        double stiffness = 0.0;  // k (unit: newtons per meter); 0: the far hand is led itself
        double friction = 0.0;   // (unit: newtons), >= 0
        double unseen = 0.0;     // (unit: newtons), >= 0
        Vec3 contact{0.0};       // on the tip (unit: newtons)
        Vec3 tip{0.0};           // (unit: meters)

        double spared() const { return (friction + unseen) / stiffness; }  // (unit: meters)
        double stored(const Vec3& target) const;                           // (unit: joules)
        bool touches() const { return glm::dot(contact, contact) > unseen * unseen; }
        // By `unseen`, on the way from where the tip was (unit: joules).
        double done_unseen(const Vec3& tip_before) const;
    };

    struct In {
        std::uint64_t sample = 0;  // the operator's that is played in this tick
        Vec3 hand{0.0};            // the operator's (unit: meters)
        Vec3 force{0.0};           // on the operator's hand (unit: newtons)
        Vec3 own_force{0.0};       // h, on the hand here one tick ago (unit: newtons)
        double seconds = 0.001;
        // It is the operator's, and nothing in between: what that has taken in since the last one is known.
        bool is_exact = true;
        // Wave variables: it touches nothing, though its own force may not be 0.
        bool is_free = false;
        Coupled coupled{};
    };

    // Where the far hand goes in this tick (unit: meters).
    Vec3 hand(Passivity scheme, const PassivitySettings& settings, const In& in);
    // The hand has been held back, and is there now.
    void went(const Vec3& hand) { own_ = hand; }
    // What this end has taken in from the environment so far (unit: joules), for the operator's. Outlasts
    // reset().
    double taken() const { return taken_; }
    void reset() {
        const double taken = taken_;
        *this = {};
        taken_ = taken;
    }

private:
    Vec3 wave_way(const PassivitySettings& settings, const In& in, std::uint64_t ticks);
    Vec3 yielding_way(const PassivitySettings& settings, const In& in) const;
    Vec3 too_far(const In& in, const Vec3& way, double left) const;

    bool begun_ = false;
    std::uint64_t sample_ = 0;
    Vec3 operator_hand_{0.0};  // one tick ago
    Vec3 operator_force_{0.0};
    Vec3 own_{0.0};             // where the far hand is
    Vec3 tip_{0.0};             // one tick ago, see Coupled
    double operator_in_ = 0.0;  // taken in at the operator's end, as heard (unit: joules)
    double out_ = 0.0;          // given to the environment (unit: joules)
    double tank_ = 0.0;
    double taken_ = 0.0;
    double wave_energy_ = 0.0;  // that has come and has not been played (unit: joules)
    double damped_ = 0.0;       // wave variables: by d, and not spent on coming back (unit: joules)
    bool was_exact_ = false;
};

}  // namespace tactus
