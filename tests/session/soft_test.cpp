// Bodies that give, touched.
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "core/math/bit_hash.hpp"
#include "core/soft/soft_model.hpp"
#include "core/tool/tool_shape.hpp"
#include "session_rig.hpp"
#include "shared/meshes.hpp"
#include "shared/soft_figures.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::soft_test {
namespace {

using session_test::body;
using session_test::ground;
using session_test::SessionRig;
using shared::distance_to_surface;
using shared::winds_around;

constexpr double radius = 0.01;

struct SoftRig : SessionRig {
    std::shared_ptr<const SoftModel> model;
    std::shared_ptr<SoftView> view;
    SessionHandle handle = no_handle;

    // A block of 80 mm on the floor, its middle at the given height.
    SoftRig(const SoftMaterial& material, const HeldParts& held, double height = 0.04,
            double friction = 0.0) {
        add(ground());
        const SoftModelResult made =
            make_soft_volume(shared::grid_box(Vec3(0.04), 6), 6, material, held, 1e-3);
        EXPECT_EQ(made.error, "");
        model = made.model;
        view = std::make_shared<SoftView>(model->surface.vertices);
        BodyAddition addition;
        addition.description.pose.position = Vec3(0.0, height, 0.0);
        addition.touch_material = {500.0, 0.0, friction, friction};
        addition.soft = model;
        addition.soft_view = view;
        handle = add(addition);
        device.position = Vec3(0.0, height + 0.06, 0.0);
    }

    // As it is now, in the world.
    TriangleMesh surface(double height = 0.04) {
        view->refresh();
        TriangleMesh mesh = model->surface;
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
            mesh.vertices[i] = view->places()[i] + Vec3(0.0, height, 0.0);
        }
        return mesh;
    }
};

const HeldParts foot{Vec3(-1.0), Vec3(1.0, -0.039, 1.0), {}};

TEST(Soft, ABlockGivesUnderAHandWhichNeverEntersIt) {
    SoftRig rig({.stiffness = 1e4}, foot);
    rig.session.set_gravity(Vec3(0.0));
    rig.ticks(10);
    double deepest = 1.0;
    for (int i = 0; i < 300; ++i) {
        rig.draw(rig.device.position + Vec3(0.0, i < 150 ? -2e-4 : 2e-4, 0.0), 1);
        const TriangleMesh surface = rig.surface();
        const ProxyState& state = rig.proxy_state();
        ASSERT_FALSE(winds_around(surface, state.position)) << i;
        ASSERT_GT(distance_to_surface(surface, state.position), 0.8 * radius) << i;
        deepest = std::min(deepest, state.position.y - radius);
        ASSERT_LT(std::abs(state.force.x) + std::abs(state.force.z), 0.3 * glm::length(state.force) + 1e-3);
    }
    EXPECT_LT(deepest, 0.075);  // it gave by 5 mm and more
    EXPECT_EQ(rig.proxy_state().contact_count, 0);
    rig.ticks(3000);
    const TriangleMesh after = rig.surface();
    for (std::size_t i = 0; i < after.vertices.size(); ++i) {
        ASSERT_LT(glm::distance(after.vertices[i], rig.model->surface.vertices[i] + Vec3(0.0, 0.04, 0.0)),
                  1e-4);
    }
}

// How much deeper the hand is than the proxy and its spring show, under that force.
double beyond_the_cells(const SoftModel& model, double force) {
    double low = 0.0, high = 1.0;
    for (int halving = 0; halving < 80; ++halving) {
        const double middle = 0.5 * (low + high);
        (indentation_at(model.give, radius, middle).force < force ? low : high) = middle;
    }
    return indentation_at(model.give, radius, low).depth;
}

// At rest the hand's spring, what the cells do not show and the block are in series: the force is k times how
// deep the hand is, less the second, and it is the same in the tick after.
TEST(Soft, HeldInItPressesSteadily) {
    SoftRig rig({.stiffness = 1e4, .damping = 0.01}, foot);
    rig.draw(Vec3(0.0, 0.07, 0.0), 200);
    rig.ticks(2000);
    const ProxyState held = rig.proxy_state();
    const double sunk = beyond_the_cells(*rig.model, held.force.y);
    EXPECT_GT(sunk, 5e-4);
    EXPECT_NEAR(held.force.y, 500.0 * (held.position.y - held.hand.y - sunk), 1e-6);
    EXPECT_GT(held.force.y, 0.5);
    rig.ticks(500);
    EXPECT_NEAR(rig.proxy_state().force.y, held.force.y, 1e-4);
    EXPECT_NEAR(rig.device.force.y, held.force.y, 1e-4);
}

