// What touch has taught of a stiffness, a friction, a mass.
#pragma once

namespace tactus {

// What is told, and how sure it is: standard deviations.
struct TouchValue {
    double value = 0.0;
    double deviation = 0.0;
    bool known = false;  // sure to a fifth of itself at least
};

}  // namespace tactus
