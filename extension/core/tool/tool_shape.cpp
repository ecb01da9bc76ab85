#include "core/tool/tool_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "core/mesh/closed_mesh.hpp"
#include "core/mesh/mesh_check.hpp"
#include "core/tree/closest_point_on_triangle.hpp"
#include "core/tree/triangle_tree.hpp"

namespace tactus {

namespace {

constexpr double next_tolerance = 1.4;
constexpr int max_tolerances = 32;

// Of the tolerance. A sphere that stays this far off the point it is made for may be as large as those beside
// it: without it, the sphere inside a faceted ball touches one facet and misses the ball by millimetres.
constexpr double play = 0.3;
// A patch whose middle lies no farther out is not given a sphere of its own: its halves may be covered.
constexpr double nearly_covered = 0.8;
// Smaller spheres are not made: near a sharp edge they shrink to nothing. Sheets and needles are as thin as
// they are, whatever the tolerance.
constexpr double min_radius = 1e-3;
constexpr double smallest_patch = 0.5;
// A sphere this many times larger meets a hollow of nearly its own form everywhere at once, and costs more
// than several small ones. Where a few large ones do, as for a ball, they are taken.
constexpr double largest_sphere = 10.0;
constexpr std::size_t few_spheres = 8;
// Of the tool's size: finer ones would only cost time.
constexpr double least_tolerance = 1e-4;

// A piece of the surface that no sphere is known to cover.
struct Patch {
    Vec3 a, b, c;
    Vec3 outward;  // unit
    Vec3 middle() const { return (a + b + c) / 3.0; }
};

struct Candidate {
    Vec3 point;
    ToolSphere sphere;
};

// Six times the volume is the sum of the corners' determinants: below zero where the mesh is turned inside
// out.
double volume_of(const TriangleMesh& mesh, const Vec3& from) {
    double six = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        six +=
            glm::dot(mesh.vertices[a] - from, glm::cross(mesh.vertices[b] - from, mesh.vertices[c] - from));
    }
    return six / 6.0;
}

Vec3 nearest_point(const TriangleTree& tree, const Vec3& to) {
    const NearestTriangle nearest = tree.nearest(to, 1e30);
    Vec3 best(0.0);
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t lane = 0; lane < lane_count; ++lane) {
        const TriangleCorners t = tree.corners(nearest.pack * lane_count + lane);
        const Vec3 point = closest_point_on_triangle(to, t.a, t.b, t.c).point;
        if (glm::distance(point, to) < least) {
            least = glm::distance(point, to);
            best = point;
        }
    }
    return best;
}

bool is_inside(const TriangleTree& tree, const Vec3& point) {
    WorkBudget enough(std::int64_t{1} << 40);
    return tree.winding(point, enough).inside();
}

// The ball that touches the surface in `point` shrinks until nothing is farther inside than `slack` (Ma, Bae
// and Choi 2012), and then by what is. Through the point and q, with its centre at point - R n:
// R = |point - q|^2 / (2 n . (point - q)). Where the solid is thinner than the slack, the center may lie
// beyond its far side, with nothing near it: that ball is not inscribed, and shrinks on.
ToolSphere shrunk_ball(const TriangleTree& tree, const Vec3& point, const Vec3& normal, double radius,
                       double slack) {
    constexpr int max_rounds = 40;
    Vec3 center = point - normal * radius;
    double room = 0.0;
    for (int round = 0; round < max_rounds; ++round) {
        const Vec3 q = nearest_point(tree, center);
        room = glm::distance(center, q);
        if (room >= radius - slack && is_inside(tree, center)) {
            return {center, std::min(radius, room)};
        }
        const Vec3 apart = point - q;
        const double across = glm::dot(normal, apart);
        const double next = across > 0.0 ? 0.5 * glm::dot(apart, apart) / across : room;
        radius = std::min(next, radius * (1.0 - 1e-6));
        center = point - normal * radius;
    }
    return {center, is_inside(tree, center) ? std::min(radius, room) : 0.0};
}

double distance_outside(const Vec3& point, const ToolSphere& sphere) {
    return glm::distance(point, sphere.center) - sphere.radius;
}

