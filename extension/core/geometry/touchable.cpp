// Faces first, then the edges and corners of triangles that cannot be touched by their faces: one that can
// be is left to a triangle that is there already, or to the first of those that share it.
#include "core/geometry/touchable.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <span>

#include "core/geometry/corner_cone.hpp"
#include "core/geometry/empty_ball.hpp"

namespace tactus {

namespace {

constexpr std::size_t part_size = 1024;  // triangles, or corners, for one thread at a time
// A corner of more triangles counts as one that can be touched: all pairs of its edges are looked at.
constexpr std::size_t max_at_corner = 24;
constexpr double least_radius = 1e-7;     // of the largest coordinate: below it rounding is not small
constexpr double worthwhile_share = 0.9;  // where more can be touched a tree of these alone is of little use
// So many corners tell what share of the faces can be touched, and what it takes to find out: one in six or
// so stands for the others at its place. Meshes of few triangles take less than a second.
constexpr std::uint64_t samples = 6'000;
constexpr std::size_t least_sampled = 16'000;
constexpr double max_work = 2e9;  // see WorkBudget

using Marks = std::vector<std::uint8_t>;  // by triangle

void mark(Marks& marks, std::uint32_t triangle) {
    std::atomic_ref(marks[triangle]).store(1, std::memory_order_relaxed);
}

bool is_face_touchable(const SharedMesh& shared, std::uint32_t triangle, EmptyBall& ball) {
    const auto& [i, k, m] = shared.mesh.triangles[triangle];
    const Vec3 a = shared.place(i), b = shared.place(k), c = shared.place(m);
    const Vec3 across = glm::cross(b - a, c - a);
    const double longest = std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)});
    const double doubt = shared.rounding * longest / std::max(glm::length(across), 1e-300);
    const auto touches_towards = [&](const Vec3& direction) {
        return ball.may_touch({{a, b, c}, 3, {direction}, 1, doubt});
    };
    const Vec3 normal = unit(across);
    return !(doubt <= max_doubt) || touches_towards(normal) || touches_towards(-normal);
}

// From the edge into the triangle, perpendicular to the edge (unit: meters).
Vec3 height_over(const SharedMesh& shared, std::uint32_t triangle, const Vec3& from, const Vec3& along) {
    Vec3 highest(0.0);
    for (const std::uint32_t corner : shared.mesh.triangles[triangle]) {
        const Vec3 way = shared.place(corner) - from;
        const Vec3 height = way - along * glm::dot(along, way);
        highest = glm::dot(height, height) > glm::dot(highest, highest) ? height : highest;
    }
    return highest;
}

// Directions across the edge that do not lead into its triangles: an arc between the normals of both, where
// they meet at an angle. Of a flat edge the faces have said all.
bool is_edge_touchable(const SharedMesh& shared, std::uint32_t from, std::uint32_t to,
                       std::span<const std::uint32_t> triangles, EmptyBall& ball) {
    const Vec3 a = shared.place(from), b = shared.place(to);
    const Vec3 along = unit(b - a);
    const Vec3 height = height_over(shared, triangles[0], a, along);
    const Vec3 other = triangles.size() > 1 ? height_over(shared, triangles[1], a, along) : height;
    const double least = std::min(glm::length(height), glm::length(other));
    const double doubt = shared.rounding / std::max(std::min(least, glm::distance(a, b)), 1e-300);
    if (!(doubt <= max_doubt) || triangles.size() > 2) {
        return true;
    }
    const Vec3 inward = unit(height), other_inward = unit(other);
    const auto touches_between = [&](const Vec3& u, const Vec3& v) {
        return ball.may_touch({{a, b}, 2, {u, v}, 2, doubt});
    };
    Vec3 first = glm::cross(along, inward);
    Vec3 second = -first;  // where the surface ends there is but one triangle
    if (triangles.size() == 2) {
        const double bend = glm::dot(first, other_inward);
        second = glm::cross(along, other_inward);
        first = bend > 0.0 ? -first : first;
        second = glm::dot(second, inward) > 0.0 ? -second : second;
        if (std::abs(bend) <= std::max(parallel_sine, doubt)) {
            return glm::dot(inward, other_inward) > 0.0;  // folded onto itself
        }
    }
    const Vec3 middle = -unit(inward + other_inward);
    return glm::dot(first, second) > 0.0 ? touches_between(first, second)
                                         : touches_between(first, middle) || touches_between(middle, second);
}

// Calls visit(other end, triangles) for each edge from the vertex to one of a higher number.
template <class Visit>
void visit_edges(const SharedMesh& shared, std::uint32_t vertex, Visit&& visit) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;  // and triangle
    for (const std::uint32_t triangle : shared.triangles_at(vertex)) {
        for (const std::uint32_t other : shared.mesh.triangles[triangle]) {
            if (other > vertex) {
                ends.emplace_back(other, triangle);
            }
        }
    }
    std::ranges::sort(ends);
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i < ends.size();) {
        const std::uint32_t end = ends[i].first;
        triangles.clear();
        for (; i < ends.size() && ends[i].first == end; ++i) {
            triangles.push_back(ends[i].second);
        }
        visit(end, std::span<const std::uint32_t>(triangles));
    }
}

class TouchableSearch {
public:
    TouchableSearch(const TriangleTree& tree, double radius, const ParallelRunner& run,
                    const StillWanted& is_wanted)
        : tree_(tree), radius_(radius), run_(run), is_wanted_(is_wanted), shared_(tree) {}

