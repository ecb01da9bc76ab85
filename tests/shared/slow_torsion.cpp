#include "shared/slow_torsion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::shared {

namespace {

// Pressure of Hertz over the patch, as sums over rings and sectors (unit: newtons a piece).
double pressed_by(double pressing, double patch, double r, double area) {
    const double inside = 1.0 - r * r / (patch * patch);
    return 1.5 * pressing / (std::numbers::pi * patch * patch) * std::sqrt(std::max(0.0, inside)) * area;
}

}  // namespace

double slow_torsion(const SoftFinger& finger, double friction, double pressing) {
    constexpr int rings = 20'000;
    const double patch = std::cbrt(3.0 * pressing * finger.radius / (4.0 * finger.modulus));
    double torque = 0.0;
    for (int i = 0; i < rings; ++i) {
        const double r = patch * (i + 0.5) / rings;
        const double area = 2.0 * std::numbers::pi * r * patch / rings;
        torque += friction * pressed_by(pressing, patch, r, area) * r;
    }
    return torque;
}

// While the patch turns about a point at the distance c, every piece is held back across the way to that
// point. The force grows with c and the torque shrinks.
double slow_torsion(const SoftFinger& finger, double friction, double pressing, double along) {
    constexpr int rings = 200;
    constexpr int sectors = 180;
    const double patch = std::cbrt(3.0 * pressing * finger.radius / (4.0 * finger.modulus));
    double torque = 0.0;
    const auto force_at = [&](double c) {
        double force = 0.0;
        torque = 0.0;
        for (int i = 0; i < rings; ++i) {
            const double r = patch * (i + 0.5) / rings;
            const double area = 2.0 * std::numbers::pi * r * patch / (rings * sectors);
            const double held = friction * pressed_by(pressing, patch, r, area);
            for (int j = 0; j < sectors; ++j) {
                const double angle = 2.0 * std::numbers::pi * (j + 0.5) / sectors;
                const double x = r * std::cos(angle);
                const double y = r * std::sin(angle);
                const double away = std::max(std::hypot(x - c, y), 1e-12);
                force -= held * (x - c) / away;
                torque += held * (x * (x - c) + y * y) / away;
            }
        }
        return force;
    };
    double low = 0.0;
    double high = 100.0 * patch;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (force_at(middle) < along ? low : high) = middle;
    }
    return torque;
}

}  // namespace tactus::shared