// A ball is convex: what has its corners in it is all in it.
double distance_outside(const Patch& patch, const ToolSphere& sphere) {
    return std::max({distance_outside(patch.a, sphere), distance_outside(patch.b, sphere),
                     distance_outside(patch.c, sphere)});
}

// Infinite where there is no sphere.
template <class Place>
double distance_outside(const Place& place, std::span<const ToolSphere> spheres) {
    double least = std::numeric_limits<double>::infinity();
    for (const ToolSphere& sphere : spheres) {
        least = std::min(least, distance_outside(place, sphere));
    }
    return least;
}

double longest_edge(const Patch& patch) {
    return std::max(
        {glm::distance(patch.a, patch.b), glm::distance(patch.b, patch.c), glm::distance(patch.c, patch.a)});
}

// Across the longest edge.
std::array<Patch, 2> halves_of(const Patch& patch) {
    const double longest = longest_edge(patch);
    Patch p = patch;
    while (glm::distance(p.a, p.b) < longest) {
        p = {p.b, p.c, p.a, p.outward};
    }
    const Vec3 between = 0.5 * (p.a + p.b);
    return {{{p.a, between, p.c, p.outward}, {between, p.b, p.c, p.outward}}};
}

std::vector<Patch> patches_of(const TriangleMesh& mesh) {
    std::vector<Patch> patches;
    for (const auto& [ia, ib, ic] : mesh.triangles) {
        Patch patch{mesh.vertices[ia], mesh.vertices[ib], mesh.vertices[ic], Vec3(0.0)};
        const Vec3 across = glm::cross(patch.b - patch.a, patch.c - patch.a);
        const double longest = longest_edge(patch);
        // A sliver lies on its neighbours.
        if (glm::length(across) > 1e-9 * longest * longest) {
            patch.outward = glm::normalize(across);
            patches.push_back(patch);
        }
    }
    return patches;
}

// Spheres for the patches until each is covered by one. In batches, each largest sphere first: what they
// cover needs no smaller ones. A patch that its own sphere does not cover is halved, until it is so small
// that it is given up, and counts for what is told.
class Covering {
public:
    Covering(const TriangleTree& tree, double tolerance, double largest, std::size_t max_spheres)
        : tree_(tree), tolerance_(tolerance), largest_(largest), max_spheres_(max_spheres) {}

    // Empty where the spheres would be too many.
    std::shared_ptr<ToolShape> cover(std::vector<Patch> patches) {
        std::vector<Patch> done;  // covered, or given up
        while (!patches.empty()) {
            constexpr std::size_t batch = 128;
            const std::size_t stride = (patches.size() + batch - 1) / batch;
            const std::size_t known = spheres_.size();
            add_for(patches, stride);
            if (spheres_.size() > max_spheres_) {
                return nullptr;
            }
            std::vector<Patch> left;
            for (std::size_t i = 0; i < patches.size(); ++i) {
                const Patch& patch = patches[i];
                const auto fresh = std::span(spheres_).subspan(known);
                if (distance_outside(patch, fresh) <= tolerance_) {
                    done.push_back(patch);
                    continue;
                }
                if (i % stride != 0) {
                    left.push_back(patch);
                } else if (longest_edge(patch) > smallest_patch * tolerance_) {
                    for (const Patch& half : halves_of(patch)) {
                        (distance_outside(half, std::span(spheres_)) > tolerance_ ? left : done)
                            .push_back(half);
                    }
                } else {
                    done.push_back(patch);
                }
            }
            patches = std::move(left);
        }
        auto shape = std::make_shared<ToolShape>();
        for (const Patch& patch : done) {
            shape->tolerance = std::max(shape->tolerance, distance_outside(patch, std::span(spheres_)));
        }
        shape->spheres = std::move(spheres_);
        return shape;
    }

private:
    void add_for(const std::vector<Patch>& patches, std::size_t stride) {
        std::vector<Candidate> candidates;
        for (std::size_t i = 0; i < patches.size(); i += stride) {
            const Vec3 point = patches[i].middle();
            candidates.push_back(
                {point, shrunk_ball(tree_, point, patches[i].outward, largest_, play * tolerance_)});
        }
        std::ranges::stable_sort(candidates, std::greater{},
                                 [](const Candidate& c) { return c.sphere.radius; });
        for (const Candidate& candidate : candidates) {
            if (candidate.sphere.radius >= min_radius * tolerance_ &&
                distance_outside(candidate.point, std::span(spheres_)) > nearly_covered * tolerance_) {
                spheres_.push_back(candidate.sphere);
            }
        }
    }

