#include "core/geometry/mesh_features.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/geometry/corners_by_place.hpp"
#include "core/geometry/spokes.hpp"

namespace tactus {

namespace {

constexpr std::size_t part_size = std::size_t{1} << 15;  // triangles or vertices a task looks at

constexpr int next_of(int k) {
    return k == 2 ? 0 : k + 1;
}
constexpr int before(int k) {
    return k == 0 ? 2 : k - 1;
}

class FeatureFinder {
public:
    FeatureFinder(const TriangleMesh& mesh, const ParallelRunner& run)
        : mesh_(mesh),
          run_(run),
          corners_(corners_by_place(mesh, run)),
          triangles_(corners_.triangles),
          is_needle_(mesh.triangles.size()),
          found_(mesh.triangles.size()) {
        for_triangles([&](std::uint32_t t) { is_needle_[t] = is_needle(t); });
    }

    std::vector<TriangleFeatures> find() {
        has_closed_fan_.resize(mesh_.vertices.size());
        run_in_parts(run_, mesh_.vertices.size(), part_size,
                     [&](std::size_t, std::size_t v, std::size_t end) {
                         Spokes spokes;
                         for (; v < end; ++v) {
                             link_around(static_cast<std::uint32_t>(v), spokes);
                         }
                     });
        bends_.resize(triangles_.size());
        for_triangles([&](std::uint32_t t) {
            for (int k = 0; k < 3; ++k) {
                set_bend(t, k);
            }
        });
        corner_states_.resize(triangles_.size());
        run_in_parts(run_, mesh_.vertices.size(), part_size,
                     [&](std::size_t, std::size_t v, std::size_t end) {
                         for (; v < end; ++v) {
                             decide_corner(v);
                         }
                     });
        for_triangles([&](std::uint32_t t) { set_owned(t); });
        return std::move(found_);
    }

private:
    // How the surface goes on across an edge.
    struct Bend {
        std::uint8_t sides = both_sides;  // from which the edge is convex; none where it is flat
        bool gentle = false;              // by no more than a right angle's third
    };

    struct CornerState {
        std::uint8_t sides = 0;
        bool decided = false;
    };

    template <class Visit>
    void for_triangles(Visit&& visit) {
        run_in_parts(run_, triangles_.size(), part_size, [&](std::size_t, std::size_t t, std::size_t end) {
            for (; t < end; ++t) {
                visit(static_cast<std::uint32_t>(t));
            }
        });
    }

    // Corner k of a triangle.
    const Vec3& place(std::uint32_t t, int k) const {
        return mesh_.vertices[triangles_[t][static_cast<std::size_t>(k)]];
    }

    // The height of a needle is lost in rounding, and so is what lies beside which of its edges.
    bool is_needle(std::uint32_t t) const {
        constexpr double thin = 1e-6;  // height over the longest side
        const Vec3 ab = place(t, 1) - place(t, 0);
        const Vec3 bc = place(t, 2) - place(t, 1);
        const Vec3 ca = place(t, 0) - place(t, 2);
        const double longest = std::max({glm::dot(ab, ab), glm::dot(bc, bc), glm::dot(ca, ca)});
        const Vec3 across = glm::cross(ab, ca);
        return !(glm::dot(across, across) > thin * thin * longest * longest);
    }

    // Finds which two edges at v are one, links those that lead to a higher vertex, and whether the way
    // across them comes to all triangles at v and back to the first.
    void link_around(std::uint32_t v, Spokes& spokes) {
        const std::span<const EdgeLink> corners = corners_.at(v);
        spokes.begin(2 * corners.size());
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const std::uint32_t t = corners[i].triangle();
            const int k = corners[i].edge();
            spokes.to[2 * i] = triangles_[t][static_cast<std::size_t>(next_of(k))];
            spokes.to[2 * i + 1] = triangles_[t][static_cast<std::size_t>(before(k))];
        }
        spokes.pair_up();
        for (std::size_t i = 0; i < corners.size(); ++i) {
            if (is_needle_[corners[i].triangle()]) {
                spokes.part(2 * i);
                spokes.part(2 * i + 1);
            }
        }
        const auto edge_of = [&](std::size_t spoke) {
            const EdgeLink corner = corners[spoke / 2];
            const int k = spoke % 2 == 0 ? corner.edge() : before(corner.edge());
            return EdgeLink::to(corner.triangle(), static_cast<unsigned>(k));
        };
        for (std::size_t i = 0; i < 2 * corners.size(); ++i) {
            if (spokes.partner[i] != Spokes::nobody && spokes.to[i] > v) {
                const EdgeLink edge = edge_of(i);
                found_[edge.triangle()].neighbour[edge.edge()] = edge_of(spokes.partner[i]);
            }
        }
        has_closed_fan_[v] = spokes.are_one_round();
    }

