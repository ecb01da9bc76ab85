// Meshes that deform under a hand: random ways of their corners, however far, and whether the proxy was on
// the same side of the surface after each.
#pragma once

#include <cstdint>
#include <memory>

#include "core/geometry/touch_shape.hpp"
#include "shared/random_values.hpp"

namespace tactus::shared {

// A body of one mesh.
std::shared_ptr<const TouchShape> touch_of(const TriangleMesh& mesh);
// The same body with its corners elsewhere, over a refit of its tree.
std::shared_ptr<const TouchShape> refitted(const TouchShape& before, const TriangleMesh& moved);

// A way of all points of space, the sum of some plane waves, up to `farthest` long. Where `gentle`, it bends
// so little that no two places come together, and neither do they on the straight way from another such.
class RandomWay {
public:
    RandomWay(RandomValues& random, double farthest, double size, bool gentle);
    Vec3 of(const Vec3& place) const;
    // Where the point was that has gone to `place`; of gentle ways.
    Vec3 origin_of(const Vec3& place) const;

private:
    struct Wave {
        Vec3 amplitude, frequency;
        double phase;
    };
    Wave waves_[4];
};

TriangleMesh moved(const TriangleMesh& rest, const RandomWay& way);

struct DeformFigures {
    int deformations = 0;
    int passes = 0;         // the proxy was on another side afterwards and was not said to be let out
    int let_out = 0;        // it was let out
    int touched = 0;        // it touched the surface afterwards
    double farthest = 0.0;  // that a corner has gone in one update, in radii

    void add(const DeformFigures& other);
};

// One seeded run of 20 deformations of up to ten radii of a ball, a crumpled ball, a sheet or a thin plate.
DeformFigures play_deforms(std::uint64_t seed);

}  // namespace tactus::shared
