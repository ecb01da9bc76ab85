// Quickhull (Barber, Dobkin, Huhdanpaa 1996): start from a tetrahedron; take the point farthest in front of a
// face, find the faces it sees, and put a cone of new faces from their rim to the point. Every face keeps the
// points in front of it.
#include "core/mesh/convex_hull.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

namespace tactus {

namespace {

using Index = std::uint32_t;
using Edge = std::pair<Index, Index>;

struct HullFace {
    std::array<Index, 3> corners;
    Vec3 normal{0.0};     // unit, outward
    double offset = 0.0;  // normal . x of the face's plane (unit: meters)
    std::vector<Index> in_front;
    bool alive = true;
};

class Hull {
public:
    explicit Hull(std::span<const Vec3> points) : points_(points) {}

    bool start();
    void grow();
    TriangleMesh mesh() const;

private:
    Index farthest(const auto& distance) const;
    double height(const HullFace& face, Index point) const {
        return glm::dot(face.normal, points_[point]) - face.offset;
    }
    std::size_t add_face(Index a, Index b, Index c);
    void hand_out(const std::vector<Index>& points, std::size_t first_face);
    void add_point(std::size_t seen_from, Index point);

    std::span<const Vec3> points_;
    std::vector<HullFace> faces_;
    std::map<Edge, std::size_t> face_of_edge_;  // by the directed edge of its own boundary
    double thickness_ = 0.0;                    // what counts as lying in a plane (unit: meters)
};

Index Hull::farthest(const auto& distance) const {
    Index best = 0;
    for (Index i = 1; i < points_.size(); ++i) {
        best = distance(points_[i]) > distance(points_[best]) ? i : best;
    }
    return best;
}

std::size_t Hull::add_face(Index a, Index b, Index c) {
    HullFace face;
    face.corners = {a, b, c};
    face.normal = glm::cross(points_[b] - points_[a], points_[c] - points_[a]);
    const double length = glm::length(face.normal);
    face.normal = length > 0.0 ? face.normal / length : face.normal;
    face.offset = glm::dot(face.normal, points_[a]);
    faces_.push_back(std::move(face));
    const std::size_t index = faces_.size() - 1;
    face_of_edge_[{a, b}] = face_of_edge_[{b, c}] = face_of_edge_[{c, a}] = index;
    return index;
}

// Each point goes to the first of the new faces that it stands in front of; what is in front of none is
// inside.
void Hull::hand_out(const std::vector<Index>& points, std::size_t first_face) {
    for (const Index point : points) {
        for (std::size_t i = first_face; i < faces_.size(); ++i) {
            if (height(faces_[i], point) > thickness_) {
                faces_[i].in_front.push_back(point);
                break;
            }
        }
    }
}

bool Hull::start() {
    if (points_.size() < 4) {
        return false;
    }
    const Vec3 origin = points_[0];
    const Index a = farthest([&](const Vec3& p) { return glm::distance(p, origin); });
    const Index b = farthest([&](const Vec3& p) { return glm::distance(p, points_[a]); });
    const Vec3 along = points_[b] - points_[a];
    thickness_ = 1e-8 * glm::length(along);
    const Index c = farthest([&](const Vec3& p) { return glm::length(glm::cross(p - points_[a], along)); });
    const Vec3 normal = glm::cross(along, points_[c] - points_[a]);
    const double area = glm::length(normal);
    if (!(area > thickness_ * glm::length(along))) {
        return false;
    }
    const Index d = farthest([&](const Vec3& p) { return std::abs(glm::dot(p - points_[a], normal)); });
    const double side = glm::dot(points_[d] - points_[a], normal);
    if (!(std::abs(side) > thickness_ * area)) {
        return false;
    }
    const auto [p, q] = side > 0.0 ? std::pair(c, b) : std::pair(b, c);  // d lies behind a, p, q
    add_face(a, p, q);
    add_face(p, a, d);
    add_face(q, p, d);
    add_face(a, q, d);
    std::vector<Index> all(points_.size());
    for (Index i = 0; i < all.size(); ++i) {
        all[i] = i;
    }
    hand_out(all, 0);
    return true;
}

void Hull::add_point(std::size_t seen_from, Index point) {
    std::vector<std::size_t> seen{seen_from};
    std::vector<Edge> rim;
    std::vector<Index> orphans;
    faces_[seen_from].alive = false;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const auto corners = faces_[seen[i]].corners;
        orphans.insert(orphans.end(), faces_[seen[i]].in_front.begin(), faces_[seen[i]].in_front.end());
        for (int k = 0; k < 3; ++k) {
            const Edge edge{corners[static_cast<std::size_t>(k)],
                            corners[static_cast<std::size_t>((k + 1) % 3)]};
            const std::size_t beyond = face_of_edge_.at({edge.second, edge.first});
            HullFace& neighbour = faces_[beyond];
            if (!neighbour.alive) {
                continue;
            }
            if (height(neighbour, point) > thickness_) {
                neighbour.alive = false;
                seen.push_back(beyond);
            } else {
                rim.push_back(edge);
            }
        }
    }
    // An edge towards a face that was found to be seen only later is not on the rim.
    std::erase_if(
        rim, [&](const Edge& edge) { return !faces_[face_of_edge_.at({edge.second, edge.first})].alive; });
    const std::size_t first_new = faces_.size();
    for (const Edge& edge : rim) {
        add_face(edge.first, edge.second, point);
    }
    hand_out(orphans, first_new);
}

void Hull::grow() {
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        if (!faces_[i].alive || faces_[i].in_front.empty()) {
            continue;
        }
        const HullFace& face = faces_[i];
        const Index point =
            *std::max_element(face.in_front.begin(), face.in_front.end(),
                              [&](Index a, Index b) { return height(face, a) < height(face, b); });
        add_point(i, point);
    }
}

TriangleMesh Hull::mesh() const {
    TriangleMesh mesh;
    std::map<Index, Index> kept;
    for (const HullFace& face : faces_) {
        if (!face.alive) {
            continue;
        }
        std::array<Index, 3> triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [place, is_new] =
                kept.try_emplace(face.corners[k], static_cast<Index>(mesh.vertices.size()));
            if (is_new) {
                mesh.vertices.push_back(points_[face.corners[k]]);
            }
            triangle[k] = place->second;
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

bool all_finite(std::span<const Vec3> points) {
    return std::all_of(points.begin(), points.end(), [](const Vec3& p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    });
}

}  // namespace

TriangleMesh convex_hull(std::span<const Vec3> points) {
    Hull hull(points);
    if (!all_finite(points) || !hull.start()) {
        return {};
    }
    hull.grow();
    return hull.mesh();
}

}  // namespace tactus
