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

#include "core/geometry/local_compliance.hpp"
#include "core/mesh/triangle_mesh.hpp"
#include "core/soft/rotation_lanes.hpp"
#include "core/soft/soft_design.hpp"
#include "core/soft/sparse_factor.hpp"

namespace tactus {

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

// Four cells of a lattice, boxes at rest. F is the mean over the cell: along each axis, the sum over the four
// edges. Corners as in SoftDraft::Cell.
struct CellGroup {
    std::array<std::array<std::uint32_t, 4>, 8> node{};  // by corner and lane
    LanesVec3 slope;                                     // a quarter over the edges (unit: 1/meter)
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
    std::vector<double> firmness;    // diagonal of the matrix of every step (unit: newtons per meter)
    std::vector<std::uint8_t> held;  // by node: not 0 where it stays
    FreeTurn free_turn;
    std::vector<TetGroup> tetrahedra;
    std::vector<CellGroup> cells;
    std::vector<SpringGroup> springs;
    std::vector<SoftAnchor> anchors;  // by vertex of the surface
    TriangleMesh surface;             // at rest
    std::size_t element_count = 0;    // tetrahedra, cells and springs
    bool closed = false;              // the surface bounds a volume
    LocalCompliance give;             // under a sphere that presses it, of a body of cells
    SparseFactor factor;
    double size = 0.0;  // diagonal of the box around it (unit: meters)
    // After so many iterations a step leaves at most a fiftieth of what the bound adds to the inertia of a
    // turn of its parts.
    int wanted_iterations = 1;
    SoftDesign design;

    // What an iteration and a solve take, about (docs/soft.md; unit: seconds). Part of the results, as any
    // budget: not to be measured where it runs.
    double solve_time() const { return 1.5e-9 * static_cast<double>(factor.entries()); }
    double iteration_time() const { return 26e-9 * static_cast<double>(element_count) + solve_time(); }
    // As many as are wanted and fit in `seconds`; at least one.
    int iterations_within(double seconds) const;

    double total_mass() const;
    bool is_free() const;  // held nowhere
};

// What a tick has time for.
constexpr std::size_t max_soft_elements = 12'000;
constexpr std::size_t max_soft_nodes = 4'096;
constexpr std::size_t max_factor_entries = 250'000;
constexpr double max_iteration_time = 1e-4;  // of all iterations, beyond the first (unit: seconds)

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