    // What the surface around a few corners, evenly chosen, says of all.
    bool is_worthwhile() {
        if (shared_.slots.size() < least_sampled) {
            return true;
        }
        EmptyBall of_faces(tree_, radius_), of_rest(tree_, radius_);
        std::size_t faces = 0, touchable = 0;
        for (std::uint64_t i = 0; i < samples; ++i) {
            const std::uint32_t corner = sampled(i);
            for (const std::uint32_t triangle : shared_.triangles_at(corner)) {
                find_face(triangle, of_faces);
                touchable += by_face_[triangle];
                ++faces;
            }
            find_edges(corner, of_rest);
            find_corner(corner, of_rest);
        }
        // Fewer edges than there are in the end leave more corners to look at: they are not taken over.
        std::ranges::fill(by_corner_, 0);
        const auto of_all = [](std::int64_t work, std::size_t looked_at, std::size_t all) {
            return static_cast<double>(work) * static_cast<double>(all) /
                   static_cast<double>(std::max<std::size_t>(looked_at, 1));
        };
        return static_cast<double>(touchable) <= worthwhile_share * static_cast<double>(faces) &&
               of_all(of_faces.work(), faces, shared_.slots.size()) +
                       of_all(of_rest.work(), samples, shared_.mesh.vertices.size()) <=
                   max_work;
    }

    std::vector<std::uint32_t> slots() {
        const std::size_t corners = shared_.mesh.vertices.size();
        in_parts(shared_.slots.size(), [this](std::uint32_t i, EmptyBall& ball) { find_face(i, ball); });
        in_parts(corners, [this](std::uint32_t i, EmptyBall& ball) { find_edges(i, ball); });
        in_parts(corners, [this](std::uint32_t i, EmptyBall& ball) { find_corner(i, ball); });
        std::vector<std::uint32_t> slots;
        for (std::size_t t = 0; t < shared_.slots.size(); ++t) {
            if (by_face_[t] || by_edge_[t] || by_corner_[t]) {
                slots.push_back(shared_.slots[t]);
            }
        }
        return slots;
    }

private:
    // Evenly spread, and in step with nothing: multiples of the golden ratio, less what is whole of them.
    std::uint32_t sampled(std::uint64_t i) const {
        const std::uint64_t share = (i * 0x9e37'79b9'7f4a'7c15u) >> 32;
        return static_cast<std::uint32_t>((share * shared_.mesh.vertices.size()) >> 32);
    }

    // Calls look(i, ball) for each, as long as the answer is wanted.
    template <class Look>
    void in_parts(std::size_t number, Look&& look) {
        run_in_parts(run_, number, part_size, [&](std::size_t, std::size_t begin, std::size_t end) {
            EmptyBall ball(tree_, radius_);
            for (std::size_t i = begin; i < end && is_wanted_(); ++i) {
                look(static_cast<std::uint32_t>(i), ball);
            }
        });
    }
    static bool is_any(const Marks& marks, std::span<const std::uint32_t> triangles) {
        return std::ranges::any_of(triangles, [&](std::uint32_t t) { return marks[t] != 0; });
    }

    void find_face(std::uint32_t triangle, EmptyBall& ball) {
        by_face_[triangle] = is_face_touchable(shared_, triangle, ball);
    }
    // Those to corners of higher numbers, once faces are known.
    void find_edges(std::uint32_t corner, EmptyBall& ball) {
        visit_edges(shared_, corner, [&](std::uint32_t end, std::span<const std::uint32_t> triangles) {
            if (!is_any(by_face_, triangles) && is_edge_touchable(shared_, corner, end, triangles, ball)) {
                mark(by_edge_, triangles.front());
            }
        });
    }
    // Once edges are known.
    void find_corner(std::uint32_t corner, EmptyBall& ball) {
        const std::span<const std::uint32_t> triangles = shared_.triangles_at(corner);
        if (!triangles.empty() && !is_any(by_face_, triangles) && !is_any(by_edge_, triangles) &&
            (triangles.size() > max_at_corner || CornerCone(shared_, corner).may_touch(ball))) {
            mark(by_corner_, triangles.front());
        }
    }

    const TriangleTree& tree_;
    const double radius_;
    const ParallelRunner& run_;
    const StillWanted& is_wanted_;
    const SharedMesh shared_;
    Marks by_face_ = Marks(shared_.slots.size(), 0);
    Marks by_edge_ = by_face_, by_corner_ = by_face_;
};

}  // namespace

std::vector<std::uint32_t> touchable_slots(const TriangleTree& tree, double radius,
                                           const ParallelRunner& run) {
    const StillWanted is_wanted = is_always_wanted;
    return TouchableSearch(tree, radius, run, is_wanted).slots();
}

std::shared_ptr<const TouchableTriangles> touchable_triangles(const TriangleTree& tree, double radius,
                                                              const ParallelRunner& run,
                                                              const StillWanted& is_wanted) {
    if (!(radius > least_radius * tree.magnitude())) {
        return nullptr;
    }
    TouchableSearch search(tree, radius, run, is_wanted);
    if (!search.is_worthwhile()) {
        return nullptr;
    }
    const std::vector<std::uint32_t> slots = search.slots();
    if (!is_wanted() ||
        static_cast<double>(slots.size()) > worthwhile_share * static_cast<double>(tree.triangle_count())) {
        return nullptr;
    }
    TriangleMesh mesh;
    for (const std::uint32_t slot : slots) {
        add_loose(mesh, tree.corners(slot));
    }
    auto touchable = std::make_shared<TriangleTree>(TriangleTree::build(mesh, run));
    touchable->name_triangles(slots);
    return std::make_shared<const TouchableTriangles>(
        TouchableTriangles{radius, &tree, std::move(touchable)});
}

}  // namespace tactus
