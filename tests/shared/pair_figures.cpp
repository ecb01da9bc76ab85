#include "shared/pair_figures.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <random>

#include "core/tree/closest_point_on_triangle.hpp"
#include "shared/bench_kit.hpp"
#include "shared/meshes.hpp"

namespace tactus::shared {

namespace {

const Quat upright{1.0, 0.0, 0.0, 0.0};

TriangleMesh placed(TriangleMesh mesh, const Pose& pose) {
    for (Vec3& vertex : mesh.vertices) {
        vertex = to_parent(pose, vertex);
    }
    return mesh;
}

// use(centre, radius, nearest place of the triangle) for every sphere and triangle.
template <class Use>
void for_each_contact(const ToolShape& spheres, const Pose& pose, const TriangleMesh& mesh, const Use& use) {
    for (const ToolSphere& sphere : spheres.spheres) {
        const Vec3 center = to_parent(pose, sphere.center);
        for (const auto& [a, b, c] : mesh.triangles) {
            use(center, sphere.radius,
                closest_point_on_triangle(center, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])
                    .point);
        }
    }
}

double least_distance(const ToolShape& spheres, const Pose& pose, const TriangleMesh& mesh) {
    double least = std::numeric_limits<double>::infinity();
    for_each_contact(spheres, pose, mesh, [&](const Vec3& center, double radius, const Vec3& near) {
        least = std::min(least, glm::distance(center, near) - radius);
    });
    return least;
}

// A x = b by Cholesky, of A's lower triangle; false where A is not positive definite.
bool solve(std::vector<std::vector<double>> a, std::vector<double>& b) {
    const std::size_t n = b.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            for (std::size_t k = 0; k < j; ++k) {
                a[i][j] -= a[i][k] * a[j][k];
            }
            if (i != j) {
                a[i][j] /= a[j][j];
            } else if (a[i][i] <= 0.0) {
                return false;
            } else {
                a[i][i] = std::sqrt(a[i][i]);
            }
        }
        for (std::size_t k = 0; k < i; ++k) {
            b[i] -= a[i][k] * b[k];
        }
        b[i] /= a[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) {
            b[i] -= a[k][i] * b[k];
        }
        b[i] /= a[i][i];
    }
    return true;
}

}  // namespace

void PairRig::add_tool(const TriangleMesh& mesh, const ToolShapeSettings& sampling,
                       const ToolSettings& settings, double share) {
    Held held{mesh, make_tool_shape(mesh, sampling).shape, nullptr, share};
    held.proxy = std::make_unique<ToolProxy>(held.shape, 16, settings);
    for (Held& other : held_) {
        pairs_.push_back(ToolPair::make(other.shape, held.shape));
        pairs_.back()->join(*other.proxy, *held.proxy);
    }
    held_.push_back(std::move(held));
}

void PairRig::add_wall(const TriangleMesh& mesh, const TouchMaterial& material, const Pose& pose) {
    const PlacedShape shape{MeshShape{std::make_shared<const TriangleMesh>(mesh)}, {}};
    wall_shapes_.push_back(make_touch_shape({&shape, 1}).shape);
    scene_.add(*wall_shapes_.back(), pose, material, 1);
    walls_.push_back(placed(mesh, pose));
}

void PairRig::tick(const std::vector<Pose>& hands) {
    scene_.begin_tick();
    group_.clear();
    for (std::size_t i = 0; i < held_.size(); ++i) {
        group_.add(*held_[i].proxy, hands[i], held_[i].share);
    }
    group_.move(scene_);
}

void PairRig::ticks(const std::vector<Pose>& hands, int count) {
    for (int i = 0; i < count; ++i) {
        tick(hands);
    }
}

std::int64_t PairRig::work() const {
    std::int64_t spent = 0;
    for (const Held& held : held_) {
        spent += held.proxy->work_spent();
    }
    return spent;
}

std::size_t PairRig::place_of(const ToolProxy& tool) const {
    const auto found =
        std::ranges::find_if(held_, [&](const Held& held) { return held.proxy.get() == &tool; });
    return static_cast<std::size_t>(found - held_.begin());
}

double PairRig::least_gap(std::size_t index) const {
    const ToolPair& pair = *pairs_[index];
    const Held& surface = held_[place_of(pair.surface())];
    return least_distance(pair.spheres().shape(), pair.spheres().pose(),
                          placed(surface.mesh, surface.proxy->pose()));
}

