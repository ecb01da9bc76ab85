// How much deeper a sphere sinks into an elastic body than the cells show by which the body deforms.
//
// Hertz: a sphere of radius R, pressed by F into a half-space of the reduced modulus E* = E / (1 - nu^2),
// touches it in a disc of radius a and sinks in by
//     a^3 = 3 F R / (4 E*),    a^2 / R = 3 F / (4 E* a).
// Cells spread the force over a wider disc, of radius a + b, so that they sink by 3 F / (4 E* (a + b)). They
// lack
//     d = 3 F / (4 E*) (1 / a - 1 / (a + b)) = 3 F / (4 E*) b / (a (a + b)),
// which grows with F and goes to 0 with b. A disc is no wider than the sphere: a <= R.
#pragma once

#include <algorithm>

namespace tactus {

struct LocalCompliance {
    double modulus = 0.0;   // E* (unit: pascals)
    double widening = 0.0;  // b (unit: meters); 0: the body's surface shows all of it

    bool is_none() const { return widening <= 0.0 || modulus <= 0.0; }
    bool operator==(const LocalCompliance&) const = default;
};

struct Indentation {
    double force = 0.0;      // F (unit: newtons)
    double depth = 0.0;      // d (unit: meters)
    double stiffness = 0.0;  // dF/dd (unit: newtons per meter)
};

// At the disc that a force would have if it grew without bound: s <= R is a itself, and beyond F = 4/3 E* R
// s. So there is no root to take. `radius` is R (unit: meters), > 0.
inline Indentation indentation_at(const LocalCompliance& body, double radius, double s) {
    const double a = std::min(s, radius), wide = a + body.widening;
    const double unit = 4.0 / 3.0 * body.modulus;
    const double force = s <= radius ? unit * s * s * s / radius : unit * radius * s;
    const double stiffness = s <= radius
                                 ? 3.0 * unit * a * wide * wide / (body.widening * (wide + body.widening))
                                 : unit * radius * wide / body.widening;
    return {force, a > 0.0 ? force / unit * body.widening / (a * wide) : 0.0, stiffness};
}

}  // namespace tactus
