// A way of many straight pieces, made once and shared: the place on it that is nearest to a hand, in bounded
// time.
//
// Pieces are kept in blocks of `block`, each within a sphere. A block whose sphere is farther away than the
// nearest place so far is left out: of n pieces about n/16 + 16 are looked at, and n of a hand that is as far
// from all of them, as in the middle of a circle.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/math/types.hpp"

namespace tactus {

struct GuideWay {
    static constexpr std::size_t most = 4096;  // points
    static constexpr std::size_t block = 16;   // pieces

    struct Block {
        Vec3 center{0.0};     // (unit: meters)
        double radius = 0.0;  // (unit: meters)

        bool operator==(const Block&) const = default;
    };

    std::vector<Vec3> points;   // (unit: meters)
    std::vector<Block> blocks;  // of the pieces from i * block on

    // Of any points: whether it can be followed is for check_way() to say.
    static std::shared_ptr<const GuideWay> of(std::vector<Vec3> points);
};

// Where a guide can be (unit: meters).
inline constexpr double farthest_guide = 1e9;
bool is_guide_place(const Vec3& place);

// Empty where a guide can be at all of them; otherwise what is wrong and what to do.
std::string check_guide_points(std::span<const Vec3> points);

// Empty where it can be followed; otherwise what is wrong and what to do.
std::string check_way(const GuideWay& way);

// The place on it nearest to `hand`. Needs a way that check_way() finds nothing wrong with.
Vec3 nearest_on_way(const GuideWay& way, const Vec3& hand);

// The place nearest to `hand` on the line from a to b, as far as those shares of it.
Vec3 nearest_on_line(const Vec3& a, const Vec3& b, const Vec3& hand, double first, double last);

}  // namespace tactus
