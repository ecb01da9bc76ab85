// A body that gives, made ready for its steps: what it is made of, where it is held, how its surface hangs on
// its nodes, and the factor of the one matrix that every step solves with (see soft_body.hpp). Made off the
// haptic thread, immutable, shared by bodies of the same make.
//
// All in the body's own frame, in metres.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.hpp"
#include "core/soft/rotation_lanes.hpp"
#include "core/soft/sparse_factor.hpp"

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
        volume,      // cut into cells of about the `cells`th part of its longest side, those into six
                     // tetrahedra each; cells that the surface cuts count by their share of the volume
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

// A point that hangs on four nodes, or on fewer with weights of 0. The weights add up to 1.
struct SoftAnchor {
    std::array<std::uint32_t, 4> node{};
    std::array<double, 4> weight{};
};

// Four tetrahedra. F = sum over the corners of x_c (x) gradient_c; the gradient of corner 0 is what brings
// the sum of all four to 0. Lanes that fill up a group have no stiffness.
struct TetGroup {
    std::array<std::array<std::uint32_t, 4>, 4> node{};  // by corner and lane
    LanesVec3 gradient[3];                               // of corners 1 to 3 (unit: 1/meter)
    Lanes shear;                                         // 2 mu V (unit: joules)
    Lanes bulk;                                          // lambda V (unit: joules)
};

// Four springs over the sum of up to four nodes, e = sum of c_i x_i: k / 2 (|e| - L)^2. Edges stretch by two
// nodes, hinges between two triangles bend by four.
struct SpringGroup {
    std::array<std::array<std::uint32_t, 4>, 4> node{};
    Lanes share[4];   // c_i (dimensionless)
    Lanes stiffness;  // k (unit: newtons per meter)
    Lanes length;     // L (unit: meters)
};

// How a body can turn as a whole, where it is held.
struct FreeTurn {
    enum class About : std::uint8_t {
        itself,   // held nowhere
        place,    // held in one place
        line,     // held in places of one line
        nothing,  // held so that it cannot
    };

    About about = About::itself;
    Vec3 pivot{0.0};  // of a place or a line
    Vec3 axis{0.0};   // of a line, unit
};

struct SoftModel {
    std::vector<Vec3> rest;          // nodes, in the order of elimination
    std::vector<double> mass;        // of the nodes (unit: kilograms)
    std::vector<std::uint8_t> held;  // by node: not 0 where it stays
    FreeTurn free_turn;
    std::vector<TetGroup> tetrahedra;
    std::vector<SpringGroup> springs;
    std::vector<SoftAnchor> anchors;  // by vertex of the surface
    TriangleMesh surface;             // at rest
    std::size_t element_count = 0;    // tetrahedra and springs
    bool closed = false;              // the surface bounds a volume
    SparseFactor factor;
    double size = 0.0;  // diagonal of the box around it (unit: meters)
    SoftDesign design;

    double total_mass() const;
    bool is_free() const;  // held nowhere
};

// What a tick has time for.
constexpr std::size_t max_soft_elements = 12'000;
constexpr std::size_t max_soft_nodes = 4'096;
constexpr std::size_t max_factor_entries = 250'000;

struct SoftModelResult {
    std::shared_ptr<const SoftModel> model;  // null where there is an error
    std::string error;                       // what is wrong and what to do
};

SoftModelResult make_soft(SoftDesign design);

// Whether a body of the one may go on as one of the other: nodes, elements and surface are the same, only
// what they are made of differs.
bool same_structure(const SoftModel& one, const SoftModel& other);

SoftModelResult make_soft_volume(const TriangleMesh& surface, int cells, const SoftMaterial& material,
                                 const HeldParts& held, double seconds);
SoftModelResult make_soft_tetrahedra(std::span<const Vec3> vertices, std::span<const Tetrahedron> tetrahedra,
                                     const SoftMaterial& material, const HeldParts& held, double seconds);
SoftModelResult make_soft_sheet(const TriangleMesh& surface, const SoftMaterial& material,
                                const HeldParts& held, double seconds);

}  // namespace tactus
