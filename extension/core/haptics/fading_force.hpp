// What a change of the scene would take from the hand or give it in one tick, spread over many.
//
// The motion of the hand and of bodies changes the force continuously. A body that appears, vanishes or is
// put elsewhere, a stiffness that is set, the border of a stiffer surface, a radius that grows, a surface
// that lets go, or a damped one that is set going or stopped change it at once. Then
//     felt force = force of the scene + offset,
// where the offset is what the felt force would jump by otherwise, and fades by a fixed step a tick.
//
// A hand that the offset o pushes along must not get more work from it than the spring of stiffness k held
// that has let go, o^2 / (2 k). So where the hand goes by dx along o, o falls by k dx at least, as the force
// of that spring would have: then o^2 / (2 k) falls by o dx or more in each tick.
#pragma once

#include "core/math/types.hpp"
#include "core/math/wrench.hpp"

namespace tactus {

class FadingForce {
public:
    // The most that a change of the scene changes what a hand feels by in a tick (unit: newtons).
    static constexpr double max_step = 0.25;

    // What the hand's own motion changes the force by is never held back: the stiffness of what it touches,
    // times how much longer or shorter that spring has become, which is no more than the hand has moved. A
    // hand that is dragged along a surface takes its proxy along.
    struct Step {
        Vec3 hand{0.0};          // (unit: meters)
        Vec3 velocity{0.0};      // (unit: meters per second)
        double stiffness = 0.0;  // of the stiffest body that is touched (unit: newtons per meter)
        double damping = 0.0;    // likewise (unit: newton-seconds per meter)
        double fade = max_step;  // the same as max_step where a device scales forces (unit: newtons)
        Vec3 proxy{0.0};         // the spring's other end (unit: meters)
    };

    // What is felt in this tick. `force`: of the scene as it is now (unit: newtons); `limit`: what the device
    // may give of it (unit: newtons). `jumped`: something else than motion has changed the force since the
    // last tick.
    Vec3 felt(const Vec3& force, double limit, bool jumped, const Step& step);

    // Afterwards in the same tick the force has become another one, and somebody else hides that.
    Vec3 goes_on_with(const Vec3& force, double limit);

    // Nothing is felt, and nothing fades.
    void clear() { *this = {}; }

    bool fades() const { return offset_ != Vec3(0.0); }
    const Vec3& offset() const { return offset_; }  // (unit: newtons)

private:
    Vec3 offset_{0.0};
    double spring_ = 0.0;  // of what has let go (unit: newtons per meter)
    Vec3 felt_{0.0};       // in the last tick, within the limit
    Step step_;            // of the last tick
};

// The same of a force and the torque that goes with it, each by itself: of the second, all is in newton
// meters where the first has newtons, and in radians where it has meters.
class FadingWrench {
public:
    // On a handle that is held four centimeters from its axis, as much as the force's (unit: newton meters).
    static constexpr double max_torque_step = 0.01;

    Wrench felt(const Wrench& wrench, double force_limit, bool jumped, const FadingForce::Step& step,
                const FadingForce::Step& turn);
    Wrench goes_on_with(const Wrench& wrench, double force_limit);
    void clear() { *this = {}; }
    bool fades() const { return force_.fades() || torque_.fades(); }
    const Vec3& force_offset() const { return force_.offset(); }  // (unit: newtons)

private:
    FadingForce force_, torque_;
};

}  // namespace tactus
