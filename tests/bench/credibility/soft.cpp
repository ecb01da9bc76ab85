// Soft bodies beside rigid ones and beams.
#include <glm/geometric.hpp>

#include "core/soft/soft_body.hpp"
#include "credibility/cases.hpp"
#include "credibility/pressed_block.hpp"
#include "shared/meshes.hpp"

namespace tactus::bench {

namespace {

constexpr int default_cells = 8;
constexpr double density = 1000.0;

SoftBody made_of(const TriangleMesh& mesh, const SoftMaterial& material, const HeldParts& held,
                 int cells = default_cells) {
    SoftModelResult made = make_soft_volume(mesh, cells, material, held, tick);
    if (made.model == nullptr) {
        std::fprintf(stderr, "%s\n", made.error.c_str());
        std::exit(1);
    }
    return SoftBody(std::move(made.model));
}

Vec3 mean_of(const SoftBody& body, std::span<const Lanes> rows, const HeldParts& part) {
    Vec3 sum(0.0);
    double mass = 0.0;
    for (std::size_t n = 0; n < rows.size(); ++n) {
        if (part.holds(body.model().rest[n])) {
            sum += body.model().mass[n] * Vec3(rows[n][0], rows[n][1], rows[n][2]);
            mass += body.model().mass[n];
        }
    }
    return sum / mass;
}

const HeldParts all_of_it{Vec3(-10.0), Vec3(10.0), {}};

// Twice the mean time between the turning points of a part of the body, along `axis`.
double period_of(SoftBody& body, const HeldParts& part, int axis, const Vec3& gravity_there, double seconds) {
    double first = 0.0, last = 0.0, before = 0.0;
    int count = 0;
    for (int i = 0; i * tick < seconds; ++i) {
        body.step(gravity_there, {}, {});
        const double now = mean_of(body, body.velocities(), part)[axis];
        if (now * before < 0.0) {
            last = (i + now / (before - now)) * tick;
            first = count++ == 0 ? last : first;
        }
        before = now;
    }
    return count > 1 ? 2.0 * (last - first) / (count - 1) : 0.0;
}

// A plate of 100 x 100 x 20 mm that hangs by an edge, as a rigid one: T = 2 pi sqrt(I / (m g d)).
void measure_plate(Results& results, const std::string& name, double stiffness, double damping) {
    const Vec3 half(0.05, 0.05, 0.01);
    const double d2 = half.y * half.y + half.z * half.z;  // I / m is 4/3 of it
    const double right = 2.0 * std::numbers::pi * std::sqrt(4.0 / 3.0 * d2 / (gravity * std::sqrt(d2)));
    SoftBody plate =
        made_of(shared::grid_box(half, 1), {.stiffness = stiffness, .damping = damping, .drag = 0.0},
                {Vec3(-1.0, half.y - 1e-3, half.z - 1e-3), Vec3(1.0), {}});
    add_case(results, "soft_plate.period_" + name, period_of(plate, all_of_it, 2, {0.0, -gravity, 0.0}, 3.0),
             right);
}

// A ball of 30 kPa without damping down a slope of 0.15 rad, as a rigid one: 5/7 g sin.
void measure_roll(Results& results) {
    constexpr double radius = 0.03;
    constexpr double slope = 0.15;
    constexpr double seconds = 0.6;
    SoftBody ball = made_of(shared::icosphere(4, radius),
                            {.stiffness = 3e4, .damping = 0.0, .drag = 0.0, .friction = 1.0}, {});
    const Solid floor = PlaneShape{};
    const Pose place{Vec3(0.0, -radius, 0.0)};
    SoftObstacle ground{&floor, place, place, 1.0};
    const auto roll = [&](double angle, double time) {
        for (int i = 0; i * tick < time; ++i)
            ball.step(gravity * Vec3(std::sin(angle), -std::cos(angle), 0.0), {}, {&ground, 1});
        return mean_of(ball, ball.velocities(), all_of_it).x;
    };
    const double before = roll(0.0, 1.0);
    add_case(results, "soft_roll.acceleration", (roll(slope, seconds) - before) / seconds,
             5.0 / 7.0 * gravity * std::sin(slope));
}

// A cantilever of 200 x 20 x 20 mm, Poisson's ratio 0: Euler's beam, with what shear adds to its sag.
constexpr double length = 0.2, side = 0.02;
const HeldParts end_of_beam{Vec3(length / 2.0 - 1e-4, -1.0, -1.0), Vec3(1.0), {}};

SoftBody cantilever(const SoftMaterial& material) {
    return made_of(shared::grid_box(0.5 * Vec3(length, side, side), 1), material,
                   {Vec3(-1.0), Vec3(1e-4 - length / 2.0, 1.0, 1.0), {}});
}

void measure_sag(Results& results) {
    constexpr double stiffness = 1e6;
    constexpr double pull = 0.05 * gravity;  // sags by little
    SoftBody beam = cantilever({.stiffness = stiffness, .poisson_ratio = 0.0, .damping = 0.02, .drag = 5.0});
    const double high = mean_of(beam, beam.places(), end_of_beam).y;
    for (int i = 0; i < 12'000; ++i)
        beam.step({0.0, -pull, 0.0}, {}, {});
    const double bending = 1.5 * density * pull * std::pow(length, 4) / (stiffness * side * side);
    const double shearing = 1.2 * density * pull * length * length / stiffness;
    add_case(results, "soft_beam.sag", high - mean_of(beam, beam.places(), end_of_beam).y,
             bending + shearing);
}

void measure_beam(Results& results, const std::string& name, double stiffness) {
    SoftBody beam = cantilever({.stiffness = stiffness, .poisson_ratio = 0.0, .drag = 0.0});
    const double right = 2.0 * std::numbers::pi * length * length /
                         (3.516 * std::sqrt(stiffness * side * side / (12.0 * density)));
    for (std::size_t n = 0; n < beam.places().size(); ++n) {
        const double along = beam.model().rest[n].x / length + 0.5;
        beam.put(n, beam.model().rest[n], {0.0, 0.01 / right * along * along, 0.0});
    }
    add_case(results, "soft_beam.period_" + name, period_of(beam, end_of_beam, 1, Vec3(0.0), 5.0 * right),
             right);
}

// How stiff the same block of 10 kPa is to a hand at the end of the touch's spring, under a fingertip in the
// middle of its top: the force over how deep the hand is beyond what that spring gives.
double stiffness_of(const PressedBlock& press, double force) {
    return force / (press.depth - force / press.spring);
}

double fingertip_stiffness(const PressedBlock& press, int cells) {
    const SoftBody block =
        made_of(shared::grid_box(Vec3(press.half), 16),
                {.stiffness = press.modulus, .poisson_ratio = press.poisson, .damping = 0.02, .drag = 5.0},
                {Vec3(-1.0), Vec3(1.0, 1e-3 - press.half, 1.0), {}}, cells);
    Stage stage(press.radius, {0.0, press.half + press.radius + 1e-4, 0.0}, Vec3(0.0));
    BodyAddition addition;
    addition.soft = std::make_shared<const SoftModel>(block.model());
    addition.touch_material = {press.spring, 0.0, 0.0, 0.0};
    stage.session().add_body(addition);
    stage.wait(0.01);
    const double lowest = press.half + press.radius - press.depth;
    while (stage.hand.position.y > lowest + 1e-9)
        stage.go(stage.hand.position - Vec3(0.0, 1e-4, 0.0));
    stage.wait(1.5);
    stage.session().refresh();
    return stiffness_of(press, stage.session().snapshot().proxies[0].force.y);
}

void measure_press(Results& results, const std::string& name, const PressedBlock& press,
                   std::initializer_list<int> cells) {
    const double right = stiffness_of(press, force_of(press));
    for (const int count : cells)
        add_case(results, "soft_press." + name + std::to_string(count) + "_cells",
                 fingertip_stiffness(press, count), right);
}

}  // namespace

void measure_soft(Results& results) {
    for (const auto& [name, damping] : {std::pair{"", 2e-3}, std::pair{"_damped", 0.02}}) {
        measure_plate(results, std::string("100kPa") + name, 1e5, damping);
        measure_plate(results, std::string("1MPa") + name, 1e6, damping);
    }
    measure_roll(results);
    measure_sag(results);
    measure_beam(results, "100kPa", 1e5);
    measure_beam(results, "1MPa", 1e6);
    measure_beam(results, "10MPa", 1e7);
    measure_press(results, "", {}, {2, 4, 6, 8, 10, 12});
    measure_press(results, "shallow_", {.depth = 0.004}, {8, 12});
    measure_press(results, "wide_", {.radius = 0.02, .finest = 2e-3}, {8, 12});
    measure_press(results, "narrow_", {.radius = 0.005, .depth = 0.005, .finest = 1e-3}, {8, 12});
}

}  // namespace tactus::bench
