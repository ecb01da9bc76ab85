#include "shared/rough_paths.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <tuple>

#include "shared/random_values.hpp"

namespace tactus::shared {

namespace {

constexpr double turn = 2.0 * std::numbers::pi;
constexpr double hop = 0.01;  // the hand goes from one place to another by at most this a tick

bool has_room(const JudgeTree& mesh, const Vec3& at, double radius) {
    return mesh.nearest(at, 1.02 * radius).distance >= 1.01 * radius;
}

void go_to(std::vector<Vec3>& way, const Vec3& goal, std::size_t ticks, double pace = hop) {
    for (double left = 1.0; left > 0.0 && way.size() < ticks;) {
        const Vec3 to_goal = goal - way.back();
        left = glm::length(to_goal);
        way.push_back(left <= pace ? goal : way.back() + to_goal * (pace / left));
        left -= pace;
    }
}

// Outside of everything, in the direction of a place.
Vec3 outside(const JudgeTree& mesh, const Vec3& place, double radius) {
    const double length = glm::length(place);
    const Vec3 direction = length > 1e-9 ? place / length : Vec3(0.0, 1.0, 0.0);
    return direction * (glm::length(glm::max(glm::abs(mesh.low()), glm::abs(mesh.high()))) + 1.1 * radius);
}

// --- Sharp edges -----------------------------------------------------------------------------------------

struct SharpEdge {
    std::uint32_t ends[2];
    Vec3 normal;       // mean of its sides, unit where they have one
    double sharpness;  // 1 - cosine of the angle between its sides; 3 at a border
};

Vec3 normal_of(const TriangleMesh& mesh, std::size_t triangle) {
    const Corners t = corners_of(mesh, triangle);
    const Vec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double length = glm::length(normal);
    return length > 0.0 ? normal / length : Vec3(0.0);
}

// Those of more than 30 degrees; where they are few, the sharpest hundredth.
std::vector<SharpEdge> sharp_edges(const TriangleMesh& mesh) {
    struct Side {
        std::uint32_t low, high, triangle;
    };
    std::vector<Side> sides;
    sides.reserve(3 * mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3]);
            sides.push_back({a, b, static_cast<std::uint32_t>(i)});
        }
    }
    std::ranges::sort(sides, [](const Side& p, const Side& q) {
        return std::tie(p.low, p.high, p.triangle) < std::tie(q.low, q.high, q.triangle);
    });
    std::vector<SharpEdge> edges;
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t next = i + 1;
        while (next < sides.size() && sides[next].low == sides[i].low && sides[next].high == sides[i].high) {
            ++next;
        }
        const Vec3 first = normal_of(mesh, sides[i].triangle);
        const Vec3 second = normal_of(mesh, sides[next - 1].triangle);
        const double sharpness = next - i == 2 ? 1.0 - glm::dot(first, second) : 3.0;
        const Vec3 sum = first + second;
        const double length = glm::length(sum);
        edges.push_back({{sides[i].low, sides[i].high}, length > 1e-9 ? sum / length : first, sharpness});
        i = next;
    }
    std::ranges::stable_sort(edges, std::greater<>(), &SharpEdge::sharpness);
    const auto steep =
        std::ranges::count_if(edges, [](const SharpEdge& e) { return e.sharpness > 1.0 - 0.866; });
    edges.resize(std::max(static_cast<std::size_t>(steep), edges.size() / 100 + 1));
    return edges;
}

class EdgeWalk {
public:
    EdgeWalk(const TriangleMesh& mesh, RandomValues& random)
        : mesh_(mesh), random_(random), edges_(sharp_edges(mesh)) {
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            for (const std::uint32_t vertex : edges_[i].ends) {
                at_vertex_.push_back({vertex, static_cast<std::uint32_t>(i)});
            }
        }
        std::ranges::sort(at_vertex_, [](const Spoke& p, const Spoke& q) {
            return std::tie(p.vertex, p.edge) < std::tie(q.vertex, q.edge);
        });
        restart();
    }

    void restart() {
        edge_ = static_cast<std::size_t>(random_.below(static_cast<int>(edges_.size())));
        along_ = 0.0;
        forth_ = random_.flip();
    }

    // False where the edges end: restart() puts it elsewhere.
    bool advance(double length) {
        for (int i = 0; i < 10'000; ++i) {
            const double whole = glm::distance(end(false), end(true));
            if (along_ + length < whole) {
                along_ += length;
                return true;
            }
            length -= whole - along_;
            if (!go_on()) {
                return false;
            }
        }
        return true;
    }

    Vec3 place() const {
        const double whole = glm::distance(end(false), end(true));
        return end(false) + (end(true) - end(false)) * (whole > 0.0 ? along_ / whole : 0.0);
    }
    const Vec3& normal() const { return edges_[edge_].normal; }
    Vec3 across() const {
        const Vec3 side = glm::cross(end(true) - end(false), normal());
        const double length = glm::length(side);
        return length > 0.0 ? side / length : Vec3(0.0);
    }

