// A closed surface filled with cells of a lattice: every cell that it cuts or holds.
//
// A cell's mean deformation does not see its four modes x y, y z, z x and x y z, in which it bends and warps.
// Springs across its faces do, each over e = x00 - x01 - x10 + x11 of the four corners. Where a cell of size
// (a, b, c) and volume V bends by u_x = s x y, its stress is E s y: the energy is V E s^2 b^2 / 24. On both
// of its faces along z e is s a b, so that k = V E / (24 a^2) each. They have no length at rest: their energy
// is quadratic, the same in all directions and 0 in each motion and in each even deformation.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "core/mesh/closed_mesh.hpp"
#include "core/mesh/mesh_check.hpp"
#include "core/soft/soft_draft.hpp"
#include "core/tree/triangle_tree.hpp"

namespace tactus {

namespace {

constexpr int max_cells = 64;          // along a side
constexpr int samples_a_side = 3;      // of a cell, to tell how much of it is filled
constexpr double least_filled = 0.05;  // of a cell that the surface cuts: no node is as light as nothing

using Cell = std::array<int, 3>;

class CellLattice {
public:
    CellLattice(const TriangleMesh& surface, int cells)
        : surface_(surface), tree_(TriangleTree::build(surface)) {
        low_ = Vec3(std::numeric_limits<double>::infinity());
        Vec3 high = -low_;
        for (const auto& triangle : surface.triangles) {
            for (const std::uint32_t corner : triangle) {
                low_ = glm::min(low_, surface.vertices[corner]);
                high = glm::max(high, surface.vertices[corner]);
            }
        }
        const Vec3 size = high - low_;
        const double edge = std::max({size.x, size.y, size.z}) / cells;
        for (int axis = 0; axis < 3; ++axis) {
            count_[static_cast<std::size_t>(axis)] =
                std::max(1, static_cast<int>(std::lround(size[axis] / edge)));
            spacing_[axis] = size[axis] / count_[static_cast<std::size_t>(axis)];
        }
    }

    bool is_flat() const { return !(spacing_.x > 0.0 && spacing_.y > 0.0 && spacing_.z > 0.0); }

    SoftDraft fill(const SoftMaterial& material) {
        density_ = material.density;
        add_anchors();
        Cell cell{};
        for (cell[2] = 0; cell[2] < count_[2]; ++cell[2]) {
            for (cell[1] = 0; cell[1] < count_[1]; ++cell[1]) {
                for (cell[0] = 0; cell[0] < count_[0]; ++cell[0]) {
                    add_cell(cell);
                }
            }
        }
        add_springs(material.stiffness);
        draft_.cell_size = spacing_;
        draft_.surface = surface_;
        return std::move(draft_);
    }

private:
    Cell cell_of(const Vec3& place) const {
        Cell cell{};
        for (int axis = 0; axis < 3; ++axis) {
            const auto k = static_cast<std::size_t>(axis);
            const int at = static_cast<int>(std::floor((place[axis] - low_[axis]) / spacing_[axis]));
            cell[k] = std::clamp(at, 0, count_[k] - 1);
        }
        return cell;
    }

    Vec3 corner_place(const Cell& corner) const {
        return low_ + spacing_ * Vec3(corner[0], corner[1], corner[2]);
    }

    std::uint32_t node_at(const Cell& corner) {
        const auto [found, is_new] =
            node_of_.try_emplace(corner, static_cast<std::uint32_t>(draft_.nodes.size()));
        if (is_new) {
            draft_.nodes.push_back(corner_place(corner));
        }
        return found->second;
    }

    // Along the axes in the order of how far the point is along each: that is the tetrahedron around it.
    void add_anchors() {
        for (const Vec3& vertex : surface_.vertices) {
            Cell corner = cell_of(vertex);
            cut_.insert(corner);
            const Vec3 inside = glm::clamp((vertex - corner_place(corner)) / spacing_, Vec3(0.0), Vec3(1.0));
            std::array<int, 3> axes{0, 1, 2};
            std::ranges::sort(axes, [&](int a, int b) { return inside[a] > inside[b]; });
            SoftAnchor anchor;
            anchor.node[0] = node_at(corner);
            anchor.weight[0] = 1.0 - inside[axes[0]];
            for (std::size_t k = 0; k < 3; ++k) {
                ++corner[static_cast<std::size_t>(axes[k])];
                anchor.node[k + 1] = node_at(corner);
                anchor.weight[k + 1] = inside[axes[k]] - (k < 2 ? inside[axes[k + 1]] : 0.0);
            }
            draft_.anchors.push_back(anchor);
        }
    }

