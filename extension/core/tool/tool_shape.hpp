// A rigid tool as spheres: inscribed in its mesh, so that it never is larger than it looks, and so many that
// no point of its surface lies farther outside of them than a tolerance. Made off the loop.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"

namespace tactus {

struct ToolSphere {
    Vec3 center{0.0};     // in the tool's frame (unit: meters)
    double radius = 0.0;  // (unit: meters), > 0
};

struct ToolShape {
    std::vector<ToolSphere> spheres;
    double tolerance = 0.0;  // no point of the mesh's surface is farther outside of them (unit: meters)
    double reach = 0.0;      // of the spheres from the tool's origin (unit: meters)
    // Whose surface other tools meet; null: they pass through, unless their own mesh is known.
    std::shared_ptr<const TriangleMesh> mesh;
};

// Two spheres that do not meet, by their places among them: what is between them is the tool as well.
struct ToolBridge {
    std::uint32_t first = 0, second = 0;
};

// So many, and as short as can be, that all spheres hang together. Where no surface meets a sphere or the
// middle of a bridge, all of the tool is on one side of it.
std::vector<ToolBridge> bridges_between(std::span<const ToolSphere> spheres);

struct ToolShapeSettings {
    double tolerance = 1e-3;        // that is wanted (unit: meters), > 0
    std::size_t max_spheres = 500;  // where more would be needed, a larger tolerance is taken
};

struct ToolShapeResult {
    std::shared_ptr<const ToolShape> shape;  // null where there is an error
    std::string error;                       // what is wrong and what to do
};

// Refuses what check_mesh refuses, what is not closed, and what has no inside.
ToolShapeResult make_tool_shape(std::shared_ptr<const TriangleMesh> mesh,
                                const ToolShapeSettings& settings = {});
ToolShapeResult make_tool_shape(const TriangleMesh& mesh, const ToolShapeSettings& settings = {});

}  // namespace tactus
