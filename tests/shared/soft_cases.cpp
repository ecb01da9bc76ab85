#include "shared/soft_cases.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "core/soft/soft_body.hpp"
#include "shared/meshes.hpp"

namespace tactus::shared {

namespace {

constexpr double step = 1e-3;  // (unit: seconds)
constexpr double gravity = 9.81;
constexpr double density = 1000.0;
constexpr int default_cells = 8;

SoftBody body_of(const TriangleMesh& mesh, int cells, const SoftMaterial& material, const HeldParts& held) {
    SoftModelResult made = make_soft_volume(mesh, cells, material, held, step);
    if (made.model == nullptr) {
        std::fprintf(stderr, "%s\n", made.error.c_str());
        std::exit(1);
    }
    return SoftBody(std::move(made.model));
}

Vec3 at(const Lanes& row) {
    return {row[0], row[1], row[2]};
}

Vec3 center_of(const SoftBody& body) {
    Vec3 sum(0.0);
    for (std::size_t i = 0; i < body.places().size(); ++i) {
        sum += body.model().mass[i] * at(body.places()[i]);
    }
    return sum / body.model().total_mass();
}

// The mean time between the first and the last time that a value rises through nought.
class Periods {
public:
    void add(double time, double value) {
        if (count_ >= 0 && last_ < 0.0 && value >= 0.0) {
            const double crossing = time - step * value / (value - last_);
            begin_ = count_ == 0 ? crossing : begin_;
            end_ = crossing;
            ++count_;
        }
        count_ = std::max(count_, 0);
        last_ = value;
    }
    int count() const { return count_ - 1; }
    double mean() const { return (end_ - begin_) / (count_ - 1); }

private:
    double last_ = 0.0, begin_ = 0.0, end_ = 0.0;
    int count_ = -1;
};

constexpr double beam_length = 0.2, beam_height = 0.02;

SoftBody beam(double stiffness, double damping, double drag, int cells) {
    const TriangleMesh mesh =
        grid_box(0.5 * Vec3(beam_length, beam_height, beam_height), std::max(cells, 10));
    const HeldParts end{Vec3(-1.0), Vec3(-0.4999 * beam_length, 1.0, 1.0), {}};
    return body_of(mesh, cells,
                   {.stiffness = stiffness, .poisson_ratio = 0.0, .damping = damping, .drag = drag}, end);
}

}  // namespace

SoftCase hung_plate_period(double stiffness, double damping) {
    constexpr double length = 0.1, thickness = 0.02, angle = 0.1;
    const HeldParts edge{Vec3(-1e-3, 0.0499, -1.0), Vec3(1e-3, 1.0, 1.0), {}};
    SoftBody plate = body_of(grid_box(0.5 * Vec3(thickness, length, length), 8), default_cells,
                             {.stiffness = stiffness, .damping = damping, .drag = 0.0}, edge);
    const Vec3 hinge(0.0, 0.5 * length, 0.0);
    const Mat3 turn(Vec3(std::cos(angle), std::sin(angle), 0.0), Vec3(-std::sin(angle), std::cos(angle), 0.0),
                    Vec3(0.0, 0.0, 1.0));
    for (std::size_t i = 0; i < plate.places().size(); ++i) {
        plate.put(i, hinge + turn * (plate.model().rest[i] - hinge), Vec3(0.0));
    }
    Periods periods;
    for (int i = 0; i < 10'000 && periods.count() < 4; ++i) {
        plate.step(Vec3(0.0, -gravity, 0.0), {}, {});
        periods.add(i * step, center_of(plate).x);
    }
    // I = m (L^2 / 3 + t^2 / 12) about the edge, the center L / 2 below it.
    const double arm = 0.5 * length;
    const double square = length * length / 3.0 + thickness * thickness / 12.0;
    const double small = 2.0 * std::numbers::pi * std::sqrt(square / (gravity * arm));
    return {periods.mean(), small * (1.0 + angle * angle / 16.0)};
}

SoftCase beam_period(double stiffness, double damping) {
    SoftBody body = beam(stiffness, damping, 0.0, default_cells);
    for (std::size_t i = 0; i < body.places().size(); ++i) {
        const double share = body.model().rest[i].x / beam_length + 0.5;
        const double speed = body.model().held[i] != 0 ? 0.0 : 0.05 * share * share;
        body.put(i, body.model().rest[i], Vec3(0.0, speed, 0.0));
    }
    Periods periods;
    for (int i = 0; i < 10'000 && periods.count() < 3; ++i) {
        body.step(Vec3(0.0), {}, {});
        periods.add(i * step, center_of(body).y);
    }
    // omega = 1.8751^2 sqrt(E I / (rho A)) / L^2, I / A = h^2 / 12
    const double rate =
        3.51602 * std::sqrt(stiffness / density / 12.0) * beam_height / (beam_length * beam_length);
    return {periods.mean(), 2.0 * std::numbers::pi / rate};
}

SoftCase beam_sag(double stiffness, int cells) {
    SoftBody body = beam(stiffness, 0.02, 2.0, cells);
    for (int i = 0; i < 12'000; ++i) {
        body.step(Vec3(0.0, -0.1 * gravity, 0.0), {}, {});
    }
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < body.places().size(); ++i) {
        if (body.model().rest[i].x > 0.4999 * beam_length) {
            sum += body.model().rest[i].y - body.places()[i][1];
            ++count;
        }
    }
    // q L^4 / (8 E I) with what shear adds, 6/5 q L^2 / (2 G A).
    const double load = 0.1 * gravity * density, square = beam_length * beam_length;
    const double bend = 1.5 * load * square * square / (stiffness * beam_height * beam_height);
    return {sum / count, bend + 1.2 * load * square / stiffness};
}