    const TriangleTree& tree_;
    double tolerance_;
    double largest_;  // radius (unit: meters)
    std::size_t max_spheres_;
    std::vector<ToolSphere> spheres_;  // none of them covers a patch that is left
};

}  // namespace

// Prim's tree of shortest links; spheres that meet need no bridge.
std::vector<ToolBridge> bridges_between(std::span<const ToolSphere> spheres) {
    struct Nearest {
        double gap = std::numeric_limits<double>::infinity();  // to those that are linked (unit: meters)
        std::uint32_t linked = 0;
        bool is_linked = false;
    };
    std::vector<Nearest> nearest(spheres.size());
    std::vector<ToolBridge> bridges;
    std::size_t newest = 0;
    for (std::size_t count = 1; count < spheres.size(); ++count) {
        nearest[newest].is_linked = true;
        std::size_t next = newest;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < spheres.size(); ++i) {
            if (nearest[i].is_linked) {
                continue;
            }
            const double gap = glm::distance(spheres[i].center, spheres[newest].center) - spheres[i].radius -
                               spheres[newest].radius;
            if (gap < nearest[i].gap) {
                nearest[i].gap = gap;
                nearest[i].linked = static_cast<std::uint32_t>(newest);
            }
            if (nearest[i].gap < least) {
                least = nearest[i].gap;
                next = i;
            }
        }
        newest = next;
        if (least > 0.0) {
            bridges.push_back({nearest[next].linked, static_cast<std::uint32_t>(next)});
        }
    }
    return bridges;
}

ToolShapeResult make_tool_shape(const TriangleMesh& mesh, const ToolShapeSettings& settings) {
    return make_tool_shape(std::make_shared<const TriangleMesh>(mesh), settings);
}

ToolShapeResult make_tool_shape(std::shared_ptr<const TriangleMesh> shared,
                                const ToolShapeSettings& settings) {
    const TriangleMesh& mesh = *shared;
    if (std::string error = check_mesh(mesh); !error.empty()) {
        return {nullptr, std::move(error)};
    }
    if (!(settings.tolerance > 0.0) || settings.max_spheres == 0) {
        return {nullptr, "a tool needs a tolerance above 0 m and at least one sphere: set them"};
    }
    if (!is_closed(mesh)) {
        return {nullptr,
                "a tool has to bound a solid, and this mesh has holes or triangles that are not turned "
                "alike: close it"};
    }
    const TriangleTree tree = TriangleTree::build(mesh);
    const double size = tree.radius();
    const double volume = volume_of(mesh, tree.center());
    if (!(volume > 1e-9 * size * size * size)) {
        return {nullptr, volume < -1e-9 * size * size * size
                             ? "the tool's mesh is turned inside out: flip its triangles"
                             : "the tool's mesh has no volume: give it a thickness"};
    }
    const std::vector<Patch> patches = patches_of(mesh);
    double tolerance = std::max(settings.tolerance, least_tolerance * size);
    for (int i = 0; i < max_tolerances && tolerance < size; ++i, tolerance *= next_tolerance) {
        std::shared_ptr<ToolShape> shape =
            Covering(tree, tolerance, size, std::min(few_spheres, settings.max_spheres)).cover(patches);
        if (!shape) {
            shape =
                Covering(tree, tolerance, std::min(size, largest_sphere * tolerance), settings.max_spheres)
                    .cover(patches);
        }
        if (shape && !shape->spheres.empty()) {
            for (const ToolSphere& sphere : shape->spheres) {
                shape->reach = std::max(shape->reach, glm::length(sphere.center) + sphere.radius);
            }
            shape->mesh = std::move(shared);
            return {shape, {}};
        }
    }
    return {nullptr, "the tool's mesh is too thin for spheres: make it thicker, or allow more spheres"};
}

}  // namespace tactus
