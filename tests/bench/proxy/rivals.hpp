// One query of somebody else over the segments of the proxy's ticks: Jolt's sphere cast, also of a Jolt
// without its deterministic mode, and Bullet's convex sweep.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"

namespace tactus::bench {

struct Segment {
    Vec3 from, to;
};

class Rival {
public:
    virtual ~Rival() = default;
    virtual void cast(const Segment& segment) = 0;

    std::string name;  // of the query, as in its key: jolt_cast, jolt_fast_cast, bullet_sweep
};

// Those that are there, over one mesh.
std::vector<std::unique_ptr<Rival>> make_rivals(const TriangleMesh& mesh, double radius);

}  // namespace tactus::bench
