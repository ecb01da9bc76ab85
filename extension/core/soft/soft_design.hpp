// What a body that gives is made from: plain values, in the body's own frame, in meters.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"

namespace tactus {

struct SoftMaterial {
    double stiffness = 2e4;      // Young's modulus (unit: pascals), 1e2 to 1e7
    double poisson_ratio = 0.3;  // how much it keeps its volume (dimensionless), 0 to 0.45; of cloth: 1/3
    double density = 1000.0;     // (unit: kilograms per cubic meter), 1 to 3e4
    double thickness = 1e-3;     // of cloth (unit: meters), 1e-5 to 0.1
    // Stress by the rate of strain over that by strain: how long what is pressed in at once takes to yield
    // (unit: seconds), 0 to 1.
    double damping = 2e-3;
    double drag = 0.5;      // dv/dt = -c v (unit: 1/seconds), 0 to 1000
    double friction = 0.5;  // on what it lies on (dimensionless), 0 to 10

    bool operator==(const SoftMaterial&) const = default;
};

// What is held in place: nodes inside of the box, and what the vertices of the surface hang on.
struct HeldParts {
    Vec3 low{1.0}, high{-1.0};  // (unit: meters); low > high: no box
    std::vector<std::uint32_t> vertices;

    bool holds(const Vec3& place) const {
        return place.x >= low.x && place.y >= low.y && place.z >= low.z && place.x <= high.x &&
               place.y <= high.y && place.z <= high.z;
    }
};

// Four corners of a tetrahedron, with (x1 - x0) . ((x2 - x0) x (x3 - x0)) > 0.
using Tetrahedron = std::array<std::uint32_t, 4>;

// What a model is made from. The same makes the same one, to the last bit.
struct SoftDesign {
    enum class Form : std::uint8_t {
        volume,      // cut into cells of about the `cells`th part of its longest side; cells that the
                     // surface cuts count by their share of the volume
        sheet,       // cloth, or any other: it stretches along its edges and bends across them
        tetrahedra,  // that are given; touched where no two of them meet
    };

    Form form = Form::volume;
    TriangleMesh surface;  // of a volume or a sheet
    int cells = 8;
    std::vector<Vec3> points;             // corners of the tetrahedra
    std::vector<Tetrahedron> tetrahedra;  // that are given
    SoftMaterial material;
    HeldParts held;
    double seconds = 1e-3;  // of a step
};

}  // namespace tactus
