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
    // Share of its energy that a free body loses to a hand's spring: one that is thrown over ice, and one
    // that comes and bounces off. The spring damps only what others hold (physics/spring_push.hpp).
    double thrown = 0.0;
    double bounced = 0.0;
    double spring_loss = 0.0;  // the larger of the two
    double run_time = 0.0;     // of the sliding box, per second of its time (unit: seconds)
};

PhysicsCheck check_physics(double step);  // (unit: seconds)

}  // namespace tactus::shared
