#include "core/soft/soft_body.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "core/math/bit_hash.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::soft_body_test {
namespace {

constexpr double tick = 1e-3;
const Vec3 earth(0.0, -9.81, 0.0);
const HeldParts free_everywhere;

HeldParts below(double height) {
    return {Vec3(-10.0), Vec3(10.0, height, 10.0), {}};
}

SoftBody block(const SoftMaterial& material, const HeldParts& held = free_everywhere, int cells = 4,
               double half = 0.04) {
    SoftModelResult made = make_soft_volume(shared::grid_box(Vec3(half), cells), cells, material, held, tick);
    EXPECT_EQ(made.error, "");
    return SoftBody(std::move(made.model));
}

SoftBody cloth(const SoftMaterial& material, const HeldParts& held, int cells = 10) {
    SoftModelResult made = make_soft_sheet(shared::terrain(cells, 0.3, 0.0), material, held, tick);
    EXPECT_EQ(made.error, "");
    return SoftBody(std::move(made.model));
}

Vec3 at(const Lanes& row) {
    return {row[0], row[1], row[2]};
}

struct Momentum {
    Vec3 linear{0.0}, angular{0.0};
};

Momentum momentum_of(const SoftBody& body) {
    Momentum sum;
    for (std::size_t i = 0; i < body.places().size(); ++i) {
        const Vec3 part = body.model().mass[i] * at(body.velocities()[i]);
        sum.linear += part;
        sum.angular += glm::cross(at(body.places()[i]), part);
    }
    return sum;
}

double farthest_from_rest(const SoftBody& body) {
    double farthest = 0.0;
    for (std::size_t i = 0; i < body.places().size(); ++i) {
        farthest = std::max(farthest, glm::distance(at(body.places()[i]), body.model().rest[i]));
    }
    return farthest;
}

bool is_finite(const SoftBody& body) {
    return std::ranges::all_of(body.places(), [](const Lanes& row) {
        return std::isfinite(row[0]) && std::isfinite(row[1]) && std::isfinite(row[2]);
    });
}

std::uint64_t bits_of(const SoftBody& body) {
    BitHash hash;
    for (std::size_t i = 0; i < body.places().size(); ++i) {
        hash.add(at(body.places()[i]));
        hash.add(at(body.velocities()[i]));
    }
    return hash.value();
}

// The triangle of the surface that is nearest to a place, pressed in its middle.
std::uint32_t triangle_near(const SoftBody& body, const Vec3& place) {
    std::uint32_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t t = 0; t < body.model().surface.triangles.size(); ++t) {
        const double distance = glm::distance(body.surface_point(t, Vec3(1.0 / 3.0)), place);
        if (distance < least) {
            nearest = t;
            least = distance;
        }
    }
    return nearest;
}

// A hand of a spring on one point of the surface: pressed in, held and let go.
struct Press {
    SoftBody& body;
    std::uint32_t triangle;
    Vec3 hand;  // where the spring is slack
    double stiffness = 500.0;
    double work = 0.0;   // of the hand's spring on the body (unit: joules)
    double force = 0.0;  // along the hand's way (unit: newtons)

    Press(SoftBody& pressed, const Vec3& place)
        : body(pressed),
          triangle(triangle_near(pressed, place)),
          hand(pressed.surface_point(triangle, Vec3(1.0 / 3.0))) {}

    void tick(const Vec3& motion) {
        const Vec3 weights(1.0 / 3.0);
        const Vec3 before = body.surface_point(triangle, weights);
        SoftPush push{triangle, weights, stiffness * (hand - before), stiffness, 0.0, motion / 1e-3, true};
        hand += motion;
        body.step(Vec3(0.0), {&push, 1}, {});
        work += glm::dot(body.pressed(0), body.surface_point(triangle, weights) - before);
        force = glm::length(body.pressed(0));
    }
};

