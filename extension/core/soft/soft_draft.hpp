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

    std::vector<Vec3> nodes;
    std::vector<double> mass;             // of the nodes
    std::vector<Tetrahedron> tetrahedra;  // wound right
    std::vector<double> filled;           // share of each that is made of something, above 0
    std::vector<Spring> springs;
    std::vector<SoftAnchor> anchors;
    TriangleMesh surface;
};

// What is wrong with the material or the time of a step; else empty.
std::string check_soft_material(const SoftMaterial& material, double seconds);

double tetrahedron_volume(std::span<const Vec3> nodes, const Tetrahedron& corners);

// Brings the nodes into order, fills the groups and factors the matrix.
SoftModelResult assemble(SoftDraft&& draft, const SoftMaterial& material, const HeldParts& held,
                         double seconds);

// The cells of a lattice that a closed surface fills or cuts. An error says what is wrong with the surface.
struct CellDraft {
    SoftDraft draft;
    std::string error;
};
CellDraft fill_with_cells(const TriangleMesh& surface, int cells, double density);

}  // namespace tactus
