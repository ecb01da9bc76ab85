// What a soft model is put together from. Private to core/soft.
#pragma once

#include "core/soft/soft_model.hpp"

namespace tactus {

struct SoftDraft {
    struct Spring {
        std::array<std::uint32_t, 4> node{};
        std::array<double, 4> share{};
        double stiffness = 0.0, length = 0.0;
    };

    // A box of a lattice. Corner c lies at (c & 1, c >> 1 & 1, c >> 2) of its size.
    struct Cell {
        std::array<std::uint32_t, 8> node{};
        double filled = 1.0;  // share of it that is made of something, above 0
    };

    std::vector<Vec3> nodes;
    std::vector<double> mass;             // of the nodes
    std::vector<Tetrahedron> tetrahedra;  // wound right
    std::vector<Cell> cells;
    Vec3 cell_size{0.0};  // of all cells (unit: meters)
    std::vector<Spring> springs;
    std::vector<SoftAnchor> anchors;
    TriangleMesh surface;

    std::size_t element_count() const { return tetrahedra.size() + cells.size() + springs.size(); }
};

double tetrahedron_volume(std::span<const Vec3> nodes, const Tetrahedron& corners);

// Of a design of their form, whose material is sound.
struct SoftDraftResult {
    SoftDraft draft;
    std::string error;  // what is wrong with the mesh and what to do; else empty
};
SoftDraftResult draft_volume(const SoftDesign& design);
SoftDraftResult draft_sheet(const SoftDesign& design);
SoftDraftResult draft_tetrahedra(const SoftDesign& design);

}  // namespace tactus
