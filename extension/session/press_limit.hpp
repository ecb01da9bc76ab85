// How deep a far hand may press. The operator's samples lead it, and where they are guessed, missing or have
// just come back, the hand may lie in a body that the operator does not touch. Then the hand is drawn back to
// its proxy, and what it presses with changes gradually:
//
//     guessed, or led   not at all where it was free when it was known last; where it touched, once a sample
//     after an outage   is late, by `guessed_force` more at most
//     comes (again)     from nothing, or after an outage; with a model no harder than the operator is pressed
//                       itself
//     goes              to nothing, and the hand is gone
//     here              no limit, once nothing is drawn back any more
//
// The depth is how far the device position is from the proxy. Plain values.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/teleop/deadband.hpp"

namespace tactus {

class PressLimit {
public:
    // Of the force that a limit changes, where the hand comes, returns or goes, and after a guess (unit:
    // newtons per second).
    static constexpr double slow_rate = 200.0, rate = 500.0;
    // A guess that lasts longer is an outage: the hand comes back from it (unit: seconds).
    static constexpr double longest_guess = 0.05;
    // By then another sample should have come (unit: seconds).
    static constexpr double latest_guess = 0.025;

    enum class Hand : std::uint8_t { here, guessed, goes };

    struct In {
        Hand hand = Hand::here;
        double stiffness = 500.0;  // of what is touched (unit: newtons per meter), > 0
        double force = 0.0;        // of the far hand, one tick ago (unit: newtons)
        // On the operator's own hand (unit: newtons), where it is told.
        std::optional<double> own_force;
        double seconds = 0.001;  // of a tick
        // Guessed: for longer than a guess lasts.
        bool is_outage = false;
    };

    // The hand comes, or another operator's: from what it presses with now, where the last has not gone yet.
    void come() { state_ = State::comes; }
    // The hand is away: it comes from nothing.
    void begin() { *this = {}; }
    bool binds(Hand hand) const { return state_ != State::here || hand != Hand::here || holds_back_; }
    double depth() const { return depth_; }  // (unit: meters)
    bool is_gone() const { return depth_ <= 0.0; }
    // From an outage: the operator's hand may have gone another way than this one.
    bool returns() const { return state_ == State::returns; }

    // Once a tick in which it binds, before the hand is drawn back.
    void step(const In& in) {
        const double change = (state_ == State::here ? rate : slow_rate) * in.seconds / in.stiffness;
        guessed_for_ = in.hand == Hand::guessed ? guessed_for_ + in.seconds : 0.0;
        const bool touches = known_ > 0.0 || (in.own_force && *in.own_force > 0.0);
        if (in.hand == Hand::goes) {
            depth_ = std::max(0.0, depth_ - slow_rate * in.seconds / in.stiffness);
        } else if (in.hand == Hand::guessed) {
            const bool is_bound = in.own_force || guessed_for_ > latest_guess;
            const double more = guessed_force / in.stiffness;
            depth_ += change;
            depth_ = !touches ? 0.0 : is_bound ? std::min(depth_, std::min(known_, before_) + more) : depth_;
            const bool is_outage = in.is_outage || guessed_for_ > longest_guess;
            state_ = is_outage && state_ == State::here ? State::returns : state_;
        } else if (state_ != State::here && in.own_force && in.force >= *in.own_force) {
            // What is told is rounded: a step more is no more than the operator's own.
            const bool is_more = in.force > *in.own_force + slow_rate * in.seconds;
            depth_ = std::max(0.0, depth_ - (is_more ? change : 0.0));
        } else {
            depth_ += change;
        }
        step_ = change;
    }
    // After it has been applied to a hand that is `depth` deep.
    void applied(Hand hand, double depth) {
        holds_back_ = depth > depth_ + (hand == Hand::here ? step_ : 0.0);
        if (hand != Hand::here) {
            return;
        }
        state_ = holds_back_ ? state_ : State::here;
        before_ = depth_;
        known_ = state_ == State::here ? depth : depth_;
        depth_ = std::min(depth, depth_);
    }
    // How deep a hand is that is here and not held back (unit: meters); 0: it touches nothing. A guess ends
    // so.
    void note(double depth) {
        before_ = depth_;
        known_ = depth_ = depth;
        guessed_for_ = 0.0;
    }

private:
    enum class State : std::uint8_t {
        comes,    // from nothing, or another one
        returns,  // from an outage
        here,
    };

    State state_ = State::comes;
    bool holds_back_ = false;
    double depth_ = 0.0;        // that is allowed, or is there (unit: meters)
    double step_ = 0.0;         // that it may change by in a tick (unit: meters)
    double known_ = 0.0;        // when the hand was known last (unit: meters)
    double before_ = 0.0;       // a tick before that: a tick's guess passes for known (unit: meters)
    double guessed_for_ = 0.0;  // (unit: seconds)
};

}  // namespace tactus