// Between turning points of what hangs from its edge; it begins beside its place of rest (unit: seconds).
double period_of(SoftBody& plate) {
    std::vector<double> turning_points;
    double before = 0.0;
    for (int i = 0; i < 3000; ++i) {
        plate.step(earth, {}, {});
        const double now = momentum_of(plate).linear.z;
        if (i > 0 && now * before < 0.0) {
            turning_points.push_back((i + now / (before - now)) * tick);
        }
        before = now;
    }
    const double count = static_cast<double>(turning_points.size()) - 1.0;
    return count > 0.0 ? 2.0 * (turning_points.back() - turning_points.front()) / count : 0.0;
}

TEST(SoftBody, FallsAsEverythingDoes) {
    SoftBody body = block({.stiffness = 1e5, .drag = 0.0});
    for (int i = 0; i < 200; ++i) {
        body.step(earth, {}, {});
    }
    const double fallen = 9.81 * tick * tick * 200.0 * 201.0 / 2.0;  // semi-implicit
    for (std::size_t i = 0; i < body.places().size(); ++i) {
        ASSERT_LT(glm::distance(at(body.places()[i]), body.model().rest[i] - Vec3(0.0, fallen, 0.0)), 1e-9);
    }
}

TEST(SoftBody, KeepsItsMomentumWhateverItIsStruckWith) {
    SoftBody body = block({.stiffness = 2e4, .drag = 0.0});
    shared::RandomValues random(5);
    for (std::size_t i = 0; i < body.places().size(); ++i) {
        const Vec3 place = body.model().rest[i];
        body.put(i, place,
                 Vec3(0.3, 0.0, 0.1) + glm::cross(Vec3(0.0, 2.0, 0.0), place) + random.in_ball(0.2));
    }
    const Momentum before = momentum_of(body);
    for (int i = 0; i < 1000; ++i) {
        body.step(Vec3(0.0), {}, {});
    }
    const Momentum after = momentum_of(body);
    EXPECT_LT(glm::distance(after.linear, before.linear), 1e-9 * glm::length(before.linear));
    // About the place where it is by now: its way went on along the linear momentum.
    EXPECT_LT(glm::distance(after.angular, before.angular), 0.02 * glm::length(before.angular));
}

// A bar that hangs: each height bears what is below, so its end goes down by rho g L^2 / (2 E).
TEST(SoftBody, ABarHangsAsFarAsTheClosedFormSays) {
    for (const double stiffness : {5e3, 1e5, 1e6}) {
        const SoftMaterial material{
            .stiffness = stiffness, .poisson_ratio = 0.0, .damping = 0.02, .drag = 5.0};
        const TriangleMesh mesh = shared::grid_box(Vec3(0.01, 0.1, 0.01), 10);
        const HeldParts top{Vec3(-1.0, 0.099, -1.0), Vec3(1.0), {}};
        SoftModelResult made = make_soft_volume(mesh, 10, material, top, tick);
        ASSERT_EQ(made.error, "");
        SoftBody bar(made.model);
        for (int i = 0; i < 6000; ++i) {
            bar.step(earth, {}, {});
        }
        double lower = 0.0;
        int ends = 0;
        for (std::size_t i = 0; i < bar.places().size(); ++i) {
            if (bar.model().rest[i].y < -0.099) {
                lower += -0.1 - bar.places()[i][1];
                ++ends;
            }
        }
        const double wanted = 1000.0 * 9.81 * 0.2 * 0.2 / (2.0 * stiffness);
        EXPECT_NEAR(lower / ends, wanted, 0.01 * wanted) << stiffness << " Pa";
    }
}

TEST(SoftBody, ASheetHangsAboutAsFarAsTheClosedFormSays) {
    const SoftMaterial material{.stiffness = 1e5, .damping = 0.01, .drag = 5.0};
    SoftBody sheet = cloth(material, {Vec3(-1.0, -1.0, -0.16), Vec3(1.0, 1.0, -0.14), {}});
    for (int i = 0; i < 6000; ++i) {
        sheet.step(Vec3(0.0, 0.0, 9.81), {}, {});
    }
    double lowest = 0.0;
    for (const Lanes& row : sheet.places()) {
        lowest = std::max(lowest, row[2]);
    }
    const double wanted = 1000.0 * 9.81 * 0.3 * 0.3 / (2.0 * 1e5);
    EXPECT_NEAR(lowest - 0.15, wanted, 0.2 * wanted);
}

