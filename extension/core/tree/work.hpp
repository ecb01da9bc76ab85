// How much a tick may do. Everything that takes time in proportion to a mesh is counted as it is done: boxes
// and packs looked at, sweeps, contacts, pairs in the solver. What finds nothing left ends at a place that is
// right as far as it goes.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tactus {

// What each piece costs: their shares of the time of late ticks on rough meshes, by least squares
// (docs/proxy.md).
namespace cost {
constexpr std::int64_t box_node = 6;       // eight boxes, with their place in the queue
constexpr std::int64_t pack_look = 3;      // distances of four triangles
constexpr std::int64_t contact_look = 7;   // the same, with their tangents
constexpr std::int64_t sweep_look = 8;     // the same, and whether they can be met from there on
constexpr std::int64_t part_look = 1;      // whether a part is in reach at all
constexpr std::int64_t far_part = 8;       // the same, of the next one in the heap of those that are far
constexpr std::int64_t solid_look = 6;     // distance of a solid
constexpr std::int64_t closest_point = 4;  // of one triangle, by scalars
constexpr std::int64_t half_space = 1;     // one test in the solver
}  // namespace cost

class WorkBudget {
public:
    // In units of 10 to 14 ns. The reserve is left over when the rest is gone: for what has to be known
    // wherever the work ends.
    explicit WorkBudget(std::int64_t units, std::int64_t reserve = 0,
                        std::int64_t sweep_look = cost::sweep_look)
        : left_(units - reserve), reserve_(reserve), sweep_look_(sweep_look) {}

    void spend(std::int64_t units) { left_ -= units; }
    bool is_gone() const { return left_ <= 0; }
    std::int64_t left() const { return left_; }  // below zero: so much too much was spent
    std::int64_t sweep_look() const { return sweep_look_; }
    // What was kept back may be spent as well, whatever was spent too much.
    void open_reserve() {
        left_ = reserve_;
        reserve_ = 0;
    }

private:
    std::int64_t left_;
    std::int64_t reserve_;
    std::int64_t sweep_look_;
};

// While it lives, no more is spent than a share of what is left.
class WorkShare {
public:
    WorkShare(WorkBudget& work, std::int64_t units)
        : work_(work), kept_(std::max<std::int64_t>(0, work.left() - units)) {
        work_.spend(kept_);
    }
    ~WorkShare() { work_.spend(-kept_); }
    WorkShare(const WorkShare&) = delete;
    WorkShare& operator=(const WorkShare&) = delete;

    // All of the share is spent, although there was more.
    bool is_too_small() const { return kept_ > 0 && work_.is_gone(); }

private:
    WorkBudget& work_;
    std::int64_t kept_;
};

}  // namespace tactus
