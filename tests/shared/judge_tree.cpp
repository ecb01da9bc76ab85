#include "shared/judge_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace tactus::shared {

namespace {

constexpr std::uint32_t leaf_size = 4;
constexpr std::size_t deepest = 128;

double squared(const Vec3& v) {
    return glm::dot(v, v);
}

double to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 way = b - a;
    const double length = squared(way);
    const double t = length > 0.0 ? std::clamp(glm::dot(p - a, way) / length, 0.0, 1.0) : 0.0;
    // From the nearer end, so that nothing large cancels.
    return t < 0.5 ? squared((p - a) - t * way) : squared((p - b) + (1.0 - t) * way);
}

double to_box(const Vec3& p, const Vec3& low, const Vec3& high) {
    return squared(glm::max(Vec3(0.0), glm::max(low - p, p - high)));
}

// Where the line start + t * motion meets the box, as a span of t.
bool meets_box(const Vec3& start, const Vec3& motion, const Vec3& low, const Vec3& high, double until) {
    double from = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        if (motion[axis] == 0.0) {
            if (start[axis] < low[axis] || start[axis] > high[axis]) {
                return false;
            }
            continue;
        }
        const double a = (low[axis] - start[axis]) / motion[axis];
        const double b = (high[axis] - start[axis]) / motion[axis];
        from = std::max(from, std::min(a, b) - 1e-12);
        until = std::min(until, std::max(a, b) + 1e-12);
    }
    return from <= until;
}

// Signed volumes decide, in extended precision: a crossing is one where start and end are on different sides
// of the plane and the line passes all three edges on the same side. On an edge counts.
double crossing(const Vec3& start, const Vec3& motion, const Corners& t) {
    const SlowVec3 a = SlowVec3(t[0]) - SlowVec3(start);
    const SlowVec3 b = SlowVec3(t[1]) - SlowVec3(start);
    const SlowVec3 c = SlowVec3(t[2]) - SlowVec3(start);
    const SlowVec3 way(motion);
    const long double u = glm::dot(way, glm::cross(b, c));
    const long double v = glm::dot(way, glm::cross(c, a));
    const long double w = glm::dot(way, glm::cross(a, b));
    const bool inside = (u >= 0.0L && v >= 0.0L && w >= 0.0L) || (u <= 0.0L && v <= 0.0L && w <= 0.0L);
    const SlowVec3 normal = glm::cross(b - a, c - a);
    const long double along = glm::dot(way, normal);
    if (!inside || along == 0.0L) {
        return 2.0;
    }
    const long double at = glm::dot(a, normal) / along;
    return at >= 0.0L && at <= 1.0L ? static_cast<double>(at) : 2.0;
}

}  // namespace

double judged_distance_squared(const Vec3& p, const Corners& t) {
    const double edges =
        std::min({to_segment(p, t[0], t[1]), to_segment(p, t[1], t[2]), to_segment(p, t[2], t[0])});
    const Vec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double area = squared(normal);
    if (!(area > 0.0)) {
        return edges;
    }
    const auto beside = [&](const Vec3& a, const Vec3& b) {
        return glm::dot(glm::cross(b - a, p - a), normal) < 0.0;
    };
    if (beside(t[0], t[1]) || beside(t[1], t[2]) || beside(t[2], t[0])) {
        return edges;
    }
    const double height = glm::dot(p - t[0], normal);
    return std::min(edges, height * height / area);
}

JudgeTree::JudgeTree(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    std::vector<Vec3> centers(order_.size());
    for (std::size_t i = 0; i < centers.size(); ++i) {
        const Corners t = corners_of(mesh, i);
        centers[i] = 0.5 * (glm::min(t[0], glm::min(t[1], t[2])) + glm::max(t[0], glm::max(t[1], t[2])));
    }
    nodes_.reserve(order_.size());
    nodes_.emplace_back();
    split(0, 0, static_cast<std::uint32_t>(order_.size()), centers);
    moved();
}

void JudgeTree::split(std::uint32_t node, std::uint32_t first, std::uint32_t count,
                      const std::vector<Vec3>& centers) {
    nodes_[node].first = first;
    nodes_[node].count = count;
    if (count <= leaf_size) {
        return;
    }
    Vec3 low(std::numeric_limits<double>::infinity());
    Vec3 high(-low);
    for (std::uint32_t i = first; i < first + count; ++i) {
        low = glm::min(low, centers[order_[i]]);
        high = glm::max(high, centers[order_[i]]);
    }
    const Vec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const std::uint32_t half = count / 2;
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
        return centers[a][axis] != centers[b][axis] ? centers[a][axis] < centers[b][axis] : a < b;
    });
    const auto left = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].first = left;
    nodes_[node].count = 0;
    nodes_.resize(nodes_.size() + 2);
    split(left, first, half, centers);
    split(left + 1, first + half, count - half, centers);
}

