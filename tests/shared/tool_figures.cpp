#include "shared/tool_figures.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

#include "core/math/small_matrix.hpp"
#include "core/tree/closest_point_on_triangle.hpp"
#include "shared/bench_kit.hpp"

namespace tactus::shared {

namespace {

constexpr double turn = 2.0 * std::numbers::pi;

std::uint32_t index(std::size_t i) {
    return static_cast<std::uint32_t>(i);
}

Vec3 on_circle(double radius, double y, double share) {
    return {radius * std::cos(turn * share), y, radius * std::sin(turn * share)};
}

// Two triangles between two rings of corners; from outside, `low` is below `high` and the ring runs around y.
void join(TriangleMesh& mesh, std::size_t low, std::size_t high, std::size_t sectors, bool inward) {
    for (std::size_t i = 0; i < sectors; ++i) {
        const std::size_t next = (i + 1) % sectors;
        std::array<std::uint32_t, 3> first{index(low + i), index(high + i), index(low + next)};
        std::array<std::uint32_t, 3> second{index(low + next), index(high + i), index(high + next)};
        if (inward) {
            std::swap(first[1], first[2]);
            std::swap(second[1], second[2]);
        }
        mesh.triangles.push_back(first);
        mesh.triangles.push_back(second);
    }
}

std::size_t add_ring(TriangleMesh& mesh, double radius, double y, int sectors, double square = 0.0) {
    const std::size_t first = mesh.vertices.size();
    for (int i = 0; i < sectors; ++i) {
        const Vec3 around = on_circle(1.0, 0.0, static_cast<double>(i) / sectors);
        const double out = square > 0.0 ? square / std::max(std::abs(around.x), std::abs(around.z)) : radius;
        mesh.vertices.push_back({out * around.x, y, out * around.z});
    }
    return first;
}

}  // namespace

TriangleMesh peg_mesh(double radius, double half_height, int sectors, int rings) {
    TriangleMesh mesh;
    const auto count = static_cast<std::size_t>(sectors);
    std::size_t below = add_ring(mesh, radius, -half_height, sectors);
    for (int i = 1; i <= rings; ++i) {
        const std::size_t above = add_ring(mesh, radius, half_height * (2.0 * i / rings - 1.0), sectors);
        join(mesh, below, above, count, false);
        below = above;
    }
    const std::size_t bottom = mesh.vertices.size();
    mesh.vertices.push_back({0.0, -half_height, 0.0});
    mesh.vertices.push_back({0.0, half_height, 0.0});
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t next = (i + 1) % count;
        mesh.triangles.push_back({index(bottom), index(i), index(next)});
        mesh.triangles.push_back({index(bottom + 1), index(below + next), index(below + i)});
    }
    return mesh;
}

TriangleMesh hole_mesh(double radius, double half_width, double half_height, int sectors) {
    TriangleMesh mesh;
    const auto count = static_cast<std::size_t>(sectors);
    const std::size_t inner_low = add_ring(mesh, radius, -half_height, sectors);
    const std::size_t inner_high = add_ring(mesh, radius, half_height, sectors);
    const std::size_t outer_low = add_ring(mesh, 0.0, -half_height, sectors, half_width);
    const std::size_t outer_high = add_ring(mesh, 0.0, half_height, sectors, half_width);
    join(mesh, inner_low, inner_high, count, true);
    join(mesh, outer_low, outer_high, count, false);
    join(mesh, outer_high, inner_high, count, false);
    join(mesh, outer_low, inner_low, count, true);
    return mesh;
}

ToolRig::ToolRig(const TriangleMesh& tool, const ToolShapeSettings& sampling, const ToolSettings& settings)
    : settings_(settings), shape_(make_tool_shape(tool, sampling).shape) {
    proxy_ = std::make_unique<ToolProxy>(shape_, 16, settings_);
}

void ToolRig::place(Wall& wall) {
    for (std::size_t i = 0; i < wall.local.vertices.size(); ++i) {
        wall.mesh.vertices[i] = to_parent(wall.pose, wall.local.vertices[i]);
    }
}

void ToolRig::add(const TriangleMesh& mesh, const TouchMaterial& material, const Pose& pose) {
    const PlacedShape placed{MeshShape{std::make_shared<const TriangleMesh>(mesh)}, {}};
    shapes_.push_back(make_touch_shape({&placed, 1}).shape);
    walls_.push_back({mesh, mesh, pose, false, scene_.add(*shapes_.back(), pose, material, 1)});
    place(walls_.back());
}

void ToolRig::carry(std::size_t mesh, const Pose& pose) {
    walls_[mesh].pose = pose;
    walls_[mesh].moves = true;
    place(walls_[mesh]);
}

ToolTick ToolRig::tick(const Pose& hand) {
    scene_.begin_tick();
    for (Wall& wall : walls_) {
        if (std::exchange(wall.moves, false)) {
            scene_.set_pose(wall.body, wall.pose);
        }
    }
    return proxy_->move(scene_, hand);
}

