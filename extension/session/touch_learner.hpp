// What robots touch, and what that teaches about it: the bodies that touch lately has been felt on, each with
// its estimates (core/estimation/touch_estimate.hpp). Belongs to whoever ticks.
#pragma once

#include <array>

#include "core/estimation/touch_estimate.hpp"
#include "core/haptics/nearest_body.hpp"
#include "session/session_loop.hpp"

namespace tactus {

// One tick of a robot's tip, in this side's scene.
struct RobotTip {
    Vec3 position{0.0};    // of its centre (unit: meters)
    Vec3 contact{0.0};     // force on it (unit: newtons)
    double radius = 0.0;   // (unit: meters)
    double seconds = 0.0;  // of a tick
};

class TouchLearner {
public:
    TouchLearner() { touching_.fill(no_handle); }

    // Once a tick for each pointer whose robot is held.
    void feel(SessionLoop& loop, std::size_t pointer, const RobotTip& tip);
    // Nobody holds it.
    void let_go(std::size_t pointer);
    // Null: it has not been touched, or others since.
    const TouchEstimate* of(SessionHandle body) const;

private:
    struct Learnt {
        SessionHandle body = no_handle;
        std::uint64_t touched = 0;  // counts up with each touch
        TouchEstimate estimate;
    };

    SessionHandle touched_by(SessionLoop& loop, std::size_t pointer, const RobotTip& tip, Vec3& normal);
    Learnt& lesson(SessionHandle body);

    std::array<Learnt, 16> learnt_;
    std::array<SessionHandle, max_proxies> touching_;  // by pointer; no_handle: none
    std::array<NearestBody, max_proxies> nearest_;     // by pointer
    std::uint64_t touches_ = 0;
};

}  // namespace tactus
