// Tools that touch each other, judged by code that shares nothing with ToolGroup: every sphere of the one
// against every triangle of the other.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/haptics/touch_scene.hpp"
#include "core/math/wrench.hpp"
#include "core/tool/tool_group.hpp"
#include "shared/tool_figures.hpp"

namespace tactus::shared {

// Tools that may all meet, and meshes that stand still.
class PairRig {
public:
    // The mesh has to be one of a tool. `share`: of the coupling that its hand is given.
    void add_tool(const TriangleMesh& mesh, const ToolShapeSettings& sampling,
                  const ToolSettings& settings = {}, double share = 1.0);
    void add_wall(const TriangleMesh& mesh, const TouchMaterial& material = {}, const Pose& pose = {});
    // As many hands as tools.
    void tick(const std::vector<Pose>& hands);
    void ticks(const std::vector<Pose>& hands, int count);

    ToolProxy& tool(std::size_t i) { return *held_[i].proxy; }
    ToolPair& pair(std::size_t i) { return *pairs_[i]; }
    const ToolTick& last(std::size_t i) const { return group_.tick_of(i); }
    const TouchScene& scene() const { return scene_; }
    // Work of the last tick, as WorkBudget counts.
    std::int64_t work() const;

    // The least of the distances of a pair's spheres to its triangles, less their radii (unit: meters).
    double least_gap(std::size_t pair) const;
    // The same of all tools' spheres and the walls.
    double least_wall_gap() const;

    // What each hand feels where all couplings and surfaces are in balance, without friction: their energy
    // and that of springs at every sphere and triangle that are too near, descended by Gauss and Newton's
    // steps, with stiffer and stiffer springs.
    std::vector<Wrench> slow_balance(const std::vector<Pose>& hands) const;

private:
    struct Held {
        TriangleMesh mesh;
        std::shared_ptr<const ToolShape> shape;
        std::unique_ptr<ToolProxy> proxy;
        double share = 1.0;
    };
    struct Slope {
        std::vector<double> down;               // the energy's
        std::vector<std::vector<double>> bend;  // how that bends; its lower triangle
    };
    std::size_t place_of(const ToolProxy& tool) const;
    double energy(const std::vector<Pose>& poses, const std::vector<Pose>& hands, double springs,
                  Slope* slope) const;

    std::vector<Held> held_;
    std::vector<std::unique_ptr<ToolPair>> pairs_;
    std::vector<TriangleMesh> walls_;  // in the world
    std::vector<std::shared_ptr<const TouchShape>> wall_shapes_;
    TouchScene scene_{16, 16};
    ToolGroup group_;
};

struct PairFigures {
    ToolFigures tool;             // `force_error` and `torque_error` against slow_balance
    double balance_error = 0.0;   // of both hands' wrenches about one place beside each other (unit: percent)
    double friction_error = 0.0;  // of Coulomb's force where one tool slides on the other (unit: percent)
};

// Two blocks that are pressed onto each other askew and held, with stiffnesses of this ratio.
PairFigures press_pair(double ratio, std::uint64_t seed);
// One rubbed over the other, turned and thrown against it by hands that go through it.
PairFigures rub_pair(int ticks, int judged, std::uint64_t seed);
// One slides on the other, flat.
PairFigures slide_pair();

}  // namespace tactus::shared
