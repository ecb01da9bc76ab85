#include "core/haptics/surface_spring.hpp"

#include <algorithm>
#include <cmath>

namespace tactus {

namespace {

double half_bend(const SurfaceSpring& s) {
    return 0.5 * (s.deep - s.stiffness) / s.depth;
}

// The root of a d^2 + b d = c that goes to 0 with c, without a difference of like numbers where a is small.
double shallow_root(double a, double b, double c) {
    return 2.0 * c / (b + std::sqrt(std::max(0.0, b * b + 4.0 * a * c)));
}

}  // namespace

double SurfaceSpring::force(double at) const {
    return at <= depth ? at * (stiffness + half_bend(*this) * at)
                       : deep * at - 0.5 * (deep - stiffness) * depth;
}

double SurfaceSpring::slope(double at) const {
    return at < depth ? stiffness + 2.0 * half_bend(*this) * at : deep;
}

double SurfaceSpring::energy(double at) const {
    const auto shallow = [this](double d) { return d * d * (0.5 * stiffness + half_bend(*this) * d / 3.0); };
    if (at <= depth) {
        return shallow(at);
    }
    const double farther = at - depth;
    return shallow(depth) + farther * (force(depth) + 0.5 * deep * farther);
}

double SurfaceSpring::depth_of(double f) const {
    if (f <= 0.0) {
        return 0.0;
    }
    return f <= force(depth) ? shallow_root(half_bend(*this), stiffness, f)
                             : (f + 0.5 * (deep - stiffness) * depth) / deep;
}

double SurfaceSpring::secant(double f) const {
    return is_linear() || f <= 0.0 ? stiffness : f / depth_of(f);
}

double SurfaceSpring::as_rich(double f) const {
    return is_linear() || f <= 0.0 ? stiffness : 0.5 * f * f / energy(depth_of(f));
}

double depth_under_pad(const SurfaceSpring& surface, double pad, double both) {
    if (pad <= 0.0) {
        return both;
    }
    return both <= surface.depth + surface.force(surface.depth) / pad
               ? shallow_root(half_bend(surface), surface.stiffness + pad, pad * both)
               : (pad * both + 0.5 * (surface.deep - surface.stiffness) * surface.depth) /
                     (surface.deep + pad);
}

// Springs in series: k_pad K / (k_pad + K) <= limit.
SurfaceSpring no_steeper(const SurfaceSpring& surface, double pad, double limit) {
    if (pad > 0.0 && limit >= pad) {
        return surface;
    }
    const double of_surface = pad > 0.0 ? limit * pad / (pad - limit) : limit;
    return {std::min(surface.stiffness, of_surface), std::min(surface.deep, of_surface), surface.depth};
}

}  // namespace tactus