void JudgeTree::moved() {
    corners_.resize(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) {
        corners_[i] = corners_of(mesh_, order_[i]);
    }
    fit();
}

void JudgeTree::fit() {
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        Node& node = nodes_[i];
        if (node.count == 0) {
            const Node& left = nodes_[node.first];
            const Node& right = nodes_[node.first + 1];
            node.low = glm::min(left.low, right.low);
            node.high = glm::max(left.high, right.high);
            continue;
        }
        node.low = Vec3(std::numeric_limits<double>::infinity());
        node.high = -node.low;
        for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
            for (const Vec3& corner : corners_[k]) {
                node.low = glm::min(node.low, corner);
                node.high = glm::max(node.high, corner);
            }
        }
    }
    const Vec3 size = glm::max(glm::abs(low()), glm::abs(high()));
    magnitude_ = std::max({size.x, size.y, size.z});
}

JudgedNearest JudgeTree::nearest(const Vec3& point, double far) const {
    struct Waiting {
        double squared;
        std::uint32_t node;
    };
    std::array<Waiting, deepest> stack;
    std::size_t waiting = 0;
    double best = far * far;
    std::uint32_t found = 0;
    bool any = false;
    stack[waiting++] = {to_box(point, nodes_[0].low, nodes_[0].high), 0};
    while (waiting > 0) {
        const Waiting next = stack[--waiting];
        if (next.squared >= best) {
            continue;
        }
        const Node& node = nodes_[next.node];
        if (node.count > 0) {
            for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
                const double distance = judged_distance_squared(point, corners_[k]);
                if (distance < best) {
                    best = distance;
                    found = order_[k];
                    any = true;
                }
            }
            continue;
        }
        const Node& left = nodes_[node.first];
        const Node& right = nodes_[node.first + 1];
        Waiting a{to_box(point, left.low, left.high), node.first};
        Waiting b{to_box(point, right.low, right.high), node.first + 1};
        if (a.squared < b.squared) {
            std::swap(a, b);
        }
        stack[waiting++] = a;
        stack[waiting++] = b;
    }
    return {any ? std::sqrt(best) : far, found};
}

void JudgeTree::within(const Vec3& point, double reach, std::vector<std::uint32_t>& out) const {
    std::array<std::uint32_t, deepest> stack;
    std::size_t waiting = 0;
    stack[waiting++] = 0;
    const double limit = reach * reach * (1.0 + 1e-12);
    while (waiting > 0) {
        const Node& node = nodes_[stack[--waiting]];
        if (to_box(point, node.low, node.high) > limit) {
            continue;
        }
        if (node.count == 0) {
            stack[waiting++] = node.first + 1;
            stack[waiting++] = node.first;
            continue;
        }
        for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
            if (judged_distance_squared(point, corners_[k]) <= limit) {
                out.push_back(order_[k]);
            }
        }
    }
}

double JudgeTree::first_crossing(const Vec3& start, const Vec3& motion) const {
    std::array<std::uint32_t, deepest> stack;
    std::size_t waiting = 0;
    stack[waiting++] = 0;
    double best = 2.0;
    while (waiting > 0) {
        const Node& node = nodes_[stack[--waiting]];
        if (!meets_box(start, motion, node.low, node.high, std::min(best, 1.0))) {
            continue;
        }
        if (node.count == 0) {
            stack[waiting++] = node.first + 1;
            stack[waiting++] = node.first;
            continue;
        }
        for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
            best = std::min(best, crossing(start, motion, corners_[k]));
        }
    }
    return best;
}

int winding(const TriangleMesh& mesh, const Vec3& p) {
    double angle = 0.0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Corners t = corners_of(mesh, i);
        const Vec3 a = t[0] - p;
        const Vec3 b = t[1] - p;
        const Vec3 c = t[2] - p;
        const double la = glm::length(a);
        const double lb = glm::length(b);
        const double lc = glm::length(c);
        const double volume = glm::dot(a, glm::cross(b, c));
        angle += std::atan2(volume,
                            la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return static_cast<int>(std::lround(angle / (2.0 * std::numbers::pi)));
}

}  // namespace tactus::shared