double ToolRig::least_gap() const {
    double least = std::numeric_limits<double>::infinity();
    for (const ToolSphere& sphere : shape_->spheres) {
        const Vec3 center = to_parent(proxy_->pose(), sphere.center);
        for (const Wall& wall : walls_) {
            for (const auto& [a, b, c] : wall.mesh.triangles) {
                const Vec3 near = closest_point_on_triangle(center, wall.mesh.vertices[a],
                                                            wall.mesh.vertices[b], wall.mesh.vertices[c])
                                      .point;
                least = std::min(least, glm::distance(near, center) - sphere.radius);
            }
        }
    }
    return least;
}

// In units of the coupling's stiffness. A spring for every triangle that is too near counts an edge as often
// as it has triangles, which the limit of stiff springs does not mind.
double ToolRig::energy(const Pose& pose, const Pose& hand, double springs, Slope* slope) const {
    const double length = std::sqrt(settings_.turning_stiffness / settings_.stiffness);
    const Vector6 off = lifted(motion_between(hand, pose), length);
    double energy = 0.0;
    for (std::size_t i = 0; i < 6; ++i) {
        energy += 0.5 * off[i] * off[i];
    }
    if (slope) {
        *slope = {};
        for (std::size_t i = 0; i < 6; ++i) {
            slope->down[i] = -off[i];
            slope->bend[i][i] = 1.0;
        }
    }
    for (const ToolSphere& sphere : shape_->spheres) {
        const Vec3 center = to_parent(pose, sphere.center);
        const double rest = sphere.radius + proxy_->skin();
        for (const Wall& wall : walls_) {
            for (const auto& [a, b, c] : wall.mesh.triangles) {
                const Vec3 near = closest_point_on_triangle(center, wall.mesh.vertices[a],
                                                            wall.mesh.vertices[b], wall.mesh.vertices[c])
                                      .point;
                const double missing = rest - glm::distance(near, center);
                if (missing <= 0.0) {
                    continue;
                }
                energy += 0.5 * springs * missing * missing;
                if (slope) {
                    const Vector6 row =
                        lifted_row(glm::normalize(center - near), center - pose.position, length);
                    for (std::size_t i = 0; i < 6; ++i) {
                        slope->down[i] += springs * missing * row[i];
                        for (std::size_t j = 0; j <= i; ++j) {
                            slope->bend[i][j] += springs * row[i] * row[j];
                        }
                    }
                }
            }
        }
    }
    return energy;
}

ToolRig::Balance ToolRig::slow_balance(const Pose& hand) const {
    const double length = std::sqrt(settings_.turning_stiffness / settings_.stiffness);
    Pose pose = proxy_->pose();
    for (double springs = 1e4; springs <= 1e6; springs *= 10.0) {
        for (int round = 0; round < 100; ++round) {
            Slope slope;
            const double here = energy(pose, hand, springs, &slope);
            Matrix6 lower{};
            if (!cholesky(slope.bend, lower)) {
                break;
            }
            const Vector6 x = solve_cholesky(lower, slope.down);
            double share = 1.0;
            const auto part = [&](double of) { return moved(pose, lowered(x, length) * of); };
            while (share > 1e-6 && energy(part(share), hand, springs) > here) {
                share *= 0.5;
            }
            if (share <= 1e-6) {
                break;
            }
            pose = part(share);
        }
    }
    const RigidMotion pull = motion_between(pose, hand);
    return {pull.way * -settings_.stiffness, pull.turn * -settings_.turning_stiffness};
}

void ToolFigures::add(const ToolFigures& other) {
    ticks += other.ticks;
    contact_ticks += other.contact_ticks;
    unfinished += other.unfinished;
    penetrations += other.penetrations;
    passes += other.passes;
    arrivals += other.arrivals;
    plays += other.plays;
    deepest = std::max(deepest, other.deepest);
    still_way = std::max(still_way, other.still_way);
    force_error = std::max(force_error, other.force_error);
    torque_error = std::max(torque_error, other.torque_error);
    microseconds.insert(microseconds.end(), other.microseconds.begin(), other.microseconds.end());
}

namespace {

// Ticks of one play, timed and judged.
class Play {
public:
    Play(ToolRig& rig, int judge_every) : rig_(rig), every_(std::max(1, judge_every)) { figures_.plays = 1; }

