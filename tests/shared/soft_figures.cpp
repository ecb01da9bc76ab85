#include "shared/soft_figures.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <numbers>

#include "core/soft/soft_body.hpp"
#include "core/soft/soft_model.hpp"
#include "session/session.hpp"
#include "shared/bench_kit.hpp"
#include "shared/judge_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/slow_distance.hpp"

namespace tactus::shared {

namespace {

constexpr Nanoseconds period = 1'000'000;
constexpr double half_edge = 0.04;
constexpr double radius = 0.01;
constexpr double press_depth = 0.01;
constexpr double wall_stiffness = 500.0;  // (unit: newtons per meter)

class Hand final : public Device {
public:
    DeviceSample read(Nanoseconds) override {
        return {position, Quat(1.0, 0.0, 0.0, 0.0), velocity, 0, true};
    }
    void write(Nanoseconds, const Vec3&) override {}

    Vec3 position{0.0};
    Vec3 velocity{0.0};
};

double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    return 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                            la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

// Where a hand presses, and which way is out.
struct Spot {
    Vec3 place;
    Vec3 out;
};

struct Pressing {
    Pressing(std::shared_ptr<const SoftModel> made, const Vec3& begin) : model(std::move(made)) {
        view = std::make_shared<SoftView>(model->surface.vertices);
        BodyAddition addition;
        addition.touch_material = {wall_stiffness, 0.0, 0.4, 0.3};
        addition.soft = model;
        addition.soft_view = view;
        hand.position = begin;
        Workspace workspace;
        workspace.force_limit = 1e6;
        ProxyDescription description;
        description.device = session.add_device(hand, workspace).handle;
        description.settings.radius = radius;
        session.add_proxy(description);
        session.add_body(addition);
        session.settle();
        figures.nodes = model->rest.size();
        figures.elements = model->element_count;
        figures.triangles = model->surface.triangles.size();
        figures.factor_entries = model->factor.entries();
        mesh = model->surface;
    }

    const ProxyState& tick(const Vec3& place) {
        hand.velocity = (place - hand.position) * 1e3;
        hand.position = place;
        const std::uint64_t from = clock.now();
        session.tick(now += period);
        const double microseconds = 1e-3 * clock.nanoseconds(from, clock.now());
        session.refresh();
        const ProxyState& state = session.snapshot().proxies[0];
        ++figures.ticks;
        figures.unfinished += (state.status & proxy_unfinished) != 0;
        if (state.contact_count > 0) {
            ++figures.contact_ticks;
            figures.microseconds.push_back(microseconds);
        } else if (!view->refresh()) {
            figures.still_microseconds.push_back(microseconds);
        }
        figures.largest_force = std::max(figures.largest_force, glm::length(state.force));
        return state;
    }

    // In and out along a cosine, and some rest after it.
    template <class Passed>
    void press(const Spot& spot, int judged, Passed&& is_passed) {
        constexpr int ticks = 200;
        const Vec3 begin = spot.place + spot.out * (radius + 2e-3);
        Vec3 force_before = tick(begin).force;
        double gained = 0.0, gained_held = 0.0, ways = 0.0;
        for (int i = 1; i <= ticks; ++i) {
            const double depth = 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * i / ticks));
            const Vec3 place = begin - spot.out * ((press_depth + 2e-3 + hand_gives) * depth);
            const Vec3 way = place - hand.position;
            const ProxyState& state = tick(place);
            gained += 0.5 * glm::dot(force_before + state.force, way);
            gained_held += glm::dot(force_before, way);
            ways += glm::dot(way, way);
            force_before = state.force;
            if (i % judged == 0) {
                view->refresh();
                mesh.vertices = view->places();
                figures.passes += is_passed(mesh, state.position);
                figures.deepest =
                    std::max(figures.deepest, glm::dot(spot.place - state.position, spot.out) + radius);
            }
        }
        for (int i = 0; i < 50; ++i) {
            tick(begin);
        }
        figures.energy_created = std::max(figures.energy_created, gained);
        figures.energy_created_held = std::max(figures.energy_created_held, gained_held);
        figures.held_share = std::max(figures.held_share, gained_held / (0.5 * wall_stiffness * ways));
        ++figures.presses;
    }

    // How far the hand's own spring gives besides, so that the surface is pressed in by about the depth.

    void rest() {
        for (int i = 0; i < 20'000; ++i) {
            tick(hand.position);
        }
        view->refresh();
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
            figures.shape_error = std::max(
                figures.shape_error,
                glm::distance(view->places()[i], at_rest.empty() ? model->surface.vertices[i] : at_rest[i]));
        }
    }

    std::shared_ptr<const SoftModel> model;
    std::shared_ptr<SoftView> view;
    Session session{weightless()};
    Hand hand;
    Nanoseconds now = 0;
    SpanClock clock;
    SoftFigures figures;
    TriangleMesh mesh;
    std::vector<Vec3> at_rest;
    double hand_gives = 0.0;

private:
    static SessionSettings weightless() {
        SessionSettings settings;
        settings.physics.gravity = Vec3(0.0);
        return settings;
    }
};

}  // namespace

bool winds_around(const TriangleMesh& mesh, const Vec3& point) {
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        sum += solid_angle(mesh.vertices[a] - point, mesh.vertices[b] - point, mesh.vertices[c] - point);
    }
    return std::abs(sum) > 2.0 * std::numbers::pi;
}

double distance_to_surface(const TriangleMesh& mesh, const Vec3& point) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : mesh.triangles) {
        least = std::min(
            least, judged_distance_squared(point, {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}));
    }
    return std::sqrt(least);
}

