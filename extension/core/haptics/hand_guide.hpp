// A virtual fixture: a point, a line, a plane or a way that the hand is led to, held to, or kept away from.
//
// With the distance d from it, in the direction n away from it, and the range R:
//
//     attract   -K d max(0, 1 - d / R) n    it begins at R without a jump, is most at R / 2: K R / 4
//     hold      -K d n                      at every distance
//     forbid    K (R - d) min(1, 2 d / R) n within R: the hand is kept out of all that is nearer
//
// Each is the slope of a potential of d: it gives back what it took and no more, as long as the guide rests.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "core/haptics/guide_way.hpp"
#include "core/math/pose.hpp"

namespace tactus {

struct HandGuide {
    static constexpr std::size_t max_points = 3;  // of all forms but a way
    enum class Form : std::uint8_t {
        none,
        point,  // the first
        line,   // through the first two, without an end
        plane,  // through the first three, without an end
        way,    // from each to the next
    };
    enum class Mode : std::uint8_t { attract, hold, forbid };

    Form form = Form::none;
    Mode mode = Mode::attract;
    Pose frame{};                           // that the points are in, in the world
    std::size_t count = 0;                  // of the points
    std::array<Vec3, max_points> points{};  // (unit: meters)
    std::shared_ptr<const GuideWay> way{};  // of that form alone, in place of the points; null: none
    double stiffness = 200.0;               // K (unit: newtons per meter), >= 0
    double range = 0.03;                    // R (unit: meters), > 0
};

// Whether they are the same but for where they are.
bool is_same_guide(const HandGuide& a, const HandGuide& b);

// Empty where it leads somewhere, or nowhere; otherwise what is wrong and what to do.
std::string check_guide(const HandGuide& guide);

// Where it leads a hand to, both in its frame; of one that leads somewhere.
Vec3 guided_place(const HandGuide& guide, const Vec3& hand);

// What the hand at that offset from where it is led to is given (unit: newtons). `stiffness`: K, or what of
// it is safe.
Vec3 guide_force(HandGuide::Mode mode, const Vec3& offset, double range, double stiffness);

// How steep it is at most (unit: newtons per meter).
double steepest(const HandGuide& guide);

}  // namespace tactus