// The same block, made of another material.
ReadyBody made_of(const SoftRig& rig, const SoftMaterial& material, int cells = 6) {
    BodyAddition addition;
    addition.description.pose.position = Vec3(0.0, 0.04, 0.0);
    addition.touch_material = {500.0, 0.0, 0.0, 0.0};
    addition.soft = make_soft_volume(shared::grid_box(Vec3(0.04), 6), cells, material, foot, 1e-3).model;
    addition.soft_view = rig.view;
    return Session::prepare_body(addition);
}

TEST(Soft, MadeOtherwiseUnderAHandKeepsItsShapeAndTheHand) {
    const SoftMaterial yielding{.stiffness = 1e4, .damping = 0.01};
    for (const SoftMaterial& other :
         {SoftMaterial{.stiffness = 4e4, .damping = 0.01}, SoftMaterial{.stiffness = 2.5e3, .damping = 0.01},
          SoftMaterial{.stiffness = 1e4, .poisson_ratio = 0.45, .damping = 0.02},
          SoftMaterial{.stiffness = 1e4, .density = 3000.0, .damping = 0.01}}) {
        SoftRig rig(yielding, foot);
        rig.draw(Vec3(0.0, 0.07, 0.0), 200);
        rig.ticks(1000);
        ProxyState before = rig.proxy_state();
        ASSERT_EQ(rig.session.deform_body(rig.handle, made_of(rig, other)), "");
        for (int i = 0; i < 2000; ++i) {
            rig.ticks(1);
            const ProxyState& now = rig.proxy_state();
            ASSERT_GE(now.contact_count, 1) << i;
            ASSERT_LT(glm::distance(now.position, before.position), 1e-3) << i;
            ASSERT_LT(glm::distance(now.force, before.force), 0.5) << i;
            before = now;
        }
        SoftRig from_the_start(other, foot);
        from_the_start.draw(Vec3(0.0, 0.07, 0.0), 200);
        from_the_start.ticks(3000);
        EXPECT_NEAR(before.force.y, from_the_start.proxy_state().force.y, 1e-3);
        EXPECT_NEAR(before.position.y, from_the_start.proxy_state().position.y, 1e-5);
    }
}

TEST(Soft, OfAnotherStructureDoesNotTakeTheMake) {
    SoftRig rig({.stiffness = 1e4, .damping = 0.01}, foot);
    rig.draw(Vec3(0.0, 0.07, 0.0), 200);
    rig.ticks(1000);
    const double before = rig.proxy_state().force.y;
    ASSERT_EQ(rig.session.deform_body(rig.handle, made_of(rig, {.stiffness = 4e4}, 5)), "");
    rig.ticks(100);
    EXPECT_NEAR(rig.proxy_state().force.y, before, 1e-3);
}

Vec3 mean_place(const TriangleMesh& mesh) {
    Vec3 sum(0.0);
    for (const Vec3& vertex : mesh.vertices) {
        sum += vertex;
    }
    return sum / static_cast<double>(mesh.vertices.size());
}

// Of its surface, once the hand is far away (unit: meters per second).
Vec3 speed_when_let_go(SoftRig& rig) {
    const Vec3 before = mean_place(rig.surface());
    rig.device.position.y = 2.0;
    rig.device.velocity = Vec3(0.0);
    rig.ticks(101);
    return (mean_place(rig.surface()) - before) / 0.101;
}

// What the hand gives a block that floats freely, the block has: both sides feel opposite forces.
TEST(Soft, WhatAHandGivesItHas) {
    SoftRig rig({.stiffness = 1e5, .damping = 0.005, .drag = 0.0}, {}, 1.0);
    rig.session.set_gravity(Vec3(0.0));
    double given = 0.0;  // against its way (unit: newton seconds)
    for (int i = 0; i < 400; ++i) {
        rig.draw(rig.device.position - Vec3(0.0, 2e-4, 0.0), 1);
        given += 1e-3 * rig.proxy_state().force.y;
    }
    EXPECT_NEAR(-speed_when_let_go(rig).y * rig.model->total_mass(), given, 0.05 * given);
    EXPECT_GT(given, 0.01);
}

