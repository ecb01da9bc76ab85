#include "core/haptics/force_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus {

namespace {

constexpr double strongest_of_curve = 1e6;  // (unit: newtons)
constexpr double deepest_of_curve = 1e3;    // (unit: meters)

double steepest_of(const ForceCurve& curve) {
    double most = 0.0;
    for (std::size_t i = 1; i < curve.forces.size(); ++i) {
        most = std::max(most, std::abs(curve.forces[i] - curve.forces[i - 1]));
    }
    return most * static_cast<double>(curve.forces.size() - 1) / curve.depth;
}

}  // namespace

std::shared_ptr<const ForceCurve> ForceCurve::of(double depth, std::vector<double> forces) {
    auto curve = std::make_shared<ForceCurve>();
    curve->depth = depth;
    curve->forces = std::move(forces);
    curve->steepest = curve->forces.size() > 1 ? steepest_of(*curve) : 0.0;
    return curve;
}

ForceCurve::At ForceCurve::at(double at_depth, double stiffness) const {
    if (at_depth >= depth) {
        return {forces.back() + stiffness * (at_depth - depth), stiffness};
    }
    const double pieces = static_cast<double>(forces.size() - 1);
    const double place = std::max(0.0, at_depth) * (pieces / depth);
    const auto piece = std::min(static_cast<std::size_t>(place), forces.size() - 2);
    const double rise = forces[piece + 1] - forces[piece];
    return {forces[piece] + rise * (place - static_cast<double>(piece)), rise * (pieces / depth)};
}

std::string check_curve(const ForceCurve& curve) {
    if (!(curve.depth > 0.0 && curve.depth <= deepest_of_curve) || curve.forces.size() < 2 ||
        curve.forces.size() > ForceCurve::most) {
        return "the force curve has no depth, or not between 2 and 1024 samples: give it both";
    }
    const auto is_force = [](double force) { return force >= 0.0 && force <= strongest_of_curve; };
    if (!std::ranges::all_of(curve.forces, is_force) || curve.forces.front() != 0.0) {
        return "the force curve does not begin at 0 N, or leaves 0 to 1,000,000 N: set its points anew";
    }
    return curve.steepest == steepest_of(curve)
               ? ""
               : "the force curve is not as steep as it says: make it of its samples again";
}

}  // namespace tactus