SoftCase rolling_ball(double stiffness, double damping) {
    constexpr double radius = 0.04, angle = 0.15;
    constexpr int placings = 6, ticks = 400;
    double sum = 0.0;
    for (int placing = 0; placing < placings; ++placing) {
        SoftBody ball =
            body_of(icosphere(4, radius), default_cells,
                    {.stiffness = stiffness, .damping = damping, .drag = 0.0, .friction = 1.0}, {});
        const Solid plane = PlaneShape{};
        SoftObstacle floor{&plane, {Vec3(0.0, -radius, 0.0)}, {Vec3(0.0, -radius, 0.0)}, 1.0};
        const Vec3 down(0.0, -gravity * std::cos(angle), 0.0);
        const double heading = 0.4 * placing;
        const Vec3 along(std::cos(heading), 0.0, std::sin(heading));
        for (int i = 0; i < 1000; ++i) {
            ball.step(down, {}, {&floor, 1});
        }
        const double begin = glm::dot(center_of(ball), along);
        for (int i = 0; i < ticks; ++i) {
            ball.step(down + along * gravity * std::sin(angle), {}, {&floor, 1});
        }
        const double time = ticks * step;
        sum += 2.0 * (glm::dot(center_of(ball), along) - begin) / (time * time);
    }
    return {sum / placings, 5.0 / 7.0 * gravity * std::sin(angle)};
}

double press_stiffness(int cells) {
    constexpr double half = 0.04, spring = 500.0;
    const HeldParts foot{Vec3(-1.0), Vec3(1.0, -0.999 * half, 1.0), {}};
    SoftBody body = body_of(grid_box(Vec3(half), 12), cells, {.stiffness = 1e4}, foot);
    const Vec3 middle(1.0 / 3.0), top(0.0, half, 0.0);
    std::uint32_t pressed = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t t = 0; t < body.model().surface.triangles.size(); ++t) {
        const double distance = glm::distance(body.surface_point(t, middle), top);
        if (distance < least) {
            pressed = t;
            least = distance;
        }
    }
    const Vec3 begin = body.surface_point(pressed, middle);
    Vec3 hand = begin;
    for (int i = 0; i < 2500; ++i) {
        const Vec3 way(0.0, i < 100 ? -1e-4 : 0.0, 0.0);
        const SoftPush push{pressed, middle, spring * (hand - body.surface_point(pressed, middle)),
                            spring,  0.0,    way / step,
                            true};
        hand += way;
        body.step(Vec3(0.0), {&push, 1}, {});
    }
    return glm::length(body.pressed(0)) / (begin.y - body.surface_point(pressed, middle).y);
}

}  // namespace tactus::shared
