// Whether a ball can touch a mesh somewhere without holding any of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/tree/triangle_tree.hpp"

namespace tactus {

// Places of touch and directions from there to the ball's centre: those that lie between the ones given, a
// point, line or triangle of places and a ray, arc or cone of directions (unit vectors).
struct TouchPatch {
    static constexpr int max_directions = 12;

    std::array<Vec3, 3> places;
    int place_count = 0;
    std::array<Vec3, max_directions> directions;
    int direction_count = 0;
    double doubt = 0.0;  // by what rounding may have turned the directions (unit: radians)

    void add(const Vec3& direction) { directions[static_cast<std::size_t>(direction_count++)] = direction; }
};

// A ball of radius R that touches at p, its centre in direction n, holds a point q inside it where
//
//     f(p, n) = n.(q - p) - |q - p|^2 / 2R > 0.
//
// f is concave in p, and for n between n1 ... nk, a sum of them over its own length, which is at most 1, no
// less than the least over them. So one q that lies in the balls at the ends of a patch lies in every ball of
// it. Where one does not do, the patch is cut in two.
class EmptyBall {
public:
    EmptyBall(const TriangleTree& tree, double radius)
        : tree_(tree), radius_(radius), rounding_(0x1p-49 * tree.magnitude()) {}

    // False where every ball of the patch holds some of the mesh. True where one may not.
    bool may_touch(const TouchPatch& patch);
    // What all of that has taken (see WorkBudget).
    std::int64_t work() const { return work_; }

private:
    bool holds_some(const TouchPatch& patch, int& looks);
    bool is_in_all(const Vec3& point, const TouchPatch& patch) const;
    bool find_inside(const Vec3& center, Vec3& point);
    void remember(const Vec3& point);
    bool cut(const TouchPatch& patch, TouchPatch& first, TouchPatch& second) const;

    const TriangleTree& tree_;
    double radius_;
    double rounding_;            // of a point of the mesh: one within it is p itself (unit: meters)
    std::array<Vec3, 8> found_;  // points that lay in balls before: mostly in those beside them, too
    std::size_t found_count_ = 0, next_ = 0;
    std::int64_t work_ = 0;
};

}  // namespace tactus
