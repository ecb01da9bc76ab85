#include "core/mesh/iso_surface.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/mesh/padded_field.hpp"

namespace tactus {

namespace {

constexpr std::size_t max_triangles = std::size_t{1} << 24;
constexpr std::uint32_t no_vertex = 0xffff'ffffu;

// Corner c of a cell is its sample at (c & 1, c >> 1 & 1, c >> 2 & 1). An edge is known by its lower corner
// and its axis.
constexpr int edge_ids = 24;

constexpr int edge_between(int c, int d) {
    return (c & d) * 3 + std::countr_zero(static_cast<unsigned>(c ^ d));
}

using CellFace = std::array<int, 4>;  // corners, counter-clockwise seen from outside of the cell

constexpr std::array<CellFace, 6> make_faces() {
    std::array<CellFace, 6> faces{};
    for (int axis = 0; axis < 3; ++axis) {
        const int u = 1 << (axis + 1) % 3;
        const int v = 1 << (axis + 2) % 3;
        const int side = 1 << axis;
        faces[static_cast<std::size_t>(2 * axis)] = {0, v, u | v, u};
        faces[static_cast<std::size_t>(2 * axis + 1)] = {side, side | u, side | u | v, side | v};
    }
    return faces;
}

constexpr std::array<CellFace, 6> faces = make_faces();

// The corners of one closed line in which the surface leaves a cell.
struct Outline {
    std::array<std::uint32_t, 12> corners{};
    int count = 0;

    // Edges that end in one vertex have it once.
    void add(std::uint32_t corner) {
        if (count == 0 || corners[static_cast<std::size_t>(count - 1)] != corner) {
            corners[static_cast<std::size_t>(count++)] = corner;
        }
    }
    std::uint32_t at(int i) const { return corners[static_cast<std::size_t>(i % count)]; }
};

class Extraction {
public:
    explicit Extraction(const SampledField& field) : field_(field) {}

    // False where there are too many triangles.
    bool run() {
        fill(0);
        for (std::uint32_t z = 0; z + 1 < field_.size()[2]; ++z) {
            fill(z + 1);
            for (std::uint32_t y = 0; y + 1 < field_.size()[1]; ++y) {
                add_row(y, z);
            }
            if (mesh_.triangles.size() > max_triangles) {
                return false;
            }
        }
        return true;
    }
    TriangleMesh take() { return std::move(mesh_); }

private:
    using Place = PaddedField::Place;

    struct Cell {
        Place place;  // of its lowest corner
        std::array<double, 8> levels;
    };

    // What is known of one layer of samples along z.
    struct Layer {
        std::vector<std::uint8_t> inside;
        // Vertices on the edges that leave each sample along x, y and z, and at the sample itself.
        std::array<std::vector<std::uint32_t>, 4> vertices;
    };

    std::size_t in_layer(std::uint32_t x, std::uint32_t y) const {
        return std::size_t{field_.size()[0]} * y + x;
    }
    Layer& layer(std::uint32_t z) { return layers_[z & 1u]; }

    void fill(std::uint32_t z) {
        Layer& filled = layer(z);
        const std::size_t count = std::size_t{field_.size()[0]} * field_.size()[1];
        filled.inside.resize(count);
        for (std::uint32_t y = 0; y < field_.size()[1]; ++y) {
            for (std::uint32_t x = 0; x < field_.size()[0]; ++x) {
                filled.inside[in_layer(x, y)] = field_.level({x, y, z}) < 0.0;
            }
        }
        for (std::vector<std::uint32_t>& vertices : filled.vertices) {
            vertices.assign(count, no_vertex);
        }
    }

    void add_row(std::uint32_t y, std::uint32_t z) {
        const std::uint8_t* const rows[] = {
            &layer(z).inside[in_layer(0, y)], &layer(z).inside[in_layer(0, y + 1)],
            &layer(z + 1).inside[in_layer(0, y)], &layer(z + 1).inside[in_layer(0, y + 1)]};
        for (std::uint32_t x = 0; x + 1 < field_.size()[0]; ++x) {
            unsigned inside = 0;
            for (unsigned i = 0; i < 4; ++i) {
                inside |= (rows[i][x] | static_cast<unsigned>(rows[i][x + 1]) << 1u) << 2u * i;
            }
            if (inside != 0 && inside != 0xffu) {
                add_cell({x, y, z}, inside);
            }
        }
    }

    static Place corner_of(const Place& cell, int c) {
        const auto bits = static_cast<std::uint32_t>(c);
        return {cell[0] + (bits & 1u), cell[1] + (bits >> 1u & 1u), cell[2] + (bits >> 2u & 1u)};
    }

    // On every face the surface goes from an edge on which a walk around the face enters the solid to one on
    // which it leaves it. Of the two faces at an edge, one enters there: the lines close.
    void add_cell(const Place& place, unsigned inside) {
        Cell cell{place, {}};
        for (int c = 0; c < 8; ++c) {
            cell.levels[static_cast<std::size_t>(c)] = field_.level(corner_of(place, c));
        }
        std::array<int, edge_ids> next{};
        unsigned open = 0;  // edges that no outline has had yet
        for (const CellFace& face : faces) {
            join_on(face, cell, inside, next, open);
        }
        while (open != 0) {
            Outline outline;
            for (int edge = std::countr_zero(open); (open >> edge & 1u) != 0;
                 edge = next[static_cast<std::size_t>(edge)]) {
                open &= ~(1u << edge);
                outline.add(vertex_on(cell, edge));
            }
            outline.count -= outline.count > 1 && outline.corners[0] == outline.at(outline.count - 1);
            cut(outline, cell);
        }
    }

