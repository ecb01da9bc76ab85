#include "proxy/three_pass.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

namespace tactus::bench {

namespace {

constexpr std::size_t deepest = 64;

// The way of a pass: a point, a unit direction, and the distance within which a contact counts.
struct Way {
    const Vec3& from;
    const Vec3& direction;
    double length;
};

bool meets_box(const Way& way, const Vec3& low, const Vec3& high) {
    double begin = 0.0;
    double end = way.length;
    for (int axis = 0; axis < 3; ++axis) {
        if (way.direction[axis] == 0.0) {
            if (way.from[axis] < low[axis] || way.from[axis] > high[axis]) {
                return false;
            }
            continue;
        }
        const double a = (low[axis] - way.from[axis]) / way.direction[axis];
        const double b = (high[axis] - way.from[axis]) / way.direction[axis];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    return begin <= end;
}

// Where the way enters what is inflated; each shortens the way to what it finds.
class Entry {
public:
    Entry(const Way& way, double radius) : way_(way), radius_(radius) {}

    void face(const shared::Corners& t) {
        Vec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
        const double area = glm::length(normal);
        if (!(area > 0.0)) {
            return;
        }
        normal /= glm::dot(normal, way_.direction) > 0.0 ? -area : area;
        const double along = glm::dot(normal, way_.direction);
        if (along == 0.0) {
            return;
        }
        const double at = (radius_ - glm::dot(way_.from - t[0], normal)) / along;
        const Vec3 point = way_.from + at * way_.direction;
        for (int i = 0; i < 3; ++i) {
            const Vec3& a = t[i];
            const Vec3& b = t[(i + 1) % 3];
            const Vec3& c = t[(i + 2) % 3];
            const Vec3 outward = glm::cross(b - a, normal);
            if (glm::dot(point - a, outward) * glm::dot(c - a, outward) < 0.0) {
                return;
            }
        }
        take(at, normal);
    }

    void cylinder(const Vec3& a, const Vec3& b) {
        const double length = glm::length(b - a);
        if (!(length > 0.0)) {
            return;
        }
        const Vec3 axis = (b - a) / length;
        const Vec3 aside = way_.from - a - axis * glm::dot(way_.from - a, axis);
        const Vec3 motion = way_.direction - axis * glm::dot(way_.direction, axis);
        const double at = entry(aside, motion);
        const double along = glm::dot(way_.from + at * way_.direction - a, axis);
        if (along >= 0.0 && along <= length) {
            take(at, (aside + at * motion) / radius_);
        }
    }

    void ball(const Vec3& center) {
        const Vec3 aside = way_.from - center;
        const double at = entry(aside, way_.direction);
        take(at, (aside + at * way_.direction) / radius_);
    }

    double distance() const { return way_.length; }
    const Vec3& normal() const { return normal_; }
    const Way& way() const { return way_; }

private:
    // When |aside + t motion| falls to the radius; -1 where it does not.
    double entry(const Vec3& aside, const Vec3& motion) const {
        const double a = glm::dot(motion, motion);
        const double b = glm::dot(aside, motion);
        const double c = glm::dot(aside, aside) - radius_ * radius_;
        const double root = b * b - a * c;
        return a > 0.0 && b < 0.0 && root >= 0.0 ? c / (std::sqrt(root) - b) : -1.0;
    }
    void take(double at, const Vec3& normal) {
        if (at >= 0.0 && at < way_.length) {
            way_.length = at;
            normal_ = normal;
        }
    }

    Way way_;
    double radius_;
    Vec3 normal_{0.0};
};

}  // namespace

ThreePassProxy::ThreePassProxy(const TriangleMesh& mesh, double radius, const Epsilons& epsilons)
    : radius_(radius), epsilons_(epsilons), triangles_(mesh.triangles.size()) {
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        triangles_[i] = shared::corners_of(mesh, i);
    }
    std::vector<std::uint32_t> order(triangles_.size());
    std::iota(order.begin(), order.end(), 0u);
    nodes_.reserve(2 * order.size());
    nodes_.emplace_back();
    split(0, order.data(), static_cast<std::uint32_t>(order.size()));
}

void ThreePassProxy::split(std::uint32_t node, std::uint32_t* first, std::uint32_t count) {
    const auto center = [&](std::uint32_t i) {
        return (triangles_[i][0] + triangles_[i][1] + triangles_[i][2]) / 3.0;
    };
    Vec3 low(1e300), high(-1e300), low_center(1e300), high_center(-1e300);
    for (std::uint32_t i = 0; i < count; ++i) {
        for (const Vec3& corner : triangles_[first[i]]) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
        low_center = glm::min(low_center, center(first[i]));
        high_center = glm::max(high_center, center(first[i]));
    }
    nodes_[node] = {low - radius_, high + radius_, first[0], count == 1};
    if (count == 1) {
        return;
    }
    const Vec3 size = high_center - low_center;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    std::uint32_t* const half = first + count / 2;
    std::nth_element(first, half, first + count,
                     [&](std::uint32_t a, std::uint32_t b) { return center(a)[axis] < center(b)[axis]; });
    const auto left = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].first = left;
    nodes_.resize(nodes_.size() + 2);
    split(left, first, count / 2);
    split(left + 1, half, count - count / 2);
}

