// The proxy of the thesis (3.2.2 to 3.2.4, 4.2), to hold ours beside: three passes a tick over inflated
// triangles, each of which ends a little above what it meets.
#pragma once

#include <cstdint>
#include <vector>

#include "shared/judge_tree.hpp"

namespace tactus::bench {

constexpr char three_pass_prefix[] = "three_pass.";  // of the cases that it plays

// The thesis has a fourth, the epsilon of the moment: it begins with `base` in each tick.
struct Epsilons {
    double base = 1e-5;  // how far above a contact it stops, and how near to its goal it rests (unit: meters)
    double least = 1e-7;  // what the epsilon of the moment may shrink to (unit: meters)
    double ahead = 1e-5;  // how far beyond its goal a pass looks (unit: meters)
};

// It has a tree of its own. Over JudgeTree's, with four triangles a leaf and boxes that are inflated at each
// query, its ticks take 1.1 to 1.5 times as long, and a rival is measured at its best.
class ThreePassProxy {
public:
    // The mesh must live as long as this.
    ThreePassProxy(const TriangleMesh& mesh, double radius, const Epsilons& epsilons);

    // One tick. Whether something holds it back.
    bool move(const Vec3& hand);

    void put(const Vec3& position) { position_ = position; }
    const Vec3& position() const { return position_; }
    double bytes() const;

private:
    struct Node {
        Vec3 low, high;           // of what is below it, inflated
        std::uint32_t first = 0;  // its triangle, or its left child
        std::uint32_t is_leaf = 0;
    };
    struct Contact {
        double distance = 0.0;  // along the way; beyond its end where there is none (unit: meters)
        Vec3 normal{0.0};       // unit
    };

    void split(std::uint32_t node, std::uint32_t* first, std::uint32_t count);
    Contact first_contact(const Vec3& direction, double length) const;

    double radius_;
    Epsilons epsilons_;
    Vec3 position_{0.0};
    std::vector<shared::Corners> triangles_;
    std::vector<Node> nodes_;  // parents before children
};

}  // namespace tactus::bench
