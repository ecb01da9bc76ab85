// What a tree knows of the triangles of a pack beside their corners: which they are in the mesh, who their
// neighbours are, and which edges and corners they answer for.
//
// Many triangles share an edge or corner; one of them owns it, so that what touches it there is one contact.
// From a side on which the surface is flat or concave there, some face is always nearer: then nobody does.
//
// Edge k of a triangle runs from corner k to corner (k + 1) % 3. The front is where cross(b - a, c - a)
// points. A slot is pack * lane_count + lane. Lanes that fill up a pack repeat its last triangle, labels and
// all.
#pragma once

#include <array>

#include "core/math/lanes.hpp"

namespace tactus {

constexpr unsigned front_side = 1;
constexpr unsigned back_side = 2;
constexpr unsigned both_sides = front_side | back_side;

// The edges and corners that a triangle owns, and from which sides they can be nearest to anything. The sides
// only save work: whether a point is nearest to an edge or corner is asked of those around it.
struct OwnedFeatures {
    std::uint16_t bits = 0;

    unsigned edge_sides(int k) const { return (bits >> (2 * k)) & 3u; }
    unsigned corner_sides(int k) const { return (bits >> (6 + 2 * k)) & 3u; }
    // The triangles at this corner are no single closed fan: who owns it, and each edge without a neighbour,
    // is to be found out among the triangles at hand. All of them have both sides set.
    bool is_undecided(int k) const { return corner_sides(k) != 0 && (bits >> (12 + k) & 1u) == 0; }

    void set_edge(int k, unsigned sides) { bits = replaced(2 * k, 3u, sides); }
    void set_corner(int k, unsigned sides, bool decided) {
        bits = replaced(6 + 2 * k, 3u, sides);
        bits = replaced(12 + k, 1u, decided ? 1u : 0u);
    }
    // As it is while the shape is not known: from either side.
    void forget_sides(const std::array<bool, 3>& owns_edge) {
        for (int k = 0; k < 3; ++k) {
            set_edge(k, owns_edge[static_cast<std::size_t>(k)] ? both_sides : 0);
            if (bits >> (12 + k) & 1u) {
                set_corner(k, both_sides, true);
            }
        }
    }

private:
    std::uint16_t replaced(int shift, unsigned mask, unsigned value) const {
        return static_cast<std::uint16_t>((bits & ~(mask << shift)) | value << shift);
    }
};

// A triangle and one of its edges.
struct EdgeLink {
    static constexpr std::uint32_t none = 0xffff'ffffu;
    std::uint32_t packed = none;

    static EdgeLink to(std::uint32_t triangle, unsigned edge) { return {triangle << 2 | edge}; }
    bool exists() const { return packed != none; }
    std::uint32_t triangle() const { return packed >> 2; }  // or its slot
    int edge() const { return static_cast<int>(packed & 3u); }
};

struct PackLabels {
    std::uint32_t triangle[lane_count];  // of the mesh
    // By edge: the one triangle on its other side, as a slot. None where there is no, or more than one.
    EdgeLink neighbour[3][lane_count];
    OwnedFeatures owned[lane_count];
};

}  // namespace tactus