// A finger that sticks takes the surface along and is held back by what that costs; a smooth one slides.
TEST(Soft, FrictionDragsItsSurfaceAlong) {
    SoftRig smooth({.stiffness = 2e4}, foot, 0.04, 0.0), rough({.stiffness = 2e4}, foot, 0.04, 0.8);
    double held_back[2];
    double* out = held_back;
    for (SoftRig* rig : {&smooth, &rough}) {
        rig->draw(Vec3(0.0, 0.08, 0.0), 100);
        rig->draw(Vec3(0.005, 0.08, 0.0), 200);
        rig->ticks(500);
        *out++ = -rig->proxy_state().force.x;
    }
    EXPECT_LT(std::abs(held_back[0]), 0.3);  // its facets
    // A press acts on one place, whose dent holds back too: 0.27 N without friction, 0.33 N with it.
    EXPECT_GT(held_back[1], 1.15 * held_back[0]);
}

// Of its corners, of a block that was put in at that height (unit: meters).
double lowest(SoftRig& rig, double height) {
    double least = 1.0;
    for (const Vec3& vertex : rig.surface(height).vertices) {
        least = std::min(least, vertex.y);
    }
    return least;
}

TEST(Soft, ABlockThatFallsComesToRestOnTheGround) {
    SoftRig rig({.stiffness = 5e4, .damping = 0.005}, {}, 0.1);
    rig.device.position = Vec3(0.0, 1.0, 0.0);
    rig.ticks(4000);
    EXPECT_NEAR(lowest(rig, 0.1), 0.0, 1e-4);
}

TEST(Soft, ABoxLiesOnABlock) {
    SoftRig rig({.stiffness = 2e4, .damping = 0.01}, foot);
    rig.device.position = Vec3(0.0, 1.0, 0.0);
    const SessionHandle box = rig.add(body(BoxShape{Vec3(0.03)}, Vec3(0.0, 0.13, 0.0), Motion::Dynamic, 0.2));
    rig.ticks(3000);
    const BodyState* const state = rig.state_of(box);
    ASSERT_NE(state, nullptr);
    EXPECT_NEAR(state->pose.position.y, 0.11, 0.01);
    EXPECT_LT(glm::length(state->linear_velocity), 0.02);
}

// Of a block that fell on a table, a second after `change` of the table.
double lowest_after(const std::function<void(SoftRig&, SessionHandle table)>& change) {
    SoftRig rig({.stiffness = 5e4, .damping = 0.01}, {}, 0.08);
    rig.device.position = Vec3(0.0, 1.0, 0.0);
    const SessionHandle table =
        rig.add(body(BoxShape{Vec3(0.2, 0.01, 0.2)}, Vec3(0.0, 0.02, 0.0), Motion::Static));
    rig.ticks(2000);
    EXPECT_NEAR(lowest(rig, 0.08), 0.03, 1e-3);
    change(rig, table);
    rig.ticks(1000);
    return lowest(rig, 0.08);
}

// A form of triangles is none that it lies on (find_obstacles), and another one of solids is one at once.
TEST(Soft, WhatItLiesOnMayGoOrTakeAnotherForm) {
    const auto take = [](SoftRig& rig, SessionHandle table, const Shape& shape) {
        EXPECT_EQ(rig.session.deform_body(
                      table, Session::prepare_body(body(shape, Vec3(0.0, 0.02, 0.0), Motion::Static))),
                  "");
    };
    const auto mesh = std::make_shared<const TriangleMesh>(shared::box(Vec3(0.2, 0.01, 0.2)));
    const auto on_mesh = [&](SoftRig& rig, SessionHandle table) { take(rig, table, MeshShape{mesh}); };
    const auto on_thinner = [&](SoftRig& rig, SessionHandle table) {
        take(rig, table, BoxShape{Vec3(0.2, 0.005, 0.2)});
    };
    const auto on_none = [](SoftRig& rig, SessionHandle table) { rig.session.remove_body(table); };
    EXPECT_NEAR(lowest_after(on_mesh), 0.0, 2e-3);
    EXPECT_NEAR(lowest_after(on_thinner), 0.025, 2e-3);
    EXPECT_NEAR(lowest_after(on_none), 0.0, 2e-3);
}

