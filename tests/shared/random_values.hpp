// Seeded random values for tests and benches: the same on every machine, because nothing but the engine's
// bits is used.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "core/math/types.hpp"

namespace tactus::shared {

class RandomValues {
public:
    explicit RandomValues(std::uint64_t seed) : engine_(seed) {}

    // In [0, 1).
    double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * unit(); }
    // Evenly spread over the orders of magnitude from low to high, both > 0.
    double magnitude(double low, double high) { return low * std::pow(high / low, unit()); }
    int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
    bool flip() { return (engine_() >> 33) & 1u; }

    Vec3 in_box(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
    Vec3 in_ball(double radius) {
        Vec3 p;
        do {
            p = in_box(1.0);
        } while (glm::dot(p, p) > 1.0);
        return radius * p;
    }
    Vec3 direction() {
        Vec3 p;
        do {
            p = in_box(1.0);
        } while (glm::dot(p, p) > 1.0 || glm::dot(p, p) < 1e-4);
        return glm::normalize(p);
    }
    Quat rotation() {
        const double angle = between(0.0, 3.14159265358979);
        const Vec3 axis = direction() * std::sin(0.5 * angle);
        return glm::normalize(Quat(std::cos(0.5 * angle), axis.x, axis.y, axis.z));
    }

private:
    std::mt19937_64 engine_;
};

}  // namespace tactus::shared
