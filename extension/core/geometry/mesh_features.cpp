#include "core/geometry/mesh_features.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/geometry/same_places.hpp"

namespace tactus {

namespace {

using Corners = std::array<std::uint32_t, 3>;

constexpr std::size_t part_size = std::size_t{1} << 15;  // triangles or vertices a task looks at
constexpr std::size_t range_count = 2;                   // ranges of vertices that are sorted side by side

constexpr int next_of(int k) {
    return k == 2 ? 0 : k + 1;
}
constexpr int before(int k) {
    return k == 0 ? 2 : k - 1;
}

// The corners of all triangles by vertex: those of v are corner[first[v]] … corner[first[v + 1] - 1], the
// last triangle first.
struct CornersByVertex {
    std::vector<std::uint32_t> first;
    std::vector<EdgeLink> corner;  // a triangle and the edge that leaves this corner

    std::span<const EdgeLink> at(std::size_t v) const {
        return std::span(corner).subspan(first[v], first[v + 1] - first[v]);
    }
};

CornersByVertex sort_corners(const std::vector<Corners>& triangles, std::size_t vertex_count,
                             const ParallelRunner& run) {
    CornersByVertex sorted{std::vector<std::uint32_t>(vertex_count + 1),
                           std::vector<EdgeLink>(3 * triangles.size())};
    const std::size_t range = vertex_count / range_count + 1;
    const auto visit = [&](std::size_t task, auto&& visitor) {
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            for (unsigned k = 0; k < 3; ++k) {
                const std::uint32_t v = triangles[t][k];
                if (v - task * range < range) {
                    visitor(v, EdgeLink::to(t, k));
                }
            }
        }
    };
    run(range_count,
        [&](std::size_t task) { visit(task, [&](std::uint32_t v, EdgeLink) { ++sorted.first[v]; }); });
    std::uint32_t sum = 0;
    for (std::uint32_t& first : sorted.first) {
        sum += first;
        first = sum;
    }
    // Each list is filled from its end; then `first` is where it begins.
    run(range_count, [&](std::size_t task) {
        visit(task, [&](std::uint32_t v, EdgeLink corner) { sorted.corner[--sorted.first[v]] = corner; });
    });
    return sorted;
}

class FeatureFinder {
public:
    FeatureFinder(const TriangleMesh& mesh, const ParallelRunner& run)
        : mesh_(mesh),
          run_(run),
          triangles_(mesh.triangles.size()),
          is_needle_(mesh.triangles.size()),
          found_(mesh.triangles.size()) {
        const std::vector<std::uint32_t> same = same_places(mesh.vertices, run);
        for_triangles([&](std::uint32_t t) {
            for (std::size_t k = 0; k < 3; ++k) {
                triangles_[t][k] = same[mesh.triangles[t][k]];
            }
            is_needle_[t] = is_needle(t);
        });
        corners_ = sort_corners(triangles_, mesh.vertices.size(), run);
    }

    std::vector<TriangleFeatures> find() {
        run_in_parts(run_, mesh_.vertices.size(), part_size,
                     [&](std::size_t, std::size_t v, std::size_t end) {
                         std::vector<HalfEdge> leaving;
                         for (; v < end; ++v) {
                             link_edges_from(static_cast<std::uint32_t>(v), leaving);
                         }
                     });
        bends_.resize(triangles_.size());
        for_triangles([&](std::uint32_t t) {
            for (int k = 0; k < 3; ++k) {
                bends_[t][static_cast<std::size_t>(k)] = bend_across(t, k);
            }
        });
        corner_states_.resize(triangles_.size());
        run_in_parts(run_, mesh_.vertices.size(), part_size,
                     [&](std::size_t, std::size_t v, std::size_t end) {
                         for (; v < end; ++v) {
                             decide_corner(corners_.at(v));
                         }
                     });
        for_triangles([&](std::uint32_t t) { set_owned(t); });
        return std::move(found_);
    }

private:
    struct HalfEdge {
        std::uint32_t to;  // its other vertex
        EdgeLink edge;
    };

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