    // Of the cell's volume, by corner: what is nearer to one counts for it by more.
    std::array<double, 8> shares_filled(const Cell& cell) const {
        constexpr int samples = samples_a_side * samples_a_side * samples_a_side;
        std::array<double, 8> shares{};
        for (int i = 0; i < samples; ++i) {
            const Vec3 at = (Vec3(i % samples_a_side, i / samples_a_side % samples_a_side,
                                  i / (samples_a_side * samples_a_side)) +
                             0.5) /
                            static_cast<double>(samples_a_side);
            WorkBudget work(1'000'000);
            if (!tree_.winding(corner_place(cell) + spacing_ * at, work).inside()) {
                continue;
            }
            for (std::size_t c = 0; c < shares.size(); ++c) {
                shares[c] += ((c & 1) != 0 ? at.x : 1.0 - at.x) * ((c & 2) != 0 ? at.y : 1.0 - at.y) *
                             ((c & 4) != 0 ? at.z : 1.0 - at.z) / samples;
            }
        }
        return shares;
    }

    void add_cell(const Cell& cell) {
        std::array<double, 8> shares = shares_filled(cell);
        const double filled = std::accumulate(shares.begin(), shares.end(), 0.0);
        if (filled == 0.0 && !cut_.contains(cell)) {
            return;
        }
        if (filled < least_filled) {
            shares.fill(least_filled / 8.0);
        }
        SoftDraft::Cell made{{}, std::max(filled, least_filled)};
        const double mass = density_ * spacing_.x * spacing_.y * spacing_.z;
        for (std::size_t c = 0; c < made.node.size(); ++c) {
            const int bits = static_cast<int>(c);
            made.node[c] = node_at({cell[0] + (bits & 1), cell[1] + (bits >> 1 & 1), cell[2] + (bits >> 2)});
            draft_.mass.resize(draft_.nodes.size(), 0.0);
            draft_.mass[made.node[c]] += mass * shares[c];
        }
        draft_.cells.push_back(made);
    }

    // Neighbors share a face, and its spring.
    void add_springs(double modulus) {
        std::map<std::array<std::uint32_t, 4>, double> stiffness_of;
        const double volume = spacing_.x * spacing_.y * spacing_.z;
        for (const SoftDraft::Cell& cell : draft_.cells) {
            for (int axis = 0; axis < 3; ++axis) {
                const std::size_t one = std::size_t{1} << (axis + 1) % 3,
                                  other = std::size_t{1} << (axis + 2) % 3;
                const double edge = std::max(spacing_[(axis + 1) % 3], spacing_[(axis + 2) % 3]);
                for (const std::size_t c : {std::size_t{0}, std::size_t{1} << axis}) {
                    stiffness_of[{cell.node[c], cell.node[c + one], cell.node[c + other],
                                  cell.node[c + one + other]}] +=
                        cell.filled * volume * modulus / (24.0 * edge * edge);
                }
            }
        }
        for (const auto& [corners, stiffness] : stiffness_of) {
            draft_.springs.push_back({corners, {1.0, -1.0, -1.0, 1.0}, stiffness, 0.0});
        }
    }

    const TriangleMesh& surface_;
    TriangleTree tree_;
    double density_ = 0.0;
    Vec3 low_{0.0};
    Vec3 spacing_{0.0};
    Cell count_{};
    std::map<Cell, std::uint32_t> node_of_;
    std::set<Cell> cut_;  // cells that hold a vertex of the surface
    SoftDraft draft_;
};

}  // namespace

SoftDraftResult draft_volume(const SoftDesign& design) {
    const TriangleMesh& surface = design.surface;
    if (std::string error = check_mesh(surface); !error.empty()) {
        return {{}, std::move(error)};
    }
    if (design.cells < 1 || design.cells > max_cells) {
        return {{}, "its number of cells is not between 1 and 64: set it so"};
    }
    if (!is_closed(surface)) {
        return {{},
                "its mesh is open and has no inside: close its holes and turn all its triangles alike, or "
                "make it a sheet"};
    }
    CellLattice lattice(surface, design.cells);
    if (lattice.is_flat()) {
        return {{}, "its mesh has no volume: give it some thickness, or make it a sheet"};
    }
    return {lattice.fill(design.material), {}};
}

}  // namespace tactus