// The height of the middle of a block that stood asleep, half a second after `change` of a plate beside it.
double top_after(const std::function<void(SoftRig&, SessionHandle plate)>& change) {
    SoftRig rig({.stiffness = 1e4, .damping = 0.01}, foot);
    rig.device.position = Vec3(0.0, 1.0, 0.0);
    const SessionHandle plate =
        rig.add(body(BoxShape{Vec3(0.1, 0.01, 0.1)}, Vec3(0.0, 0.5, 0.0), Motion::Static));
    rig.ticks(3000);
    rig.surface();
    rig.ticks(10);
    EXPECT_FALSE(rig.view->refresh()) << "it does not sleep";
    change(rig, plate);
    rig.ticks(500);
    double highest = 0.0;
    for (const Vec3& vertex : rig.surface().vertices) {
        highest = std::max(highest, vertex.y);
    }
    return highest;
}

TEST(Soft, ABlockThatSleepsNoticesWhatComes) {
    const Pose pressing{Vec3(0.0, 0.08, 0.0)};
    EXPECT_NEAR(
        top_after([&](SoftRig& rig, SessionHandle plate) { rig.session.teleport_body(plate, pressing); }),
        0.07, 2e-3);
    EXPECT_NEAR(
        top_after([&](SoftRig& rig, SessionHandle plate) { rig.session.move_body(plate, pressing, 0.3); }),
        0.07, 2e-3);
    EXPECT_NEAR(top_after([&](SoftRig& rig, SessionHandle) {
                    rig.add(body(BoxShape{Vec3(0.1, 0.01, 0.1)}, pressing.position, Motion::Static));
                }),
                0.07, 2e-3);
}

TEST(Soft, ATickAllocatesLocksAndCallsNothing) {
    SoftRig rig({.stiffness = 1e4}, foot);
    rig.ticks(20);
    rig.newest();
    testing::AuditScope audit;
    for (int i = 0; i < 400; ++i) {
        rig.device.position.y += i < 200 ? -1.5e-4 : 1.5e-4;
        rig.session.tick(rig.now += session_test::period);
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.frees(), 0u) << audit.describe();
    EXPECT_EQ(audit.locks() + audit.waits() + audit.system_calls(), 0u) << audit.describe();
}

