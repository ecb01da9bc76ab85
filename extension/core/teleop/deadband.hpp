// What need not be sent, because the far side would guess it: it goes on with the last sample's velocity.
//
// The receiver cannot tell a sample that was not needed from one that was lost. So a hand that moves is sent
// at least every `longest_hand_guess`, and a guess that gets older is a loss: it slows down at once. With
// velocity v no guess leads farther than v (longest_hand_guess + slow_down_time) from the last sample. A hand
// that stands is sent until the far side has acknowledged it.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/body_motion.hpp"

namespace tactus {

struct DeadbandSettings {
    bool enabled = false;
    double position = 3e-5;        // fixed: the guess may be off by so much (unit: meters), >= 0
    double position_weber = 0.01;  // Weber: and by this share of the distance that a tenth of a second takes
    double angle = 2e-3;           // fixed: the guess of a body's turn, too (unit: radians), >= 0
    double force = 0.01;           // fixed: a force may differ by so much (unit: newtons), >= 0
    double force_weber = 0.05;     // Weber: and by this share of the last one sent
    Nanoseconds longest_silence = 200'000'000;  // then something is sent all the same
};

// Both sides guess alike, so that these are no settings (unit: seconds).
inline constexpr double longest_hand_guess = 0.02;
inline constexpr double slow_down_time = 0.005;

// With a model: a guess presses harder than the last sample by so much at most, so that a hand that presses
// more is sent by half of it (unit: newtons).
inline constexpr double guessed_force = 0.8;

// A guess of a slower hand leads nowhere: less than the fixed deadband (units: meters, radians per second).
inline constexpr double standing_speed = 1e-3;
inline constexpr double standing_spin = 0.05;

// For how long the last velocity is taken to have lasted, `seconds` (>= 0) after it (unit: seconds):
//     g(t) = t for t <= T,    T + s (1 - exp(-(t - T) / s)) after
inline double guessed_time(double seconds) {
    const double late = std::max(0.0, seconds - longest_hand_guess);
    return std::min(seconds, longest_hand_guess) + slow_down_time * -std::expm1(-late / slow_down_time);
}
// The share of the velocity that is left then: dg/dt.
inline double guessed_share(double seconds) {
    return std::exp(-std::max(0.0, seconds - longest_hand_guess) / slow_down_time);
}

// Where the far side puts the hand that was at `position` with `velocity`, `seconds` later.
inline Vec3 guessed_position(const Vec3& position, const Vec3& velocity, double seconds) {
    return position + velocity * guessed_time(seconds);
}

// `speed`, `spin` >= 0 (units: meters, radians per second).
inline bool stands(double speed, double spin = 0.0) {
    return speed < standing_speed && spin < standing_spin;
}

// What a sender knows about the last sample of a hand.
struct SaidHand {
    bool stands = false;
    bool acknowledged = false;     // the far side has one that says the same
    Nanoseconds since_sample = 0;  // it was sent so long ago
};
// A sample is due, although the guess holds.
bool hand_is_due(const DeadbandSettings& settings, const SaidHand& said);

bool position_needs_sending(const DeadbandSettings& settings, const Vec3& guessed, const Vec3& actual,
                            const Vec3& velocity);
// `guessed`: what goes on with the last rates sent.
bool motion_needs_sending(const DeadbandSettings& settings, const BodyMotion& guessed,
                          const BodyMotion& actual);
// `last`, `now`: what the operator's hand is pressed with (unit: newtons), >= 0.
inline bool press_needs_sending(double last, double now) {
    return now > last + 0.5 * guessed_force;
}
bool force_needs_sending(const DeadbandSettings& settings, const Vec3& last_sent, const Vec3& actual);

}  // namespace tactus