    void join_on(const CellFace& face, const Cell& cell, unsigned inside, std::array<int, edge_ids>& next,
                 unsigned& open) const {
        const auto is_in = [&](int k) { return (inside >> face[static_cast<std::size_t>(k & 3)] & 1u) != 0; };
        const auto edge = [&](int k) {
            return edge_between(face[static_cast<std::size_t>(k & 3)],
                                face[static_cast<std::size_t>((k + 1) & 3)]);
        };
        const bool alternates = is_in(0) == is_in(2) && is_in(1) == is_in(3) && is_in(0) != is_in(1);
        const bool joined = alternates && joins_inside(face, cell);
        for (int k = 0; k < 4; ++k) {
            if (is_in(k) || !is_in(k + 1)) {
                continue;
            }
            int leaving = k + 1;
            if (joined) {
                leaving = k + 3;
            } else {
                while (!is_in(leaving) || is_in(leaving + 1)) {
                    ++leaving;
                }
            }
            next[static_cast<std::size_t>(edge(k))] = edge(leaving);
            open |= 1u << edge(k);
        }
    }

    // Where two corners across are inside and two are not, the bilinear field decides by its value at the
    // saddle, (ac - bd) / (a + c - b - d). Both cells at the face see the same numbers.
    static bool joins_inside(const CellFace& face, const Cell& cell) {
        const auto value = [&](std::size_t k) { return cell.levels[static_cast<std::size_t>(face[k])]; };
        const double even = value(0) * value(2);
        const double odd = value(1) * value(3);
        return value(0) < 0.0 ? even > odd : odd > even;
    }

    // A crossing at a sample is one vertex for all edges there, so that none of the triangles has no size.
    std::uint32_t vertex_on(const Cell& cell, int edge) {
        const int low = edge / 3;
        const int axis = edge % 3;
        const int high = low | 1 << axis;
        const bool low_in = cell.levels[static_cast<std::size_t>(low)] < 0.0;
        const int in = low_in ? low : high;
        const int out = low_in ? high : low;
        const double from = cell.levels[static_cast<std::size_t>(in)];
        const double to = cell.levels[static_cast<std::size_t>(out)];
        const Place start = corner_of(cell.place, in);
        const Place end = corner_of(cell.place, out);
        const bool at_start = std::isinf(to);
        const bool at_sample = at_start || to == 0.0;
        const Place owner = at_sample ? (at_start ? start : end) : corner_of(cell.place, low);
        std::uint32_t& vertex =
            layer(owner[2])
                .vertices[at_sample ? 3 : static_cast<std::size_t>(axis)][in_layer(owner[0], owner[1])];
        if (vertex == no_vertex) {
            vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
            const double share = at_start ? 0.0 : from / (from - to);
            mesh_.vertices.push_back(field_.position(start) +
                                     (field_.position(end) - field_.position(start)) * share);
        }
        return vertex;
    }

    // Trilinear; of a cell all of whose corners are samples.
    double level_at(const Cell& cell, const Vec3& point) const {
        const Vec3 share = (point - field_.position(cell.place)) / field_.spacing();
        const auto along = [](double a, double b, double t) { return a + (b - a) * t; };
        double rows[4];
        for (std::size_t i = 0; i < 4; ++i) {
            rows[i] = along(cell.levels[2 * i], cell.levels[2 * i + 1], share.x);
        }
        return along(along(rows[0], rows[1], share.y), along(rows[2], rows[3], share.y), share.z);
    }

    // A fan from the corner whose diagonals keep nearest to the field. In the flat cells at the border every
    // one lies in the surface.
    void cut(const Outline& outline, const Cell& cell) {
        if (outline.count < 3) {
            return;
        }
        const bool is_flat = std::ranges::any_of(cell.levels, [](double level) { return std::isinf(level); });
        int best = 0;
        double least = std::numeric_limits<double>::infinity();
        for (int apex = 0; apex < outline.count && outline.count > 3 && !is_flat; ++apex) {
            double worst = 0.0;
            for (int i = 2; i + 1 < outline.count; ++i) {
                const Vec3 middle =
                    0.5 * (mesh_.vertices[outline.at(apex)] + mesh_.vertices[outline.at(apex + i)]);
                worst = std::max(worst, std::abs(level_at(cell, middle)));
            }
            if (worst < least) {
                least = worst;
                best = apex;
            }
        }
        for (int i = 1; i + 1 < outline.count; ++i) {
            const std::uint32_t a = outline.at(best);
            const std::uint32_t b = outline.at(best + i);
            const std::uint32_t c = outline.at(best + i + 1);
            if (a != b && b != c && c != a) {
                mesh_.triangles.push_back({a, b, c});
            }
        }
    }

    PaddedField field_;
    std::array<Layer, 2> layers_;
    TriangleMesh mesh_;
};

}  // namespace

IsoSurface iso_surface(const SampledField& field) {
    std::string error = check_field(field);
    if (!error.empty()) {
        return {{}, std::move(error)};
    }
    Extraction extraction(field);
    if (!extraction.run()) {
        return {{},
                "the surface of the field has more than 16,777,216 triangles: smooth its values, or take "
                "every second sample"};
    }
    return {extraction.take(), {}};
}

}  // namespace tactus