TEST(Soft, TheSameTouchesGiveTheSameBits) {
    std::uint64_t hashes[2];
    for (std::uint64_t& hash : hashes) {
        SoftRig rig({.stiffness = 1e4}, {}, 0.045);
        BitHash bits;
        for (int i = 0; i < 500; ++i) {
            rig.draw(rig.device.position + Vec3(2e-5, i < 300 ? -1.5e-4 : 1e-4, 1e-5), 1);
            bits.add(rig.proxy_state().force);
        }
        hash = bits.value();
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Soft, ItCanBeTakenOutWhileItIsTouched) {
    SoftRig rig({.stiffness = 1e4}, foot);
    rig.draw(Vec3(0.0, 0.075, 0.0), 100);
    EXPECT_GT(rig.proxy_state().contact_count, 0);
    rig.session.remove_body(rig.handle);
    rig.ticks(10);
    rig.session.collect();
    EXPECT_EQ(rig.proxy_state().contact_count, 0);
}

// A force that may jump fades in over many ticks: on what gives, the hand's own way makes it, tick by tick.
TEST(Soft, TheForceFollowsTheHandWithoutFading) {
    SoftRig rig({.stiffness = 3e4}, foot);
    rig.draw(Vec3(0.0, 0.085, 0.0), 50);
    double before = rig.proxy_state().force.y, largest = 0.0;
    for (int i = 0; i < 60; ++i) {
        rig.draw(rig.device.position - Vec3(0.0, 1e-4, 0.0), 1);
        const ProxyState& state = rig.proxy_state();
        const double sunk = beyond_the_cells(*rig.model, state.force.y);
        EXPECT_NEAR(state.force.y, 500.0 * (state.position.y - state.hand.y - sunk), 1e-6) << i;
        largest = std::max(largest, std::abs(state.force.y - before));
        before = state.force.y;
    }
    EXPECT_LT(largest, 0.06);
}

// A brick of 40 by 20 by 40 mm in place of the fingertip.
struct SoftToolRig : SoftRig {
    std::shared_ptr<const ToolShape> brick;

    SoftToolRig(const SoftMaterial& material, const HeldParts& held, double height = 0.04,
                double friction = 0.0)
        : SoftRig(material, held, height, friction) {
        static const ToolShapeResult made = make_tool_shape(shared::box({0.02, 0.01, 0.02}), {1e-3, 200});
        brick = made.shape;
        session.remove_proxy(proxy);
        let_turn(device);
        ToolUse use;
        use.device = hand;
        session.add_tool(brick, use);
    }
    const ToolState& tool() { return newest().tools[0]; }
    // Of any sphere's centre, over its radius; below 0 where it is inside of the surface.
    double least_room(const TriangleMesh& form) {
        double least = 1e9;
        for (const ToolSphere& sphere : brick->spheres) {
            const Vec3 center = to_parent(tool().pose, sphere.center);
            const double away = distance_to_surface(form, center) / sphere.radius;
            least = std::min(least, winds_around(form, center) ? -away : away);
        }
        return least;
    }
};

// Pressed in by about 10 mm and let go, while it turns in the hand, at 0.1 and at 0.3 m/s.
TEST(SoftTool, ABlockGivesUnderAToolWhichNeverEntersIt) {
    for (const double step : {1e-4, 3e-4}) {
        SoftToolRig rig({.stiffness = 1e4}, foot);
        rig.session.set_gravity(Vec3(0.0));
        rig.ticks(10);
        const int ticks = static_cast<int>(0.046 / step);
        double deepest = 1.0;
        for (int i = 0; i < ticks; ++i) {
            rig.device.rotation =
                glm::angleAxis(0.3 * std::sin(70.0 * step * i), glm::normalize(Vec3(1.0, 0.0, 0.4)));
            const TriangleMesh touched = rig.surface();  // it takes its next form after the tool has moved
            rig.draw(rig.device.position + Vec3(0.0, 2 * i < ticks ? -step : step, 0.0), 1);
            ASSERT_EQ(rig.tool().status & tool_squeezed, 0u) << i;
            if (i % 5 == 0) {
                ASSERT_GT(rig.least_room(touched), 0.5) << i;
            }
            deepest = std::min(deepest, rig.tool().pose.position.y - 0.01);
        }
        EXPECT_LT(deepest, 0.073);
        EXPECT_EQ(rig.tool().contact_count, 0);
        rig.ticks(6000);
        const TriangleMesh after = rig.surface();
        for (std::size_t i = 0; i < after.vertices.size(); ++i) {
            ASSERT_LT(glm::distance(after.vertices[i], rig.model->surface.vertices[i] + Vec3(0.0, 0.04, 0.0)),
                      1e-4);
        }
    }
}

TEST(SoftTool, HeldInItPressesSteadily) {
    SoftToolRig rig({.stiffness = 1e4, .damping = 0.01}, foot);
    rig.draw(Vec3(0.0, 0.082, 0.0), 200);
    rig.ticks(2000);
    const ToolState held = rig.tool();
    EXPECT_NEAR(held.force.y, 1000.0 * (held.pose.position.y - held.hand.position.y), 1e-6);
    EXPECT_GT(held.force.y, 2.0);
    rig.ticks(500);
    EXPECT_NEAR(rig.tool().force.y, held.force.y, 0.01 * held.force.y);
}

TEST(SoftTool, WhatAToolGivesItHas) {
    SoftToolRig rig({.stiffness = 1e5, .damping = 0.005, .drag = 0.0}, {}, 1.0);
    rig.session.set_gravity(Vec3(0.0));
    double given = 0.0;
    for (int i = 0; i < 400; ++i) {
        rig.draw(rig.device.position - Vec3(0.0, 2e-4, 0.0), 1);
        given += 1e-3 * rig.tool().force.y;
    }
    EXPECT_NEAR(-speed_when_let_go(rig).y * rig.model->total_mass(), given, 0.05 * given);
    EXPECT_GT(given, 0.01);
}

TEST(SoftTool, NoPressGivesEnergy) {
    SoftToolRig rig({.stiffness = 1e4}, foot, 0.04, 0.3);
    rig.session.set_gravity(Vec3(0.0));
    rig.ticks(10);
    for (int press = 0; press < 6; ++press) {
        const Vec3 begin(0.004 * press - 0.01, 0.095, 0.003 * press);
        rig.draw(begin, 30);
        rig.device.rotation = glm::angleAxis(0.1 * press, Vec3(0.0, 0.0, 1.0));
        rig.ticks(5);
        double gained = 0.0;
        Vec3 before = rig.tool().force;
        for (int i = 1; i <= 200; ++i) {
            const double depth = 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * i / 200));
            const Vec3 place = begin - Vec3(0.0, 0.02 * depth, 0.0);
            const Vec3 way = place - rig.device.position;
            rig.draw(place, 1);
            gained += 0.5 * glm::dot(before + rig.tool().force, way);
            before = rig.tool().force;
        }
        EXPECT_LE(gained, 1e-6) << press;
        EXPECT_LT(gained, -1e-4) << "some is damped";
    }
}