    // Of an edge as the triangle that owns it sees it, for both. Without a neighbour, and for what is bent
    // too far to tell, the edge is convex from both sides.
    void set_bend(std::uint32_t t, int k) {
        const EdgeLink other = found_[t].neighbour[k];
        if (other.exists() && t < other.triangle()) {
            bends_[other.triangle()][static_cast<std::size_t>(other.edge())] =
                bends_[t][static_cast<std::size_t>(k)] = bend_across(t, k, other);
        }
    }

    Bend bend_across(std::uint32_t t, int k, EdgeLink other) const {
        constexpr double flat = 1e-7;  // sine below which an edge is flat
        constexpr double gentle = 0.87;
        const Vec3 start = place(t, k);
        const Vec3 edge = place(t, next_of(k)) - start;
        const Vec3 normal = glm::cross(edge, place(t, before(k)) - start);
        const Vec3 beyond = place(other.triangle(), before(other.edge())) - start;
        const Vec3 turned = glm::cross(beyond, edge);  // the other's normal where both wind alike
        // Cosine and sine of the angle between the faces, times the lengths of both.
        const double lengths_squared = glm::dot(normal, normal) * glm::dot(turned, turned);
        const double cosine = glm::dot(normal, turned);
        const double height = glm::dot(normal, beyond);
        const double sine_squared = height * height * glm::dot(edge, edge);
        const bool same_winding = triangles_[t][static_cast<std::size_t>(k)] !=
                                  triangles_[other.triangle()][static_cast<std::size_t>(other.edge())];
        if (!same_winding || !(cosine > 0.0) ||
            !(cosine * cosine >
              1e-6 * lengths_squared)) {  // seen from the other triangle, the side may be another
            return {};
        }
        const bool is_flat = !(sine_squared > flat * flat * lengths_squared);
        const unsigned sides = is_flat ? 0u : (height < 0.0 ? front_side : back_side);
        return {static_cast<std::uint8_t>(sides), cosine * cosine > gentle * gentle * lengths_squared};
    }

    // In a gentle fan of few triangles, all of them look the same way: what is convex from the front of one
    // is so from all.
    void decide_corner(std::size_t v) {
        constexpr std::size_t few = 7;
        const std::span<const EdgeLink> corners = corners_.at(v);
        if (corners.empty()) {
            return;
        }
        const auto state_of = [&](EdgeLink corner) -> CornerState& {
            return corner_states_[corner.triangle()][static_cast<std::size_t>(corner.edge())];
        };
        if (!has_closed_fan_[v]) {
            for (const EdgeLink corner : corners) {
                state_of(corner) = {both_sides, false};
            }
            return;
        }
        unsigned sides = 0;
        bool gentle = corners.size() <= few;
        EdgeLink owner = corners[0];
        for (const EdgeLink corner : corners) {
            for (const int k : {corner.edge(), before(corner.edge())}) {
                const Bend& bend = bends_[corner.triangle()][static_cast<std::size_t>(k)];
                sides |= bend.sides;
                gentle &= bend.gentle;
            }
            owner = corner.triangle() < owner.triangle() ? corner : owner;
        }
        state_of(owner) = {static_cast<std::uint8_t>(gentle ? sides : both_sides), true};
    }

    void set_owned(std::uint32_t t) {
        TriangleFeatures& triangle = found_[t];
        for (int k = 0; k < 3; ++k) {
            const auto index = static_cast<std::size_t>(k);
            const EdgeLink other = triangle.neighbour[k];
            const bool owns = !other.exists() || t < other.triangle();
            triangle.owned.set_edge(k, owns ? bends_[t][index].sides : 0u);
            const CornerState& corner = corner_states_[t][index];
            triangle.owned.set_corner(k, corner.sides, corner.decided);
        }
    }

    const TriangleMesh& mesh_;
    const ParallelRunner& run_;
    const CornersByPlace corners_;
    const std::vector<TriangleCorners>& triangles_;
    std::vector<std::uint8_t> is_needle_;
    std::vector<TriangleFeatures> found_;
    std::vector<std::uint8_t> has_closed_fan_;  // by vertex: its triangles are one closed fan
    std::vector<std::array<Bend, 3>> bends_;    // by edge
    std::vector<std::array<CornerState, 3>> corner_states_;
};

}  // namespace

std::vector<TriangleFeatures> find_features(const TriangleMesh& mesh, const ParallelRunner& run) {
    return FeatureFinder(mesh, run).find();
}

}  // namespace tactus
