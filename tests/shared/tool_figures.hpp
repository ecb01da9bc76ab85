// Tools in scenes at rest, judged by code that shares nothing with ToolProxy: every sphere against every
// triangle.
#pragma once

#include <memory>
#include <vector>

#include "core/haptics/touch_scene.hpp"
#include "core/tool/tool_proxy.hpp"

namespace tactus::shared {

// Closed, around the y axis, of 2 sectors (rings + 1) triangles and two caps.
TriangleMesh peg_mesh(double radius, double half_height, int sectors, int rings);

// Closed: a block of the given half width with a hole of the given radius along y, open at both ends.
TriangleMesh hole_mesh(double radius, double half_width, double half_height, int sectors);

// A tool and meshes that stand still.
class ToolRig {
public:
    // The tool's shape has to be one.
    ToolRig(const TriangleMesh& tool, const ToolShapeSettings& sampling, const ToolSettings& settings = {});

    void add(const TriangleMesh& mesh, const TouchMaterial& material = {}, const Pose& pose = {});
    // Its way in the coming tick.
    void carry(std::size_t mesh, const Pose& pose);
    ToolTick tick(const Pose& hand);

    // The least of all spheres' distances to the meshes, less their radii (unit: meters).
    double least_gap() const;

    ToolProxy& proxy() { return *proxy_; }
    const TouchScene& scene() const { return scene_; }

    struct Balance {
        Vec3 force{0.0};   // on the hand (unit: newtons)
        Vec3 torque{0.0};  // (unit: newton meters)
    };
    // What the hand feels where coupling and surfaces are in balance, frictionless: the energy of the
    // coupling and of springs at every sphere and triangle that are too near, descended by Gauss and Newton's
    // steps from where the tool is, with stiffer and stiffer springs: stiff ones, so that it stays in the
    // hollow it is in.
    Balance slow_balance(const Pose& hand) const;

private:
    struct Wall {
        TriangleMesh local;
        TriangleMesh mesh;  // in the world
        Pose pose;
        bool moves = false;
        int body = -1;
    };
    static void place(Wall& wall);
    struct Slope {
        Vector6 down{};  // the energy's, and how it bends
        Matrix6 bend{};
    };
    double energy(const Pose& pose, const Pose& hand, double springs, Slope* slope = nullptr) const;

    ToolSettings settings_;
    std::shared_ptr<const ToolShape> shape_;
    std::unique_ptr<ToolProxy> proxy_;
    std::vector<std::shared_ptr<const TouchShape>> shapes_;
    std::vector<Wall> walls_;
    TouchScene scene_{16, 16};
};

struct ToolFigures {
    int ticks = 0;
    int contact_ticks = 0;
    int unfinished = 0;
    int penetrations =
        0;             // ticks with a sphere in a surface; of bodies that move, by more than the tolerance
    int passes = 0;    // plays that ended where the tool cannot have come
    int arrivals = 0;  // plays that ended where the tool should have come
    int plays = 0;
    double deepest = 0.0;              // of a penetration (unit: meters)
    double still_way = 0.0;            // that the tool moves while the hand is still (unit: meters)
    double force_error = 0.0;          // the largest, against slow_balance (unit: percent)
    double torque_error = 0.0;         // likewise
    std::vector<double> microseconds;  // of each tick in contact

    void add(const ToolFigures& other);
};

// A peg of 20,000 triangles with 0.1 mm to spare is led to its hole at an angle, pressed against the rim,
// turned upright and pushed in. `tilt` and `around` in radians; `judged`: how many of its ticks are looked at
// closely; `compared`: force and torque at its end with slow_balance.
ToolFigures play_peg(double tilt, double around, int judged, bool compared = false);

// A rough tool is drawn over a rough body by a hand that goes into it, and turned fast.
ToolFigures play_rough(const TriangleMesh& tool, const TriangleMesh& body, int ticks, int judged,
                       std::uint64_t seed);

}  // namespace tactus::shared