    // Of the edges between v and a higher vertex, those that two triangles share are linked.
    void link_edges_from(std::uint32_t v, std::vector<HalfEdge>& leaving) {
        leaving.clear();
        for (const EdgeLink corner : corners_.at(v)) {
            const auto& ends = triangles_[corner.triangle()];
            for (const int k : {corner.edge(), before(corner.edge())}) {
                const std::uint32_t to = ends[static_cast<std::size_t>(k == corner.edge() ? next_of(k) : k)];
                if (to > v) {
                    leaving.push_back({to, EdgeLink::to(corner.triangle(), static_cast<unsigned>(k))});
                }
            }
        }
        std::ranges::sort(leaving, [](const HalfEdge& p, const HalfEdge& q) {
            return p.to != q.to ? p.to < q.to : p.edge.packed < q.edge.packed;
        });
        for (std::size_t i = 0, end = 0; i < leaving.size(); i = end) {
            for (end = i + 1; end < leaving.size() && leaving[end].to == leaving[i].to; ++end) {
            }
            const EdgeLink one = leaving[i].edge;
            const EdgeLink other = leaving[end - 1].edge;
            if (end - i == 2 && one.triangle() != other.triangle() && !is_needle_[one.triangle()] &&
                !is_needle_[other.triangle()]) {
                found_[one.triangle()].neighbour[one.edge()] = other;
                found_[other.triangle()].neighbour[other.edge()] = one;
            }
        }
    }

    Bend bend_across(std::uint32_t t, int k) const {
        constexpr double flat = 1e-7;  // sine below which an edge is flat
        constexpr double gentle = 0.87;
        const EdgeLink other = found_[t].neighbour[k];
        if (!other.exists() || other.triangle() < t) {
            return {};
        }
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

    // Of the triangle that owns it.
    const Bend& bend_of(std::uint32_t t, int k) const {
        const EdgeLink other = found_[t].neighbour[k];
        return other.exists() && other.triangle() < t
                   ? bends_[other.triangle()][static_cast<std::size_t>(other.edge())]
                   : bends_[t][static_cast<std::size_t>(k)];
    }

    // Whether the way across the edges around the corner comes to all its triangles and back to the first.
    bool is_closed_fan(std::span<const EdgeLink> corners) const {
        std::uint32_t t = corners[0].triangle();
        const std::uint32_t v = triangles_[t][static_cast<std::size_t>(corners[0].edge())];
        int k = corners[0].edge();  // the edge of t to cross next
        std::size_t count = 0;
        do {
            const EdgeLink across = found_[t].neighbour[k];
            if (!across.exists() || ++count > corners.size()) {
                return false;
            }
            t = across.triangle();
            const int entered = across.edge();
            const bool starts_here = triangles_[t][static_cast<std::size_t>(entered)] == v;
            k = starts_here ? before(entered) : next_of(entered);
        } while (t != corners[0].triangle());
        return count == corners.size();
    }

    // In a gentle fan of few triangles, all of them look the same way: what is convex from the front of one
    // is so from all.
    void decide_corner(std::span<const EdgeLink> corners) {
        constexpr std::size_t few = 7;
        if (corners.empty()) {
            return;
        }
        const auto state_of = [&](EdgeLink corner) -> CornerState& {
            return corner_states_[corner.triangle()][static_cast<std::size_t>(corner.edge())];
        };
        if (!is_closed_fan(corners)) {
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
                const Bend& bend = bend_of(corner.triangle(), k);
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
    std::vector<Corners> triangles_;  // their corners as places: vertices that stand for all at theirs
    std::vector<std::uint8_t> is_needle_;
    CornersByVertex corners_;
    std::vector<TriangleFeatures> found_;
    std::vector<std::array<Bend, 3>> bends_;  // by edge, of the triangle that owns it
    std::vector<std::array<CornerState, 3>> corner_states_;
};

}  // namespace

std::vector<TriangleFeatures> find_features(const TriangleMesh& mesh, const ParallelRunner& run) {
    return FeatureFinder(mesh, run).find();
}

}  // namespace tactus