TEST(SoftBody, PressedAndLetGoGivesBackNoMoreThanItGotAndHasItsShapeAgain) {
    for (const double stiffness : {1e3, 2e4, 1e6}) {
        SoftBody body = block({.stiffness = stiffness}, below(-0.039));
        Press press(body, Vec3(0.0, 0.04, 0.0));
        const auto stored = [&] {
            const SoftEnergy energy = body.energy();
            return energy.kinetic + energy.elastic;
        };
        for (int turn = 0; turn < 3; ++turn) {
            for (int i = 0; i < 400; ++i) {
                press.tick(Vec3(0.0, i < 100 ? -1e-4 : i >= 300 ? 1e-4 : 0.0, 0.0));
                ASSERT_LE(stored(), press.work + 1e-9) << stiffness << " Pa, tick " << i;
            }
        }
        for (int i = 0; i < 8000; ++i) {
            body.step(Vec3(0.0), {}, {});
        }
        EXPECT_LE(stored(), press.work + 1e-9);
        EXPECT_LT(farthest_from_rest(body), 1e-4) << stiffness << " Pa";
        EXPECT_TRUE(body.is_asleep() || stiffness < 1e4);  // a soft one swings for long
    }
}

// At rest the force does not depend on how often the step is solved: the added masses are not felt.
TEST(SoftBody, AtRestTheForceIsThatOfTheShapeAlone) {
    double forces[2] = {};
    for (const int iterations : {1, 8}) {
        SoftBody body = block({.stiffness = 1e5}, below(-0.039));
        body.iterations = iterations;
        Press press(body, Vec3(0.0, 0.04, 0.0));
        for (int i = 0; i < 2000; ++i) {
            press.tick(Vec3(0.0, i < 100 ? -1e-4 : 0.0, 0.0));
        }
        forces[iterations == 1 ? 0 : 1] = press.force;
    }
    EXPECT_GT(forces[0], 0.5);
    EXPECT_NEAR(forces[0], forces[1], 1e-3 * forces[1]);
}

TEST(SoftBody, StaysBoundedWhateverItIsMadeOf) {
    shared::RandomValues random(11);
    for (int trial = 0; trial < 24; ++trial) {
        SoftMaterial material;
        material.stiffness = random.magnitude(1e2, 1e7);
        material.density = random.magnitude(10.0, 2e4);
        material.poisson_ratio = random.between(0.0, 0.45);
        material.damping = random.flip() ? 0.0 : random.magnitude(1e-4, 0.1);
        SoftBody body =
            block(material, random.flip() ? below(-0.039) : free_everywhere, 3, random.magnitude(0.005, 0.2));
        Press press(body, Vec3(0.0, 1.0, 0.0));
        press.stiffness = random.magnitude(10.0, 1e4);
        for (int i = 0; i < 400; ++i) {
            press.tick(random.in_ball(2e-3));
            ASSERT_TRUE(is_finite(body)) << trial;
        }
        const SoftEnergy energy = body.energy();
        EXPECT_LE(energy.kinetic + energy.elastic, press.work + 1e-9) << trial;
    }
}

// Mirrored, crushed to a point or thrown about: tetrahedra turn back into their shape.
TEST(SoftBody, TurnedInsideOutItComesBack) {
    for (const int how : {0, 1, 2}) {
        SoftBody body = block({.stiffness = 2e4, .damping = 0.01}, below(-0.039));
        shared::RandomValues random(7);
        for (std::size_t i = 0; i < body.places().size(); ++i) {
            if (body.model().held[i] == 0) {
                const Vec3 rest = body.model().rest[i];
                const Vec3 place = how == 0   ? Vec3(rest.x, -0.08 - rest.y, rest.z)
                                   : how == 1 ? Vec3(0.0)
                                              : random.in_ball(0.04);
                body.put(i, place, Vec3(0.0));
            }
        }
        for (int i = 0; i < 6000; ++i) {
            body.step(Vec3(0.0), {}, {});
        }
        EXPECT_LT(farthest_from_rest(body), 1e-4) << how;
    }
}