TEST(SoftTool, ATickAllocatesLocksAndCallsNothing) {
    SoftToolRig rig({.stiffness = 1e4}, foot);
    rig.ticks(20);
    rig.newest();
    testing::AuditScope audit;
    for (int i = 0; i < 200; ++i) {
        rig.device.position.y += i < 100 ? -3e-4 : 3e-4;
        rig.session.tick(rig.now += session_test::period);
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.frees(), 0u) << audit.describe();
    EXPECT_EQ(audit.locks() + audit.waits() + audit.system_calls(), 0u) << audit.describe();
}

TEST(SoftTool, TheSamePressesGiveTheSameBits) {
    std::uint64_t hashes[2];
    for (std::uint64_t& hash : hashes) {
        SoftToolRig rig({.stiffness = 1e4}, {}, 0.045, 0.5);
        BitHash bits;
        for (int i = 0; i < 300; ++i) {
            rig.draw(rig.device.position + Vec3(5e-5, i < 200 ? -2e-4 : 1e-4, 1e-5), 1);
            bits.add(rig.tool().force);
            bits.add(rig.tool().torque);
        }
        hash = bits.value();
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

// Twelve blocks of 512 cells, which fall onto themselves, want more than a tick has for them.
TEST(Soft, SeveralShareATickAndWhatIsPressedGoesFirst) {
    SessionRig rig;
    std::vector<std::shared_ptr<SoftView>> views;
    const SoftModelResult made =
        make_soft_volume(shared::grid_box(Vec3(0.04), 8), 8, {.stiffness = 1e4}, foot, 1e-3);
    ASSERT_EQ(made.error, "");
    for (int i = 0; i < 12; ++i) {
        BodyAddition addition;
        addition.description.pose.position = Vec3(0.2 * i, 0.0, 0.0);
        addition.touch_material = {500.0, 0.0, 0.0, 0.0};
        addition.soft = made.model;
        addition.soft_view = views.emplace_back(std::make_shared<SoftView>(made.model->surface.vertices));
        rig.add(addition);
    }
    rig.device.position = Vec3(0.0, 0.06, 0.0);
    rig.ticks(2);
    rig.draw(Vec3(0.0, 0.045, 0.0), 20);
    int steps[12] = {};
    int pressed = 0;  // ticks
    for (int i = 0; i < 240; ++i) {
        rig.draw(rig.device.position + Vec3(0.0, i % 2 == 0 ? -1e-4 : 1e-4, 0.0), 1);
        pressed += rig.proxy_state().contact_count > 0;
        for (std::size_t body = 0; body < views.size(); ++body) {
            steps[body] += views[body]->refresh();
        }
    }
    EXPECT_GE(steps[0], pressed);
    EXPECT_GT(pressed, 100);
    EXPECT_GT(rig.newest().slowed_bodies, 0u);
    const auto [least, most] = std::minmax_element(std::begin(steps) + 1, std::end(steps));
    EXPECT_GT(*least, 40);
    EXPECT_LT(*most, 240);
    EXPECT_LE(*most - *least, 3);
}

TEST(Soft, AClothIsNotPassed) {
    SessionRig rig;
    const SoftModelResult made = make_soft_sheet(
        shared::terrain(15, 0.3, 0.0), {.stiffness = 1e6, .density = 300.0, .thickness = 1e-3},
        {Vec3(-1.0, -1.0, -1.0), Vec3(-0.149, 1.0, 1.0), {15, 255}}, 1e-3);
    ASSERT_EQ(made.error, "");
    auto view = std::make_shared<SoftView>(made.model->surface.vertices);
    BodyAddition addition;
    addition.touch_material = {500.0, 0.0, 0.0, 0.0};
    addition.soft = made.model;
    addition.soft_view = view;
    rig.device.position = Vec3(0.0, 0.05, 0.0);
    rig.add(addition);
    rig.ticks(500);
    for (int i = 0; i < 400; ++i) {
        rig.draw(rig.device.position + Vec3(0.0, i < 200 ? -3e-4 : 3e-4, 0.0), 1);
        view->refresh();
        TriangleMesh mesh = made.model->surface;
        mesh.vertices = view->places();
        ASSERT_GT(shared::height_above(mesh, rig.proxy_state().position), 0.5 * radius) << i;
    }
}

}  // namespace
}  // namespace tactus::soft_test