double PairRig::least_wall_gap() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Held& held : held_) {
        for (const TriangleMesh& wall : walls_) {
            least = std::min(least, least_distance(*held.shape, held.proxy->pose(), wall));
        }
    }
    return least;
}

// In joules; of every tool six numbers, its way and its turn times its own length.
double PairRig::energy(const std::vector<Pose>& poses, const std::vector<Pose>& hands, double springs,
                       Slope* slope) const {
    const std::size_t n = 6 * held_.size();
    if (slope) {
        slope->down.assign(n, 0.0);
        slope->bend.assign(n, std::vector<double>(n, 0.0));
    }
    double energy = 0.0;
    std::vector<double> lengths;
    double stiffest = 0.0;
    for (std::size_t t = 0; t < held_.size(); ++t) {
        const ToolSettings& settings = held_[t].proxy->settings();
        const double stiffness = settings.stiffness * held_[t].share;
        stiffest = std::max(stiffest, stiffness);
        lengths.push_back(std::sqrt(settings.turning_stiffness / settings.stiffness));
        const Vector6 off = lifted(motion_between(hands[t], poses[t]), lengths[t]);
        for (std::size_t i = 0; i < 6; ++i) {
            energy += 0.5 * stiffness * off[i] * off[i];
            if (slope) {
                slope->down[6 * t + i] = -stiffness * off[i];
                slope->bend[6 * t + i][6 * t + i] = stiffness;
            }
        }
    }
    const double stiffness = springs * stiffest;
    const auto press = [&](std::size_t tool, std::size_t other, double rest, const Vec3& center,
                           const Vec3& near) {
        const double missing = rest - glm::distance(center, near);
        if (missing <= 0.0) {
            return;
        }
        energy += 0.5 * stiffness * missing * missing;
        if (!slope) {
            return;
        }
        std::vector<double> row(n, 0.0);
        const Vec3 normal = glm::normalize(center - near);
        const Vector6 own = lifted_row(normal, center - poses[tool].position, lengths[tool]);
        std::copy(own.begin(), own.end(), row.begin() + static_cast<std::ptrdiff_t>(6 * tool));
        if (other < held_.size()) {
            const Vector6 its = lifted_row(-normal, near - poses[other].position, lengths[other]);
            std::copy(its.begin(), its.end(), row.begin() + static_cast<std::ptrdiff_t>(6 * other));
        }
        for (std::size_t i = 0; i < n; ++i) {
            slope->down[i] += stiffness * missing * row[i];
            for (std::size_t j = 0; j <= i; ++j) {
                slope->bend[i][j] += stiffness * row[i] * row[j];
            }
        }
    };
    for (const auto& pair : pairs_) {
        const std::size_t a = place_of(pair->spheres());
        const std::size_t b = place_of(pair->surface());
        for_each_contact(*held_[a].shape, poses[a], placed(held_[b].mesh, poses[b]),
                         [&](const Vec3& center, double radius, const Vec3& near) {
                             press(a, b, radius + pair->skin(), center, near);
                         });
    }
    for (std::size_t t = 0; t < held_.size(); ++t) {
        for (const TriangleMesh& wall : walls_) {
            for_each_contact(*held_[t].shape, poses[t], wall,
                             [&](const Vec3& center, double radius, const Vec3& near) {
                                 press(t, held_.size(), radius + held_[t].proxy->skin(), center, near);
                             });
        }
    }
    return energy;
}

std::vector<Wrench> PairRig::slow_balance(const std::vector<Pose>& hands) const {
    std::vector<Pose> poses;
    std::vector<double> lengths;
    for (const Held& held : held_) {
        const ToolSettings& settings = held.proxy->settings();
        poses.push_back(held.proxy->pose());
        lengths.push_back(std::sqrt(settings.turning_stiffness / settings.stiffness));
    }
    for (double springs = 1e4; springs <= 1e6; springs *= 10.0) {
        for (int round = 0; round < 100; ++round) {
            Slope slope;
            const double here = energy(poses, hands, springs, &slope);
            std::vector<double> x = slope.down;
            if (!solve(slope.bend, x)) {
                break;
            }
            double share = 1.0;
            const auto part = [&](double of) {
                std::vector<Pose> there = poses;
                for (std::size_t t = 0; t < there.size(); ++t) {
                    Vector6 own;
                    std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(6 * t), 6, own.begin());
                    there[t] = moved(poses[t], lowered(own, lengths[t]) * of);
                }
                return there;
            };
            while (share > 1e-6 && energy(part(share), hands, springs, nullptr) > here) {
                share *= 0.5;
            }
            if (share <= 1e-6) {
                break;
            }
            poses = part(share);
        }
    }
    std::vector<Wrench> felt;
    for (std::size_t t = 0; t < poses.size(); ++t) {
        const ToolSettings& settings = held_[t].proxy->settings();
        const RigidMotion pull = motion_between(poses[t], hands[t]);
        felt.push_back({pull.way * -settings.stiffness, pull.turn * -settings.turning_stiffness});
    }
    return felt;
}