double height_above(const TriangleMesh& mesh, const Vec3& point) {
    double least = std::numeric_limits<double>::infinity();
    double height = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
        const double distance = judged_distance_squared(point, {p, q, r});
        if (distance < least) {
            least = distance;
            height = glm::dot(point - p, glm::normalize(glm::cross(q - p, r - p)));
        }
    }
    return height;
}

SoftFigures press_block(int presses, double stiffness, int judged) {
    const HeldParts foot{Vec3(-1.0), Vec3(1.0, -half_edge + 1e-3, 1.0), {}};
    Pressing pressing(
        make_soft_volume(grid_box(Vec3(half_edge), 8), 8, {.stiffness = stiffness}, foot, 1e-3).model,
        Vec3(0.0, 0.1, 0.0));
    // A flat punch of radius a has 2 a E / (1 - nu^2): about what the point feels.
    pressing.hand_gives = press_depth * 2.0 * radius * stiffness / 500.0;
    for (int i = 0; i < presses; ++i) {
        const double u = 0.02 * std::sin(1.0 + 2.4 * i), v = 0.02 * std::sin(2.0 + 1.7 * i);
        const Spot spots[] = {{{u, half_edge, v}, {0.0, 1.0, 0.0}},
                              {{half_edge, u, v}, {1.0, 0.0, 0.0}},
                              {{u, v, -half_edge}, {0.0, 0.0, -1.0}}};
        const Spot& spot = spots[i % 3];
        for (int k = 0; k < 20; ++k) {  // around the corners
            pressing.tick(spot.place + spot.out * 0.05);
        }
        pressing.press(spot, judged, winds_around);
    }
    pressing.rest();
    return pressing.figures;
}

SoftFigures press_cloth(int presses, double stiffness, int judged) {
    HeldParts frame;
    const TriangleMesh sheet = terrain(31, 0.3, 0.0);
    for (std::uint32_t i = 0; i < sheet.vertices.size(); ++i) {
        const Vec3& place = sheet.vertices[i];
        if (std::max(std::abs(place.x), std::abs(place.z)) > 0.149) {
            frame.vertices.push_back(i);
        }
    }
    Pressing pressing(
        make_soft_sheet(sheet, {.stiffness = stiffness, .density = 300.0, .thickness = 2e-3}, frame, 1e-3)
            .model,
        Vec3(0.0, 0.1, 0.0));
    for (int i = 0; i < presses; ++i) {
        const Vec3 place(0.08 * std::sin(1.0 + 2.4 * i), 0.0, 0.08 * std::sin(2.0 + 1.7 * i));
        pressing.press({place, {0.0, 1.0, 0.0}}, judged, [](const TriangleMesh& mesh, const Vec3& point) {
            return height_above(mesh, point) <= 0.0;
        });
    }
    pressing.rest();
    return pressing.figures;
}

namespace {

struct PressTrace {
    std::vector<double> forces;  // of the ticks on the way in
    double held = 0.0;           // at last
    std::vector<double> microseconds;
};

PressTrace trace_press(double stiffness, int iterations) {
    const HeldParts foot{Vec3(-1.0), Vec3(1.0, -half_edge + 1e-3, 1.0), {}};
    SoftBody body(
        make_soft_volume(grid_box(Vec3(half_edge), 8), 8, {.stiffness = stiffness}, foot, 1e-3).model);
    body.iterations = iterations;
    // The middle of the top: the triangle that is nearest to it.
    std::uint32_t triangle = 0;
    const Vec3 weights(1.0 / 3.0);
    for (std::uint32_t t = 0; t < body.model().surface.triangles.size(); ++t) {
        const auto off = [&](std::uint32_t one) {
            return glm::distance(body.surface_point(one, weights), Vec3(0.0, half_edge, 0.0));
        };
        triangle = off(t) < off(triangle) ? t : triangle;
    }
    Vec3 hand = body.surface_point(triangle, weights);
    PressTrace trace;
    const SpanClock clock;
    for (int i = 0; i < 1100; ++i) {
        const Vec3 motion(0.0, i < 100 ? -1e-4 : 0.0, 0.0);
        const SoftPush push{triangle, weights, 500.0 * (hand - body.surface_point(triangle, weights)),
                            500.0,    0.0,     motion * 1e3,
                            true};
        hand += motion;
        const std::uint64_t from = clock.now();
        body.step(Vec3(0.0), {&push, 1}, {});
        trace.microseconds.push_back(1e-3 * clock.nanoseconds(from, clock.now()));
        trace.held = glm::length(body.pressed(0));
        if (i < 100) {
            trace.forces.push_back(trace.held);
        }
    }
    return trace;
}

}  // namespace

std::vector<SoftAccuracy> soft_accuracy(double stiffness, std::span<const int> iterations) {
    const PressTrace right = trace_press(stiffness, 32);
    std::vector<SoftAccuracy> all;
    for (const int count : iterations) {
        PressTrace trace = trace_press(stiffness, count);
        double sum = 0.0, largest = 0.0;
        for (std::size_t i = 0; i < right.forces.size(); ++i) {
            sum += (trace.forces[i] - right.forces[i]) * (trace.forces[i] - right.forces[i]);
            largest = std::max(largest, right.forces[i]);
        }
        all.push_back({100.0 * std::sqrt(sum / static_cast<double>(right.forces.size())) / largest,
                       100.0 * std::abs(trace.held - right.held) / right.held,
                       quantile(trace.microseconds, 0.5)});
    }
    return all;
}

}  // namespace tactus::shared
