// Small motions with an exact solution, run with steps of a given length: how far off is what comes out, and
// what did it take. Errors are shares of the exact value (unit: percent).
#pragma once

namespace tactus::shared {

struct PhysicsCheck {
    double fall = 0.0;      // way of a body that falls for one second: g t^2 / 2
    double sliding = 0.0;   // way of a box that slides to rest from 1.5 m/s: v^2 / (2 mu g)
    double momentum = 0.0;  // of a box pushed over ice for half a second: F t
    double energy = 0.0;    // of the same: (F t)^2 / (2 m)
    double work = 0.0;      // done on the same: F s against its exact energy
    // Share of its energy that a hand's spring loses when it throws a box over ice: the price of a spring
    // that is stable for bodies however light (physics/spring_push.hpp), pi / 2 dt sqrt(k / m) to first
    // order.
    double spring_loss = 0.0;
    double run_time = 0.0;  // of the sliding box, per second of its time (unit: seconds)
};

PhysicsCheck check_physics(double step);  // (unit: seconds)

}  // namespace tactus::shared