ThreePassProxy::Contact ThreePassProxy::first_contact(const Vec3& direction, double length) const {
    Entry entry({position_, direction, length}, radius_);
    std::array<std::uint32_t, deepest> stack;
    std::size_t waiting = 0;
    stack[waiting++] = 0;
    while (waiting > 0) {
        const Node& node = nodes_[stack[--waiting]];
        if (!meets_box(entry.way(), node.low, node.high)) {
            continue;
        }
        if (!node.is_leaf) {
            stack[waiting++] = node.first + 1;
            stack[waiting++] = node.first;
            continue;
        }
        const shared::Corners& t = triangles_[node.first];
        entry.face(t);
        for (int i = 0; i < 3; ++i) {
            entry.cylinder(t[i], t[(i + 1) % 3]);
            entry.ball(t[i]);
        }
    }
    return {entry.distance(), entry.normal()};
}

bool ThreePassProxy::move(const Vec3& hand) {
    double epsilon = epsilons_.base;
    Vec3 goal = hand;
    std::array<Vec3, 2> normals;
    bool is_held = false;
    for (std::size_t pass = 0; pass < 3; ++pass) {
        const double wanted = glm::distance(goal, position_);
        if (wanted <= epsilons_.base) {
            break;
        }
        const Vec3 direction = (goal - position_) / wanted;
        const double longest = wanted + epsilons_.ahead;
        const Contact met = first_contact(direction, longest);
        if (met.distance >= longest) {
            position_ = goal;
            break;
        }
        if (met.distance < epsilon) {
            epsilon = std::max(met.distance, epsilons_.least);
        }
        // Along the way, so that it ends that far above the plane of the contact.
        const double back = std::min(epsilon / std::max(-glm::dot(direction, met.normal), 1e-12), radius_);
        const double advance = std::clamp(met.distance - back, 0.0, wanted);
        position_ += direction * advance;
        is_held = is_held || advance < wanted;
        if (pass == 0) {
            goal = hand + met.normal * glm::dot(position_ - hand, met.normal);
        } else if (pass == 1) {
            const Vec3 line = glm::cross(normals[0], met.normal);
            const double length = glm::length(line);
            goal = length > 0.0 ? position_ + line * (glm::dot(hand - position_, line) / (length * length))
                                : position_;
        }
        normals[std::min<std::size_t>(pass, 1)] = met.normal;
    }
    return is_held;
}

double ThreePassProxy::bytes() const {
    return static_cast<double>(nodes_.size() * sizeof(Node) + triangles_.size() * sizeof(shared::Corners));
}

}  // namespace tactus::bench
