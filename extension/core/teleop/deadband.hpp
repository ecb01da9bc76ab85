// What need not be sent, because the far side would guess it: it goes on with the last sample's velocity.
#pragma once

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

// Where the far side puts the hand that was at `position` with `velocity`, `seconds` later.
inline Vec3 guessed_position(const Vec3& position, const Vec3& velocity, double seconds) {
    return position + velocity * seconds;
}

bool position_needs_sending(const DeadbandSettings& settings, const Vec3& guessed, const Vec3& actual,
                            const Vec3& velocity);
// `guessed`: what goes on with the last rates sent.
bool motion_needs_sending(const DeadbandSettings& settings, const BodyMotion& guessed,
                          const BodyMotion& actual);
bool force_needs_sending(const DeadbandSettings& settings, const Vec3& last_sent, const Vec3& actual);

}  // namespace tactus
