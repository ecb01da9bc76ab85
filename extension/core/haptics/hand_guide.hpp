// A virtual fixture: what leads the hand where there is no surface, to a point, along a line, over a plane or
// along a way.
//
// At the distance d from it the hand is pulled with K d (1 - d / range), and not at all beyond the range.
// That is the slope of a potential, so it gives back what it took and no more; it begins at the border
// without a jump, is most at half the range, K range / 4, and K is how stiff it is where it leads to.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/math/types.hpp"

namespace tactus {

struct HandGuide {
    static constexpr std::size_t max_points = 16;
    enum class Form : std::uint8_t {
        none,
        point,  // the first
        line,   // through the first two, without an end
        plane,  // through the first three, without an end
        way,    // from each to the next
    };

    Form form = Form::none;
    std::size_t count = 0;                  // of the points
    std::array<Vec3, max_points> points{};  // in the world (unit: meters)
    double stiffness = 200.0;               // K (unit: newtons per meter), >= 0
    double range = 0.03;                    // (unit: meters), > 0

    bool operator==(const HandGuide&) const = default;
};

// Empty where it leads somewhere, or nowhere; otherwise what is wrong and what to do.
std::string check_guide(const HandGuide& guide);

// Where it leads a hand to; of one that leads somewhere.
Vec3 guided_place(const HandGuide& guide, const Vec3& hand);

// What the hand at that offset from where it is led to is pulled with (unit: newtons). `stiffness`: K, or
// what of it is safe.
Vec3 guide_force(const Vec3& offset, double range, double stiffness);

}  // namespace tactus