    ToolTick tick(const Pose& hand) {
        const std::uint64_t from = clock_.now();
        const ToolTick tick = rig_.tick(hand);
        const std::uint64_t to = clock_.now();
        ++figures_.ticks;
        if ((tick.status & tool_touching) != 0) {
            ++figures_.contact_ticks;
            figures_.microseconds.push_back(1e-3 * clock_.nanoseconds(from, to));
        }
        figures_.unfinished += (tick.status & tool_unfinished) != 0;
        if (figures_.ticks % every_ == 0) {
            judge();
        }
        return tick;
    }
    void go(Pose& hand, const Pose& to, int ticks) {
        const Pose from = hand;
        for (int i = 1; i <= ticks; ++i) {
            const double share = static_cast<double>(i) / ticks;
            hand = {from.position + (to.position - from.position) * share,
                    glm::slerp(from.rotation, to.rotation, share)};
            tick(hand);
        }
    }
    void judge() {
        const double gap = rig_.least_gap();
        figures_.penetrations += gap < 0.0;
        figures_.deepest = std::max(figures_.deepest, -gap);
    }
    // The hand stands still: the tool comes to rest and then does not move at all.
    ToolTick rest(const Pose& hand) {
        for (int i = 0; i < 20; ++i) {
            tick(hand);
        }
        const Vec3 before = rig_.proxy().pose().position;
        ToolTick last;
        for (int i = 0; i < 20; ++i) {
            last = tick(hand);
        }
        figures_.still_way =
            std::max(figures_.still_way, glm::distance(rig_.proxy().pose().position, before));
        return last;
    }

    ToolFigures& figures() { return figures_; }

private:
    ToolRig& rig_;
    int every_;
    SpanClock clock_;
    ToolFigures figures_;
};

}  // namespace

ToolFigures play_peg(double tilt, double around, int judged, bool compared) {
    constexpr double radius = 0.01;
    constexpr double half_height = 0.02;
    constexpr double block = 0.03;
    constexpr double depth = 0.015;
    static const TriangleMesh peg = peg_mesh(radius, half_height, 100, 99);
    static const TriangleMesh hole = hole_mesh(radius + 0.5e-4, block, depth, 200);
    ToolRig rig(peg, {2e-4, 600});
    rig.add(hole, {1000.0, 0.0, 0.0, 0.0});
    Play play(rig, judged > 0 ? 1'500 / judged : 1'000'000);
    const Vec3 axis{std::cos(around), 0.0, std::sin(around)};
    const Quat tilted = glm::angleAxis(tilt, axis);
    Pose hand{{0.0, 0.05, 0.0}, tilted};
    play.go(hand, hand, 1);
    play.go(hand, {{0.0, 0.03, 0.0}, tilted}, 200);                      // onto the rim
    play.go(hand, {{0.001, 0.03, 0.0005}, {1.0, 0.0, 0.0, 0.0}}, 300);   // upright, a little beside
    play.go(hand, {{0.0, 0.02, 0.0}, glm::angleAxis(0.02, axis)}, 400);  // in, a little askew
    play.go(hand, {{0.0, 0.02, 0.0}, {1.0, 0.0, 0.0, 0.0}}, 100);
    play.go(hand, {{0.0005, -0.005, 0.0}, {1.0, 0.0, 0.0, 0.0}}, 400);  // through
    const ToolTick last = play.rest(hand);
    play.judge();
    if (compared) {
        const ToolRig::Balance slow = rig.slow_balance(hand);
        play.figures().force_error = 100.0 * glm::distance(last.force, slow.force) / glm::length(slow.force);
        play.figures().torque_error =
            100.0 * glm::distance(last.torque, slow.torque) / glm::length(slow.torque);
    }
    const Pose& end = rig.proxy().pose();
    play.figures().arrivals += std::abs(end.position.y - hand.position.y) < 1e-3;
    // Inside of what the hole is cut into.
    play.figures().passes += std::ranges::any_of(rig.proxy().shape().spheres, [&](const ToolSphere& sphere) {
        const Vec3 place = glm::abs(to_parent(end, sphere.center));
        return std::max(place.x, place.z) < block && place.y < depth &&
               std::hypot(place.x, place.z) > radius + 0.5e-4;
    });
    return play.figures();
}

ToolFigures play_rough(const TriangleMesh& tool, const TriangleMesh& body, int ticks, int judged,
                       std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> chance(-1.0, 1.0);
    ToolSettings settings;
    settings.turning_stiffness = 20.0;
    ToolRig rig(tool, {2e-3, 600}, settings);
    rig.add(body, {1000.0, 0.0, 0.4, 0.3});
    Play play(rig, judged > 0 ? std::max(1, ticks / judged) : 1'000'000);
    const auto aside = [&](double most) { return most * chance(random); };
    Pose hand{{0.0, 1.5, 0.0}, {1.0, 0.0, 0.0, 0.0}};
    play.go(hand, hand, 1);
    for (int done = 0; done < ticks; done += 50) {
        const Vec3 place(aside(0.3), 0.75 + aside(0.1), aside(0.3));
        const Quat turned = glm::angleAxis(aside(1.5), glm::normalize(Vec3(aside(1.0), aside(1.0), 1.0)));
        play.go(hand, {place, turned}, 50);
    }
    play.judge();
    return play.figures();
}

}  // namespace tactus::shared