namespace {

double percent(double part, double whole) {
    return whole > 0.0 ? 100.0 * part / whole : 0.0;
}

// Ticks of both tools, timed and judged.
class PairPlay {
public:
    PairPlay(PairRig& rig, int judge_every) : rig_(rig), every_(std::max(1, judge_every)) {
        figures_.tool.plays = 1;
    }

    void tick(const std::vector<Pose>& hands) {
        ToolFigures& tool = figures_.tool;
        const std::uint64_t from = clock_.now();
        rig_.tick(hands);
        const std::uint64_t to = clock_.now();
        ++tool.ticks;
        if (!rig_.tool(0).meetings().empty()) {
            ++tool.contact_ticks;
            tool.microseconds.push_back(1e-3 * clock_.nanoseconds(from, to));
        }
        tool.unfinished += ((rig_.last(0).status | rig_.last(1).status) & tool_unfinished) != 0;
        if (tool.ticks % every_ == 0) {
            judge();
        }
    }
    void go(std::vector<Pose>& hands, const std::vector<Pose>& to, int ticks) {
        const std::vector<Pose> from = hands;
        for (int i = 1; i <= ticks; ++i) {
            const double share = static_cast<double>(i) / ticks;
            for (std::size_t t = 0; t < hands.size(); ++t) {
                hands[t] = {from[t].position + (to[t].position - from[t].position) * share,
                            glm::slerp(from[t].rotation, to[t].rotation, share)};
            }
            tick(hands);
        }
    }
    void judge() {
        const double gap = rig_.least_gap(0);
        figures_.tool.penetrations += gap < 0.0;
        figures_.tool.deepest = std::max(figures_.tool.deepest, -gap);
    }
    // The hands stand still: the tools come to rest and then do not move at all.
    void rest(const std::vector<Pose>& hands) {
        for (int i = 0; i < 40; ++i) {
            tick(hands);
        }
        const Pose before[2] = {rig_.tool(0).pose(), rig_.tool(1).pose()};
        for (int i = 0; i < 40; ++i) {
            tick(hands);
        }
        for (std::size_t t = 0; t < 2; ++t) {
            const Pose& now = rig_.tool(t).pose();
            figures_.tool.still_way =
                std::max(figures_.tool.still_way, glm::distance(now.position, before[t].position) +
                                                      glm::length(motion_between(before[t], now).turn));
        }
    }
    void compare(const std::vector<Pose>& hands) {
        const std::vector<Wrench> slow = rig_.slow_balance(hands);
        const Vec3 middle = 0.5 * (rig_.tool(0).pose().position + rig_.tool(1).pose().position);
        Wrench sum;
        double force = 0.0, torque = 0.0;
        for (std::size_t t = 0; t < 2; ++t) {
            const ToolTick& last = rig_.last(t);
            ToolFigures& tool = figures_.tool;
            tool.force_error = std::max(tool.force_error, percent(glm::distance(last.force, slow[t].force),
                                                                  glm::length(slow[t].force)));
            tool.torque_error =
                std::max(tool.torque_error,
                         percent(glm::distance(last.torque, slow[t].torque), glm::length(slow[t].torque)));
            const Vec3 about = last.torque + glm::cross(last.pose.position - middle, last.force);
            sum.force += last.force;
            sum.torque += about;
            force = std::max(force, glm::length(last.force));
            torque = std::max(torque, glm::length(about));
        }
        figures_.balance_error = std::max({figures_.balance_error, percent(glm::length(sum.force), force),
                                           percent(glm::length(sum.torque), torque)});
    }

    PairFigures& figures() { return figures_; }

private:
    PairRig& rig_;
    int every_;
    SpanClock clock_;
    PairFigures figures_;
};

ToolSettings held_by(double stiffness, double friction) {
    ToolSettings settings;
    settings.stiffness = stiffness;
    settings.turning_stiffness = 1e-3 * stiffness;
    settings.static_friction = 1.25 * friction;
    settings.dynamic_friction = friction;
    return settings;
}

}  // namespace

