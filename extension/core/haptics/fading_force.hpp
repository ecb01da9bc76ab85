// What a change of the scene would take from the hand or give it in one tick, spread over many.
//
// The motion of the hand and of bodies changes the force continuously. A body that appears, vanishes or is
// put elsewhere, a stiffness that is set, a radius that grows, a surface that lets go change it at once. Then
//     felt force = force of the scene + offset,
// where the offset is what the felt force would jump by otherwise, and fades by a fixed step a tick.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

class FadingForce {
public:
    // The most that a change of the scene changes the felt force by in a tick (unit: newtons).
    static constexpr double max_step = 0.25;

    // What the hand's own motion changes the force by is never held back: its way times the stiffness of what
    // it touches.
    struct Step {
        Vec3 hand{0.0};          // (unit: meters)
        Vec3 velocity{0.0};      // (unit: meters per second)
        double stiffness = 0.0;  // of the stiffest body that is touched (unit: newtons per meter)
        double damping = 0.0;    // likewise (unit: newton-seconds per meter)
    };

    // What is felt in this tick. `force`: of the scene as it is now (unit: newtons); `limit`: what the device
    // may give of it (unit: newtons). `jumped`: something else than motion has changed the force since the
    // last tick.
    Vec3 felt(const Vec3& force, double limit, bool jumped, const Step& step);

    // Afterwards in the same tick the force has become another one, and somebody else hides that.
    Vec3 goes_on_with(const Vec3& force, double limit);

    // Nothing is felt, and nothing fades.
    void clear() { *this = {}; }

    const Vec3& offset() const { return offset_; }  // (unit: newtons)

private:
    Vec3 offset_{0.0};
    Vec3 felt_{0.0};  // in the last tick, within the limit
    Step step_;       // of the last tick
};

}  // namespace tactus
