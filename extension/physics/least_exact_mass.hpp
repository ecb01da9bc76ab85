// How light a body may be for a hand's spring.
#pragma once

namespace tactus {

// A free body from this mass on gets within 1 % the impulse that such a spring shows the hand, from half of
// it on within 2 %; below, it yields within the step and gets less (spring_push.hpp). Of several springs the
// stiffness and damping count together (units: newtons per meter, newton seconds per meter, seconds;
// kilograms).
constexpr double least_exact_mass(double stiffness, double damping, double seconds) {
    return seconds * (damping + seconds * stiffness);
}

}  // namespace tactus
