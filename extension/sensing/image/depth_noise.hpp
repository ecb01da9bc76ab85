// What a structured-light camera does to depths: seeded, and the same on every machine.
//
//   random     normally distributed along the ray, sigma(z) = 1.2 mm + 1.9 mm ((z - 0.4 m) / 1 m)^2
//              (Nguyen, Izadi, Lovell 2012, for surfaces seen at less than 60 degrees)
//   steps      the sensor measures disparity f b / z in eighths of a pixel: a step of depth is
//              z^2 / (8 f b), 2.1 mm at 0.85 m (f = 575 pixels, b = 75 mm)
//   edges      a pixel beside a jump of depth may see its neighbour's surface
//   holes      single pixels, surfaces that are seen from the side, what is too near, and the strip beside
//              a nearer object that the projector, to the right of the camera, does not reach
//   error      the whole image is too deep or too shallow by a share of depth that nobody has calibrated
#pragma once

#include "sensing/image/depth_image.hpp"

namespace tactus {

struct DepthNoise {
    double random = 1.0;        // factor of sigma(z) (dimensionless), >= 0
    double step = 1.0 / 345.0;  // of depth, per square of depth (unit: 1/meter), >= 0; 0: no steps
    double edge_jitter = 0.4;   // standard deviation of where a pixel looks (unit: pixels), >= 0
    double jump = 0.02;         // from one pixel to the next: an edge (unit: meters), > 0
    double hole_share = 0.005;  // of the pixels (dimensionless), 0 … 1
    double steepest = 1.40;     // angle between ray and normal beyond which nothing is seen (unit: radians)
    double nearest = 0.35;      // (unit: meters), >= 0
    double baseline = 0.075;    // from the camera to the projector (unit: meters), >= 0; 0: no shadows
    double error_share = 0.01;  // depth that is told is 1 + this times the true one (dimensionless)
};

// Random and steps of a depth, each told apart, are at most this far off (unit: meters).
double largest_error(const DepthNoise& noise, double depth);

// The same buffer, noise and seed give the same image, whatever came before.
DepthImage noisy_image(const DepthBuffer& exact, const DepthNoise& noise, std::uint64_t seed,
                       std::uint64_t time_us);

}  // namespace tactus