private:
    struct Spoke {
        std::uint32_t vertex, edge;
    };

    const Vec3& end(bool ahead) const { return mesh_.vertices[edges_[edge_].ends[forth_ == ahead ? 1 : 0]]; }

    bool go_on() {
        const std::uint32_t vertex = edges_[edge_].ends[forth_ ? 1 : 0];
        const auto spokes = std::ranges::equal_range(at_vertex_, vertex, {}, &Spoke::vertex);
        const auto count = static_cast<int>(std::ranges::size(spokes));
        const std::size_t from = edge_;
        if (count < 2) {
            return false;
        }
        do {
            edge_ = spokes[random_.below(count)].edge;
        } while (edge_ == from);
        forth_ = edges_[edge_].ends[0] == vertex;
        along_ = 0.0;
        return true;
    }

    const TriangleMesh& mesh_;
    RandomValues& random_;
    std::vector<SharpEdge> edges_;
    std::vector<Spoke> at_vertex_;
    std::size_t edge_ = 0;
    double along_ = 0.0;
    bool forth_ = true;
};

}  // namespace

std::vector<Vec3> pressed_orbit(const JudgeTree& mesh, double radius, int ticks) {
    const Vec3 first = glm::normalize(Vec3(0.62, 0.31, 0.72));
    const Vec3 second = glm::normalize(glm::cross(first, Vec3(0.23, 0.95, -0.11)));
    const auto count = static_cast<std::size_t>(ticks);
    std::vector<Vec3> way{outside(mesh, first, radius)};
    double out = glm::length(way.back());
    for (int i = 0; way.size() < count; ++i) {
        const double t = 1e-3 * i;
        const double angle = turn * t / 10.0;
        const Vec3 direction = std::cos(angle) * first + std::sin(angle) * second;
        const double share = mesh.first_crossing(2.0 * direction, -2.0 * direction);
        const double surface = share <= 1.0 ? 2.0 * (1.0 - share) : 0.0;
        const double goal = surface + radius - 0.04 + 0.06 * std::sin(turn * 0.7 * t + 2.2);
        out += std::clamp(goal - out, -hop, hop);  // over a rim the surface jumps: the hand does not
        way.push_back(direction * out);
    }
    return way;
}

std::vector<Vec3> fast_walk(const JudgeTree& mesh, double radius, int ticks) {
    RandomValues random(11);
    const Vec3 center = 0.5 * (mesh.low() + mesh.high());
    const Vec3 half = 0.5 * (mesh.high() - mesh.low());
    const auto goal = [&] { return center + half * random.in_box(1.1); };
    std::vector<Vec3> way{outside(mesh, goal(), radius)};
    for (int i = 0; i < 400; ++i) {
        const Vec3 place = i == 0 ? Vec3(0.0) : goal();
        if (has_room(mesh, place, radius)) {
            way.back() = place;
            break;
        }
    }
    while (way.size() < static_cast<std::size_t>(ticks)) {
        go_to(way, goal(), static_cast<std::size_t>(ticks));
    }
    return way;
}

std::vector<Vec3> slow_scan(const JudgeTree& mesh, double radius, int ticks) {
    RandomValues random(12);
    EdgeWalk walk(mesh.mesh(), random);
    const auto count = static_cast<std::size_t>(ticks);
    const auto behind = [&](std::size_t tick) {
        const double wobble = 0.1 * std::sin(turn * 3e-3 * static_cast<double>(tick));
        return walk.place() - walk.normal() * (0.33 * radius) + walk.across() * (wobble * radius);
    };
    std::vector<Vec3> way{outside(mesh, walk.place(), radius)};
    Vec3 start = walk.place() + walk.normal() * (1.1 * radius);
    if (has_room(mesh, start, radius)) {
        way.back() = start;
    }
    go_to(way, behind(0), count);
    while (way.size() < count) {
        if (walk.advance(2e-4)) {
            way.push_back(behind(way.size()));
            continue;
        }
        walk.restart();
        go_to(way, walk.place() + walk.normal() * (2.0 * radius), count);
        go_to(way, behind(way.size()), count);
    }
    return way;
}

std::span<const RoughPath> rough_paths() {
    static constexpr RoughPath all[] = {{"orbit", pressed_orbit}, {"walk", fast_walk}, {"edges", slow_scan}};
    return all;
}

}  // namespace tactus::shared