PairFigures press_pair(double ratio, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> chance(-1.0, 1.0);
    PairRig rig;
    rig.add_tool(box({0.05, 0.01, 0.01}), {1e-3, 300}, held_by(1000.0, 0.0));
    rig.add_tool(box({0.03, 0.02, 0.03}), {1e-3, 300}, held_by(1000.0 * ratio, 0.0));
    PairPlay play(rig, 10);
    const auto turned = [&](double by) {
        const Vec3 axis = glm::normalize(Vec3(chance(random), 0.2 * chance(random), chance(random)));
        return glm::angleAxis(by * chance(random), axis);
    };
    std::vector<Pose> hands{{{0.0, 0.06, 0.0}, upright}, {Vec3(0.0), upright}};
    play.go(hands, hands, 2);
    const Vec3 beside(0.015 * chance(random), 0.022, 0.01 * chance(random));
    play.go(hands, {{beside, turned(0.15)}, {{0.0, 0.002, 0.0}, turned(0.15)}}, 200);
    play.rest(hands);
    play.judge();
    play.compare(hands);
    return play.figures();
}

PairFigures rub_pair(int ticks, int judged, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> chance(-1.0, 1.0);
    PairRig rig;
    // The second is hollow and holds the first: it cannot come out.
    TriangleMesh shell = box(Vec3(0.06));
    const TriangleMesh hollow = box(Vec3(0.04));
    const auto outside = static_cast<std::uint32_t>(shell.vertices.size());
    shell.vertices.insert(shell.vertices.end(), hollow.vertices.begin(), hollow.vertices.end());
    for (const auto& [a, b, c] : hollow.triangles) {
        shell.triangles.push_back({outside + a, outside + c, outside + b});
    }
    rig.add_tool(box({0.03, 0.01, 0.015}), {1e-3, 200}, held_by(1000.0, 0.3));
    rig.add_tool(shell, {2e-3, 800}, held_by(2000.0, 0.4));
    PairPlay play(rig, judged > 0 ? std::max(1, ticks / judged) : 1'000'000);
    std::vector<Pose> hands{{Vec3(0.0), upright}, {Vec3(0.0), upright}};
    play.go(hands, hands, 2);
    const auto anywhere = [&](double far, double turn) {
        const Vec3 axis = glm::normalize(Vec3(chance(random), chance(random), 1.0));
        return Pose{far * Vec3(chance(random), chance(random), chance(random)),
                    glm::angleAxis(turn * chance(random), axis)};
    };
    for (int done = 0; done < ticks;) {
        const int leg = done % 200 == 0 ? 1 : 49;  // a leap now and then
        play.go(hands, {anywhere(0.05, 1.5), anywhere(0.05, 1.5)}, leg);
        done += leg;
        const Pose& place = rig.tool(0).pose();
        for (const ToolSphere& sphere : rig.tool(0).shape().spheres) {
            const Vec3 at = glm::abs(to_local(rig.tool(1).pose(), to_parent(place, sphere.center)));
            if (std::max({at.x, at.y, at.z}) > 0.04) {
                play.figures().tool.passes = 1;
            }
        }
    }
    play.rest(hands);
    play.judge();
    return play.figures();
}

PairFigures slide_pair() {
    PairRig rig;
    rig.add_tool(box({0.02, 0.01, 0.02}), {1e-3, 200}, held_by(1000.0, 0.3));
    rig.add_tool(box({0.2, 0.02, 0.05}), {1e-3, 400}, held_by(3000.0, 0.5));
    PairPlay play(rig, 10);
    std::vector<Pose> hands{{{0.0, 0.05, 0.0}, upright}, {Vec3(0.0), upright}};
    play.go(hands, hands, 2);
    play.go(hands, {{{0.0, 0.024, 0.0}, upright}, {Vec3(0.0), upright}}, 100);
    play.go(hands, {{{0.06, 0.024, 0.0}, upright}, {{-0.02, 0.0, 0.0}, upright}}, 300);
    const Vec3 force = rig.last(0).force;
    const Vec3 normal = direction_to_parent(rig.tool(1).pose(), Vec3(0.0, 1.0, 0.0));
    const double pressed = glm::dot(force, normal);
    const double held = glm::length(force - pressed * normal);
    play.figures().friction_error = percent(std::abs(held - 0.3 * pressed), 0.3 * pressed);
    play.compare(hands);
    play.figures().tool.force_error = play.figures().tool.torque_error =
        0.0;  // the reference has no friction
    return play.figures();
}

}  // namespace tactus::shared
