// Where a sphere on a mesh should be: the local constrained minimum, reached by exact descent. Slow, in
// extended precision, and made of other parts than the proxy: the judge's tree instead of the product's,
// every subset of contact planes tried instead of an incremental search, steps of at most a fiftieth of the
// radius instead of sweeps.
//
// From the start the centre goes down the distance to the hand, never letting any triangle come nearer than
// the radius: the distance to a triangle is convex, so what keeps the half-space of each contact plane keeps
// clear of the triangle. Near the end Newton steps on the Lagrangian polish the place to the last bits, but
// only towards a minimum: where the Lagrangian bends the other way, plain descent leads off.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "shared/judge_tree.hpp"

namespace tactus::shared {

struct ReferencePlace {
    SlowVec3 position{0.0L};
    bool settled = false;  // false: the steps did not suffice
    int steps = 0;
    int pressing = 0;          // contacts that hold it back
    long double residual = 0;  // length of the next step (unit: meters)
};

class ReferenceDescent {
public:
    // The mesh must live as long as this.
    ReferenceDescent(const TriangleMesh& mesh, double radius);
    // The same over a tree that is there already; it must live as long as this.
    ReferenceDescent(const JudgeTree& tree, double radius);

    // Where the centre settles that starts at `start` (at most a rounding error nearer than the radius to any
    // triangle).
    ReferencePlace settle(const Vec3& start, const Vec3& hand);

    // Whether a hair decides that it settles at `end`: from a crest, with the hand a hair to the other side,
    // it settles on the other side, farther off than `apart` (unit: meters).
    bool is_balanced(const Vec3& start, const Vec3& hand, const SlowVec3& end, double apart);

private:
    struct Constraint {
        SlowVec3 normal{0.0L};   // unit, from the triangle to the centre
        long double gap = 0.0L;  // distance minus radius (unit: meters)
        SlowVec3 edge{0.0L};
        long double distance = 0.0L;
        int supports = 0;
    };

    struct Step {
        SlowVec3 motion{0.0L};
        int pressing[3] = {-1, -1, -1};
        long double pressure[3] = {0.0L, 0.0L, 0.0L};
        int count = 0;
    };

    void gather(const SlowVec3& center, long double reach);
    void constrain(const SlowVec3& center, long double reach);
    bool solve_subset(const SlowVec3& pull, const std::vector<int>& working, const int* chosen, int count,
                      Step& step) const;
    Step enumerate(const SlowVec3& pull, const std::vector<int>& working) const;
    Step flat_step(const SlowVec3& pull) const;
    bool newton_step(const SlowVec3& pull, const Step& flat, SlowVec3& motion, long double longest) const;

    std::unique_ptr<const JudgeTree> own_;
    const JudgeTree& tree_;
    long double radius_;
    SlowVec3 gathered_at_{0.0L};
    long double gathered_reach_ =
        -1.0L;  // every triangle with a gap up to this there is known (unit: meters)
    std::vector<std::uint32_t> near_;
    std::vector<Constraint> constraints_;
};

}  // namespace tactus::shared