TEST(SoftBody, WhatIsNoNumberPutsItBackInShapeAndIsTold) {
    SoftBody body = block({});
    body.put(7, Vec3(std::nan(""), 0.0, 0.0), Vec3(0.0));
    EXPECT_EQ(body.step(earth, {}, {}), soft_lost);
    EXPECT_EQ(farthest_from_rest(body), 0.0);
    EXPECT_EQ(body.step(earth, {}, {}), 0u);
}

TEST(SoftBody, TheSameStepsGiveTheSameBits) {
    std::uint64_t hashes[2];
    for (std::uint64_t& hash : hashes) {
        SoftBody body = block({.stiffness = 5e4}, below(-0.039));
        SoftBody sheet = cloth({}, {Vec3(-1.0, -1.0, -0.16), Vec3(1.0, 1.0, -0.14), {}});
        Press press(body, Vec3(0.01, 0.04, 0.02));
        for (int i = 0; i < 300; ++i) {
            press.tick(Vec3(2e-5, -5e-5, 1e-5));
            sheet.step(earth, {}, {});
        }
        hash = bits_of(body) ^ bits_of(sheet);
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(SoftBody, AStepAllocatesNothing) {
    SoftBody body = block({}, below(-0.039));
    SoftBody sheet = cloth({}, {});
    const Solid floor = PlaneShape{};
    SoftObstacle ground{&floor, {Vec3(0.0, -0.05, 0.0)}, {Vec3(0.0, -0.05, 0.0)}, 0.5};
    std::array<SoftPush, 6> pushes;
    for (std::size_t i = 0; i < pushes.size(); ++i) {
        pushes[i] = {static_cast<std::uint32_t>(3 * i),
                     Vec3(1.0 / 3.0),
                     Vec3(0.0, -1.0, 0.1),
                     500.0,
                     1.0,
                     Vec3(0.0),
                     i % 2 == 0};
    }
    testing::AuditScope audit;
    for (int i = 0; i < 100; ++i) {
        body.step(earth, pushes, {});
        sheet.step(earth, {}, {&ground, 1});
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.frees(), 0u) << audit.describe();
    EXPECT_EQ(audit.locks() + audit.waits() + audit.system_calls(), 0u) << audit.describe();
}

// Two hands on one point share what one of twice the stiffness bears.
TEST(SoftBody, SeveralHandsAgreeWithOneAnother) {
    const auto pressed_in = [](int hands, double stiffness) {
        SoftBody body = block({}, below(-0.039));
        const std::uint32_t triangle = triangle_near(body, Vec3(0.0, 0.04, 0.0));
        const Vec3 weights(1.0 / 3.0);
        const Vec3 goal = body.surface_point(triangle, weights) - Vec3(0.0, 0.01, 0.0);
        for (int i = 0; i < 1500; ++i) {
            std::vector<SoftPush> pushes(
                static_cast<std::size_t>(hands),
                {triangle, weights, stiffness * (goal - body.surface_point(triangle, weights)), stiffness,
                 0.0, Vec3(0.0), true});
            body.step(Vec3(0.0), pushes, {});
        }
        return body.surface_point(triangle, weights).y;
    };
    EXPECT_NEAR(pressed_in(2, 300.0), pressed_in(1, 600.0), 1e-6);
}

TEST(SoftBody, LiesOnTheGroundAndDoesNotSlideWhereFrictionHolds) {
    for (const double friction : {1.0, 0.1}) {
        SoftBody body = block({.stiffness = 5e4, .damping = 0.005, .friction = friction});
        const Solid floor = PlaneShape{};
        const Vec3 slope = glm::normalize(Vec3(std::tan(0.3), -1.0, 0.0)) * 9.81;  // 17 degrees
        SoftObstacle ground{&floor, {Vec3(0.0, -0.041, 0.0)}, {Vec3(0.0, -0.041, 0.0)}, friction};
        for (int i = 0; i < 1000; ++i) {
            body.step(slope, {}, {&ground, 1});
        }
        double lowest = 1.0, middle = 0.0;
        for (const Lanes& row : body.places()) {
            lowest = std::min(lowest, row[1]);
            middle += row[0] / static_cast<double>(body.places().size());
        }
        EXPECT_GT(lowest, -0.0412);
        EXPECT_TRUE(friction > 0.5 ? middle < 0.01 : middle > 0.3) << middle;
    }
}

// A plate that is held along an edge swings as a rigid one, whatever it is made of: T = 2 pi sqrt(I / (m g
// d)).
TEST(SoftBody, APlateSwingsAboutItsEdgeAsARigidOne) {
    const Vec3 half(0.05, 0.05, 0.01);
    const HeldParts edge{Vec3(-1.0, 0.049, 0.009), Vec3(1.0), {}};
    const double d2 = half.y * half.y + half.z * half.z;  // I / m is 4/3 of it
    const double wanted = 2.0 * std::numbers::pi * std::sqrt(4.0 / 3.0 * d2 / (9.81 * std::sqrt(d2)));
    for (const double stiffness : {1e5, 1e6}) {
        for (const double damping : {0.0, 2e-3, 0.02}) {
            const SoftMaterial material{.stiffness = stiffness, .damping = damping, .drag = 0.0};
            SoftModelResult made = make_soft_volume(shared::grid_box(half, 5), 5, material, edge, tick);
            ASSERT_EQ(made.error, "");
            SoftBody plate(std::move(made.model));
            EXPECT_NEAR(period_of(plate), wanted, 0.05 * wanted) << stiffness << " Pa, " << damping << " s";
        }
    }
}

// A cantilever of Poisson's ratio 0: Euler's beam.
struct Beam {
    static constexpr double length = 0.2, side = 0.02;
    SoftBody body;
    double stiffness;

    Beam(double youngs_modulus, double damping, double drag, int cells)
        : body(made(youngs_modulus, damping, drag, cells)), stiffness(youngs_modulus) {}

    static SoftBody made(double youngs_modulus, double damping, double drag, int cells) {
        const SoftMaterial material{
            .stiffness = youngs_modulus, .poisson_ratio = 0.0, .damping = damping, .drag = drag};
        const Vec3 half = 0.5 * Vec3(length, side, side);
        SoftModelResult made = make_soft_volume(shared::grid_box(half, 1), cells, material,
                                                {Vec3(-1.0), Vec3(1e-4 - half.x, 1.0, 1.0), {}}, tick);
        EXPECT_EQ(made.error, "");
        return SoftBody(std::move(made.model));
    }
    double mean_at_end(std::span<const Lanes> rows) const {
        double sum = 0.0;
        int count = 0;
        for (std::size_t n = 0; n < rows.size(); ++n) {
            if (body.model().rest[n].x > 0.4999 * length) {
                sum += rows[n][1];
                ++count;
            }
        }
        return sum / count;
    }
    double first_period() const {
        return 2.0 * std::numbers::pi * length * length /
               (3.516 * std::sqrt(stiffness * side * side / (12.0 * 1000.0)));
    }
};

TEST(SoftBody, ACantileverSagsAsABeamWhateverItsCells) {
    for (const int cells : {4, 8, 16}) {
        Beam beam(1e6, 0.02, 5.0, cells);
        const double pull = 0.5;
        for (int i = 0; i < 8000; ++i) {
            beam.body.step(Vec3(0.0, -pull, 0.0), {}, {});
        }
        const double bending =
            1.5 * 1000.0 * pull * std::pow(Beam::length, 4) / (1e6 * Beam::side * Beam::side);
        EXPECT_NEAR(-beam.mean_at_end(beam.body.places()), bending, 0.1 * bending) << cells << " cells";
    }
}

TEST(SoftBody, ACantileverSwingsAsABeam) {
    for (const double stiffness : {1e5, 1e6, 1e7}) {
        Beam beam(stiffness, 2e-3, 0.0, 8);
        const double wanted = beam.first_period();
        for (std::size_t n = 0; n < beam.body.places().size(); ++n) {
            const Vec3 rest = beam.body.model().rest[n];
            const double along = rest.x / Beam::length + 0.5;
            beam.body.put(n, rest, {0.0, 0.01 / wanted * along * along, 0.0});
        }
        double before = 0.0, first = 0.0, last = 0.0;
        int count = 0;
        for (int i = 0; i * tick < 5.0 * wanted; ++i) {
            beam.body.step(Vec3(0.0), {}, {});
            const double now = beam.mean_at_end(beam.body.velocities());
            if (now * before < 0.0) {
                last = (i + now / (before - now)) * tick;
                first = count++ == 0 ? last : first;
            }
            before = now;
        }
        ASSERT_GT(count, 3);
        EXPECT_NEAR(2.0 * (last - first) / (count - 1), wanted, 0.05 * wanted) << stiffness << " Pa";
    }
}

// A rigid one has 5/7 g sin. What is soft goes as far as that says where it hardly flattens; and it gains no
// energy from damping that would take its turn for a stretch.
TEST(SoftBody, ABallRollsAsARigidOne) {
    constexpr double radius = 0.03, angle = 0.15, seconds = 0.6;
    for (const double damping : {0.0, 0.02}) {
        const SoftMaterial material{.stiffness = 3e4, .damping = damping, .drag = 0.0, .friction = 1.0};
        SoftModelResult made = make_soft_volume(shared::icosphere(4, radius), 8, material, {}, tick);
        ASSERT_EQ(made.error, "");
        SoftBody ball(std::move(made.model));
        const Solid floor = PlaneShape{};
        const Pose place{Vec3(0.0, -radius, 0.0)};
        SoftObstacle ground{&floor, place, place, 1.0};
        const auto roll = [&](double slope, double time) {
            for (int i = 0; i * tick < time; ++i) {
                ball.step(9.81 * Vec3(std::sin(slope), -std::cos(slope), 0.0), {}, {&ground, 1});
            }
            return momentum_of(ball).linear.x / ball.model().total_mass();
        };
        const double before = roll(0.0, 0.5);
        const double gained = roll(angle, seconds) - before;
        const double rigid = 5.0 / 7.0 * 9.81 * std::sin(angle) * seconds;
        EXPECT_LT(gained, 1.05 * rigid);
        EXPECT_GT(gained, damping == 0.0 ? 0.95 * rigid : 0.0);
    }
}

// It is not sunk in, and the ground bears what it weighs.
TEST(SoftBody, ABallLiesOnTheGroundAsItsStiffnessSays) {
    constexpr double radius = 0.05;
    SoftModelResult made = make_soft_volume(shared::icosphere(4, radius), 8, {.stiffness = 3e5}, {}, tick);
    ASSERT_EQ(made.error, "");
    SoftBody ball(std::move(made.model));
    const Solid floor = PlaneShape{};
    const Pose place{Vec3(0.0, -radius, 0.0)};
    SoftObstacle ground{&floor, place, place, 0.5};
    for (int i = 0; i < 1500; ++i) {
        ground.impulse = Vec3(0.0);
        ball.step(earth, {}, {&ground, 1});
    }
    Vec3 middle(0.0);
    for (std::size_t n = 0; n < ball.places().size(); ++n) {
        middle += ball.model().mass[n] / ball.model().total_mass() * at(ball.places()[n]);
    }
    const double weight = ball.model().total_mass() * 9.81;
    EXPECT_NEAR(ground.impulse.y / tick, -weight, 0.02 * weight);
    // Hertz: d^1.5 = 3 F (1 - nu^2) / (4 E sqrt(R)).
    const double sunk = std::pow(0.75 * weight * (1.0 - 0.09) / (3e5 * std::sqrt(radius)), 2.0 / 3.0);
    EXPECT_LT(-middle.y, 1.5 * sunk);
    EXPECT_GT(-middle.y, 0.5 * sunk);
}

TEST(SoftBody, APushNeverPulls) {
    SoftBody body = block({}, below(-0.039));
    const std::uint32_t triangle = triangle_near(body, Vec3(0.0, 0.04, 0.0));
    const SoftPush push{triangle, Vec3(1.0 / 3.0), Vec3(0.0, -0.1, 0.0), 500.0, 0.0, Vec3(0.0, 2.0, 0.0),
                        true};
    body.step(Vec3(0.0), {&push, 1}, {});
    EXPECT_EQ(body.pressed(0), Vec3(0.0));
}

}  // namespace
}  // namespace tactus::soft_body_test
