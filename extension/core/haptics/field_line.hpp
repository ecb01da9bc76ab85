// A force that is computed elsewhere, along a straight line through the hand: its samples, and what of them
// is safe to render.
#pragma once

#include <array>

#include "core/math/types.hpp"

namespace tactus {

// Samples of a force on a line through a position.
struct FieldLine {
    static constexpr int most = 32;
    // The outermost samples are farther from the hand than `near` by so much (unit: meters).
    static constexpr double beyond = 0.02;

    Vec3 direction{0.0};             // unit vector; zero where there is no line
    double near = 0.0;               // as far as the hand may get until the next ones (unit: meters), >= 0
    int count = 0;                   // of samples, <= most; 0 where there is no line
    std::array<double, most> at{};   // along the direction from the position, ascending (unit: meters)
    std::array<Vec3, most> force{};  // (unit: newtons)

    void add(double where, const Vec3& what);  // needs count < most
};

// Linear between samples, constant beyond the outermost ones. Rendered is its mean over a window of width w,
//
//     G(s) = (P(s + w/2) - P(s - w/2)) / w,    P(s) = integral of F,
//
// the derivative of a smoothed potential: it changes by at most (range of F) / w per meter, and over a long
// way it does the work of F itself.
class FieldProfile {
public:
    FieldProfile() = default;  // no force
    FieldProfile(const Vec3& origin, const Vec3& force);
    FieldProfile(const Vec3& origin, const FieldLine& line);

    // Chooses the shortest window within which no more than `stiffest` (unit: newtons per meter, > 0) is
    // rendered where the hand may get. Where all of it is steeper than that, as a stiff spring is, forces are
    // taken for no longer than `strongest` (unit: newtons), so that there is such a window. One that was
    // rendered `before` is kept where it fits.
    void make_safe(double stiffest, double strongest, const FieldProfile& before);

    // The others at these places of its own line.
    template <class Force>
    void resample(const Force& force) {
        for (int i = 0; i < line_.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            line_.force[k] = force(origin_ + line_.direction * line_.at[k]);
        }
        window_ = 0.0;
        integrate();
    }

    const Vec3& direction() const { return line_.direction; }
    double near() const { return line_.near; }
    // Its largest slope where the hand may get, before it was made safe (unit: newtons per meter).
    double steepest() const { return steepest_; }
    bool is_weaker() const { return window_ > 0.0; }

    double along(const Vec3& place) const;  // s (unit: meters)
    Vec3 across(const Vec3& place) const;   // what is beside the line (unit: meters)
    Vec3 force(double s) const;             // F (unit: newtons)
    Vec3 rendered(double s) const;          // G (unit: newtons)
    Vec3 integral(double s) const;          // P (unit: newton meters)

private:
    int segment(double s) const;
    void integrate();
    double reach(double stiffest, double strongest) const;
    double slope(double window, double reach) const;

    Vec3 origin_{0.0};
    FieldLine line_;
    std::array<Vec3, FieldLine::most> integral_{};
    double window_ = 0.0;  // w (unit: meters)
    double steepest_ = 0.0;
};

}  // namespace tactus
