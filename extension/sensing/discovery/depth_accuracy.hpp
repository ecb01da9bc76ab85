// How sure one depth is.
#pragma once

#include <cmath>

namespace tactus {

// Of a structured-light camera; see depth_noise.hpp.
struct DepthAccuracy {
    double base = 0.0012;    // standard deviation at `from` (unit: meters), > 0
    double growth = 0.0019;  // by which it grows, per square of depth beyond `from` (unit: 1/meter), >= 0
    double from = 0.4;       // (unit: meters)
    double step = 0.0029;    // of depth, per square of depth (unit: 1/meter), >= 0
    double error = 0.01;     // share by which all depths may be off together (dimensionless), >= 0
};

// Standard deviation of one depth, its steps included: an even chance of width s deviates by s / sqrt(12).
inline double depth_deviation(const DepthAccuracy& accuracy, double depth) {
    const double beyond = depth - accuracy.from;
    const double chance = accuracy.base + accuracy.growth * beyond * beyond;
    const double step = accuracy.step * depth * depth;
    return std::sqrt(chance * chance + step * step / 12.0);
}

}  // namespace tactus
