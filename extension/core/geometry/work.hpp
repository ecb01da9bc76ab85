// How much a tick may do. Everything that takes time in proportion to a mesh is counted as it is done: boxes
// and packs looked at, sweeps, contacts, pairs in the solver. What finds nothing left ends at a place that is
// right as far as it goes.
#pragma once

#include <cstdint>

namespace tactus {

class WorkBudget {
public:
    // In units of 5 ns with warm caches, of 15 ns where everything comes from memory. The reserve is left
    // over when the rest is gone: for what has to be known wherever the work ends.
    explicit WorkBudget(std::int64_t units, std::int64_t reserve = 0)
        : left_(units - reserve), reserve_(reserve) {}

    void spend(std::int64_t units) { left_ -= units; }
    bool is_gone() const { return left_ <= 0; }
    std::int64_t left() const { return left_; }  // below zero: so much too much was spent
    // What was kept back may be spent as well, whatever was spent too much.
    void open_reserve() {
        left_ = reserve_;
        reserve_ = 0;
    }

private:
    std::int64_t left_;
    std::int64_t reserve_;
};

// What each piece costs, as the kernels' benches measure it.
namespace cost {
constexpr std::int64_t box_node = 6;       // eight boxes, with their place in the queue
constexpr std::int64_t pack_look = 3;      // distances of four triangles
constexpr std::int64_t part_look = 1;      // whether a part is in reach at all
constexpr std::int64_t solid_look = 6;     // distance of a solid
constexpr std::int64_t closest_point = 4;  // of one triangle, by scalars
constexpr std::int64_t half_space = 1;     // one test in the solver
}  // namespace cost

}  // namespace tactus
