// Where more triangles are near than a tick can look at, the proxy still goes where it may.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <vector>

#include "core/proxy/contact_look.hpp"
#include "core/proxy/proxy.hpp"
#include "shared/hand_paths.hpp"
#include "shared/judge_tree.hpp"
#include "shared/meshes.hpp"
#include "shared/random_values.hpp"
#include "shared/reference_descent.hpp"
#include "shared/rough_meshes.hpp"
#include "shared/rough_paths.hpp"
#include "shared/touch_rig.hpp"

namespace tactus::proxy_budget_test {
namespace {

using shared::around_sphere;
using shared::cone;
using shared::icosphere;
using shared::RandomValues;
using shared::rough_sphere;
using shared::TouchRig;

// Ticks in which the proxy stood still although it was not where it should be.
struct Watch {
    int frozen = 0, unfinished = 0, touching = 0;
    Vec3 before{1e9};

    void look(const ProxyTick& tick, const Vec3& hand, double radius) {
        unfinished += (tick.status & proxy_unfinished) != 0;
        touching += (tick.status & proxy_touching) != 0;
        frozen += (tick.status & proxy_unfinished) && tick.position == before &&
                  glm::distance(hand, tick.position) > 1e-3 * radius;
        before = tick.position;
    }
};

void limit_work(TouchRig& rig, std::int64_t units) {
    ProxySettings settings = rig.proxy.settings();
    settings.max_work = units;
    rig.proxy.set_settings(settings);
}

// The sphere's cube meets tens of thousands of boxes here.
TEST(ProxyBudget, OnARoughMeshOfAMillionTrianglesItIsNeverFrozen) {
    constexpr double radius = 0.05;
    const TriangleMesh mesh = rough_sphere(8, 0.5, 0.3);
    const shared::JudgeTree judge(mesh);
    TouchRig rig(radius);
    rig.add(mesh);
    Watch watch;
    for (int i = 0; i < 4'000; ++i) {
        const double angle = 0.001 * i;
        const double depth = 0.06 * std::sin(0.004 * i) - 0.01;
        const Vec3 hand =
            (0.5 + radius - depth) * Vec3(std::cos(angle), 0.3 * std::sin(3.0 * angle), std::sin(angle));
        const ProxyTick tick = rig.tick(hand);
        watch.look(tick, hand, radius);
        if (i % 50 == 0) {
            ASSERT_GE(judge.nearest(tick.position, 2.0 * radius).distance, radius) << "tick " << i;
        }
    }
    EXPECT_GT(watch.touching, 1'500);
    EXPECT_EQ(watch.frozen, 0);
    EXPECT_LT(watch.unfinished, 40);
}

// All of its 327,680 triangles are within one and a half radii of the centre.
TEST(ProxyBudget, InsideAFineBallItMovesAndStaysInside) {
    constexpr double radius = 0.05;
    const TriangleMesh mesh = shared::icosphere(7, 1.5 * radius);
    const shared::JudgeTree judge(mesh);
    TouchRig rig(radius);
    rig.add(mesh);
    RandomValues random(8);
    Watch watch;
    Vec3 hand(0.0);
    ASSERT_EQ(rig.tick(hand).status, 0u);
    const auto look = [&](int i) {
        const ProxyTick tick = rig.tick(hand);
        watch.look(tick, hand, radius);
        ASSERT_LT(glm::length(tick.position), 0.5 * radius) << "tick " << i;
        ASSERT_GE(judge.nearest(tick.position, 2.0 * radius).distance, radius) << "tick " << i;
    };
    // Along its inside, the hand up to a radius behind the surface.
    for (int i = 0; i < 2'000; ++i) {
        const double reach = radius * (0.7 + 0.5 * std::sin(0.02 * i));
        hand = reach * Vec3(std::cos(0.007 * i), 0.3 * std::sin(0.011 * i), std::sin(0.007 * i));
        ASSERT_NO_FATAL_FAILURE(look(i));
    }
    EXPECT_GT(watch.touching, 500);
    EXPECT_EQ(watch.unfinished, 0);
    // Thrown about, it is on its way in every tick and arrives soon.
    for (int i = 0; i < 40; ++i) {
        hand = radius * random.direction();
        for (int k = 0; k < 50; ++k) {
            ASSERT_NO_FATAL_FAILURE(look(i));
        }
        EXPECT_LT(glm::distance(rig.proxy.position(), 0.5 * hand), 2e-3 * radius) << i;
    }
    EXPECT_EQ(watch.frozen, 0);
}

// Whatever the work ends at, a hand that stays behind the surface feels it in every tick.
TEST(ProxyBudget, WithLittleWorkTheForceDoesNotFlicker) {
    constexpr double radius = 0.05;
    const TriangleMesh mesh = rough_sphere(7, 0.5, 0.3);
    int unfinished = 0;
    for (const int work : {1'000, 1'400, 2'000, 2'800, 4'000}) {
        TouchRig rig(radius);
        rig.add(mesh);
        ASSERT_TRUE(rig.draw({0.6, 0.0, 0.0}, {0.5, 0.0, 0.0}, 400).status & proxy_touching);
        limit_work(rig, work);
        int lost = 0;
        for (int i = 1; i <= 1'000; ++i) {
            const Vec3 hand = 0.5 * Vec3(std::cos(0.004 * i), std::sin(0.004 * i), 0.0);
            const ProxyTick tick = rig.tick(hand);
            unfinished += (tick.status & proxy_unfinished) != 0;
            lost += (tick.status & proxy_touching) == 0;
        }
        EXPECT_EQ(lost, 0) << work;
    }
    EXPECT_GT(unfinished, 100);
}

// A step that the next facet stops goes on from what is known: the work does for more of them.
TEST(ProxyBudget, FacetAfterFacetContactsAreNotSoughtAnew) {
    constexpr double radius = 0.05;
    TouchRig rig(radius);
    rig.add(rough_sphere(7, 0.5, 0.3));
    rig.draw({0.6, 0.0, 0.0}, {0.5, 0.0, 0.0}, 400);
    limit_work(rig, 6'000);
    int unfinished = 0;
    for (int i = 1; i <= 1'000; ++i) {
        const double angle = 0.01 * i;
        const ProxyTick tick = rig.tick(0.5 * Vec3(std::cos(angle), std::sin(angle), 0.0));
        unfinished += (tick.status & proxy_unfinished) != 0;
    }
    EXPECT_LT(unfinished, 100);
}

// A step that the next facet stops was planned without it: what it promised does not end the trust in bent
// steps (see StepTrust::doubt).
TEST(ProxyBudget, WhatAStoppedStepPromisedIsNotHeldAgainstTheNext) {
    int unfinished = 0, touching = 0;
    for (const double radius : {0.05, 0.1, 0.2}) {
        TouchRig rig(radius);
        rig.add(rough_sphere(7, 0.5, 0.1));
        rig.draw({0.5 + 2.0 * radius, 0.0, 0.0}, {0.5, 0.0, 0.0}, 400);
        for (int i = 1; i <= 400; ++i) {
            const ProxyTick tick = rig.tick(0.5 * Vec3(std::cos(0.02 * i), std::sin(0.02 * i), 0.0));
            unfinished += (tick.status & proxy_unfinished) != 0;
            touching += (tick.status & proxy_touching) != 0;
        }
    }
    EXPECT_EQ(touching, 1'200);
    EXPECT_LE(unfinished, 2);
}

// Over bumps finer than the sphere what stops a step is mostly less than a thousandth of the radius ahead
// where the step is planned, and most edges that a bent step leads beside fall away from it.
TEST(ProxyBudget, OverFineBumpsStepsAreNotStoppedOneByOne) {
    int steps = 0, long_ticks = 0, touching = 0;
    for (const double share : {0.1, 0.3}) {
        for (const double depth : {0.2, 0.5}) {
            TouchRig rig(0.1);
            rig.add(rough_sphere(6, 0.5, share));
            const double hand = 0.5 * (1.0 - depth);
            rig.draw({0.7, 0.0, 0.0}, {hand, 0.0, 0.0}, 200);
            for (int i = 1; i <= 400; ++i) {
                const ProxyTick tick = rig.tick(hand * Vec3(std::cos(0.02 * i), std::sin(0.02 * i), 0.0));
                steps += tick.steps;
                long_ticks += tick.steps > 16;
                touching += (tick.status & proxy_touching) != 0;
            }
        }
    }
    EXPECT_EQ(touching, 1'600);
    EXPECT_LE(steps, 6'700);
    EXPECT_LE(long_ticks, 25);
}

// More than a list of contacts holds are exactly as near.
TEST(ProxyBudget, OnATipOfAThousandTrianglesItIsHeld) {
    TouchRig rig(0.1);
    rig.add(cone(1'000, 1.0));
    rig.draw({0.0, 1.5, 0.0}, {0.05, 0.3, 0.0}, 200);
    int touching = 0, unfinished = 0;
    for (int i = 0; i < 1'000; ++i) {
        const ProxyTick tick = rig.tick({0.05 * std::cos(0.02 * i), -0.05, 0.03 * std::sin(0.03 * i)});
        touching += (tick.status & proxy_touching) != 0;
        unfinished += (tick.status & proxy_unfinished) != 0;
    }
    EXPECT_EQ(touching, 1'000);
    EXPECT_LE(unfinished, 250);
}

// An edge as long as the sphere is wide says nothing of a hill that many facets make.
TEST(ProxyBudget, OverEvenMeshesStepsGoByTheirEdges) {
    int touching = 0, long_ticks = 0;
    for (const int levels : {2, 3, 4, 5}) {
        const double radius = 0.05;
        TouchRig rig(radius);
        rig.add(icosphere(levels, 1.0));
        for (const Vec3& hand : around_sphere(radius, 10'000)) {
            const ProxyTick tick = rig.tick(hand);
            touching += (tick.status & proxy_touching) != 0;
            long_ticks += tick.steps > 3;
        }
    }
    EXPECT_GT(touching, 19'000);
    EXPECT_LE(long_ticks, 80);
}

// Wherever the work ends, a tick that calls itself finished is where exact descent ends.
TEST(ProxyBudget, WithLittleWorkNoTickIsCalledFinishedThatIsNot) {
    constexpr double radius = 0.05;
    const TriangleMesh mesh = rough_sphere(6, 0.5, 0.3);
    shared::ReferenceDescent reference(mesh, radius);
    int finished = 0, unfinished = 0;
    for (int work = 500; work < 4'000; work += 50) {
        TouchRig rig(radius);
        rig.add(mesh);
        ASSERT_TRUE(rig.draw({0.6, 0.0, 0.0}, {0.5, 0.0, 0.0}, 400).status & proxy_touching);
        limit_work(rig, work);
        for (int i = 1; i <= 100; ++i) {
            const Vec3 hand = 0.45 * Vec3(std::cos(0.02 * i), std::sin(0.02 * i), 0.0);
            const ProxyTick tick = rig.tick(hand);
            if (tick.status & proxy_unfinished) {
                ++unfinished;
                continue;
            }
            ++finished;
            const Vec3 settled(reference.settle(tick.position, hand).position);
            EXPECT_LE(glm::distance(settled, tick.position), 1e-6 * radius)
                << "work " << work << ", tick " << i;
        }
    }
    EXPECT_GT(finished, 500);
    EXPECT_GT(unfinished, 500);
}

// More triangles touch the proxy than any list of contacts holds.
TEST(ProxyBudget, AHeapOfTinyTrianglesLetsItGo) {
    constexpr double radius = 0.05;
    RandomValues random(9);
    TriangleMesh mesh;
    for (int i = 0; i < 5'000; ++i) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        const Vec3 at = random.in_ball(0.3 * radius);
        for (int k = 0; k < 3; ++k) {
            mesh.vertices.push_back(at + random.between(0.01, 0.05) * radius * random.direction());
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    const shared::JudgeTree judge(mesh);
    TouchRig rig(radius);
    rig.add(mesh);
    Watch watch;
    Vec3 hand(2.0 * radius, 0.0, 0.0);
    rig.tick(hand);
    for (int i = 0; i < 3'000; ++i) {
        // Through the heap and out of it again, on all sides.
        const Vec3 goal = (i / 100) % 2 ? 2.0 * radius * random.direction() : Vec3(0.0);
        hand += 0.02 * (goal - hand);
        const ProxyTick tick = rig.tick(hand);
        watch.look(tick, hand, radius);
        ASSERT_GE(judge.nearest(tick.position, 2.0 * radius).distance, radius) << "tick " << i;
    }
    const Vec3 away(0.0, 3.0 * radius, 0.0);
    EXPECT_LT(glm::distance(rig.draw(hand, away, 200).position, away), 1e-9);
    EXPECT_GT(watch.touching, 1'000);
    EXPECT_EQ(watch.frozen, 0);
}

// Every tick leads over some forty facets, each of which is in the way.
TEST(ProxyBudget, AHollowOfManyFacetsTakesFewSteps) {
    constexpr double radius = 0.05;
    constexpr double wide = 0.1;
    TouchRig rig(radius);
    rig.add(shared::bore(5'000, wide, 0.2));
    rig.draw(Vec3(0.0), {0.08, 0.0, 0.0}, 20);
    int steps = 0;
    for (int i = 1; i <= 100; ++i) {
        const double angle = 0.05 * i;
        const ProxyTick tick = rig.tick({0.08 * std::cos(angle), 0.0, 0.08 * std::sin(angle)});
        ASSERT_EQ(tick.status & (proxy_unfinished | proxy_touching), proxy_touching) << "tick " << i;
        const Vec3 right = (wide - radius) * Vec3(std::cos(angle), 0.0, std::sin(angle));
        ASSERT_LT(glm::distance(tick.position, right), 5e-5) << "tick " << i;
        steps = std::max(steps, tick.steps);
    }
    EXPECT_LE(steps, 16);
}

// A flat strip of slivers side by side across the x axis, as tools cut the end faces of turned parts.
TriangleMesh strip(int count, double width, double half_length) {
    TriangleMesh mesh;
    for (int i = 0; i <= count; ++i) {
        for (const double z : {-half_length, half_length}) {
            mesh.vertices.push_back({width * (i - 0.5 * count), 0.0, z});
        }
    }
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(2 * count); i += 2) {
        mesh.triangles.push_back({i, i + 1, i + 2});
        mesh.triangles.push_back({i + 2, i + 1, i + 3});
    }
    return mesh;
}

// A hundred slivers are as near as the one below the sphere. Those ahead seem to stand in the way until they
// are known to lie in its plane: all at once, not each against each other.
TEST(ProxyBudget, OverAFlatFaceOfSliversItGlides) {
    constexpr double radius = 0.05;
    TouchRig rig(radius);
    rig.add(strip(10'000, 4e-6, 0.2));
    rig.draw({-0.01, 0.06, 0.0}, {-0.01, 0.03, 0.0}, 20);
    limit_work(rig, 10'000);
    for (int i = 1; i <= 20; ++i) {
        const Vec3 hand(-0.01 + 1e-3 * i, 0.03, 0.0);
        const ProxyTick tick = rig.tick(hand);
        ASSERT_EQ(tick.status & (proxy_unfinished | proxy_touching), proxy_touching) << "tick " << i;
        ASSERT_NEAR(tick.position.x, hand.x, 1e-9) << "tick " << i;
        ASSERT_NEAR(tick.position.y, radius, 1e-8) << "tick " << i;
    }
}

// A ball too wide for a hole touches all of its rim: which edges stand for which is told mostly by tangents.
TEST(ProxyBudget, OnARimOfManyEdgesToTellThemApartIsCheap) {
    constexpr double wide = 0.1, height = 0.2, radius = 0.12;
    const PlacedShape placed{
        MeshShape{std::make_shared<const TriangleMesh>(shared::bore(1'000, wide, height))}, {}};
    const TouchShapeResult made = make_touch_shape({&placed, 1});
    TouchScene scene(1, 1);
    scene.add(*made.shape, {}, {}, 1);
    WorkBudget work(1'000'000);
    const ContactLook look(scene, {0.0, height + std::sqrt(radius * radius - wide * wide), 0.0}, radius, 1e-9,
                           work);
    const TriangleTree& tree = *made.shape->parts.front().tree();
    ContactList contacts;
    for (std::uint32_t slot = 0; slot < tree.pack_count() * lane_count && !contacts.is_full(); ++slot) {
        const Contact contact = look.exact_contact({0, slot});
        if (std::abs(contact.gap) < 1e-6) {
            contacts.add({contact.normal, contact.gap, contact.feature});
        }
    }
    ASSERT_TRUE(contacts.is_full());
    const std::int64_t before = work.left();
    int counting = 0;
    for (int i = 0; i < contacts.count; ++i) {
        look.look_closely(contacts, i, 0.01);
        counting += contacts[i].state != ContactState::covered;
    }
    EXPECT_LE(before - work.left(), 40 * contacts.count);
    EXPECT_GE(counting, contacts.count / 4);  // an edge, its ends, and the triangles that share them
    EXPECT_LT(counting, contacts.count);
}

// Among hundreds of balls within reach, with a twentieth of the usual work, by a hand that jumps. A way that
// nothing holds back leads to the hand, and the proxy is put there to the bit: it has to have gone all of it.
TEST(ProxyBudget, WithLittleWorkAmongAHeapOfBallsItEntersNone) {
    constexpr double radius = 0.12;
    RandomValues random(73);
    TriangleMesh mesh;
    for (int i = 0; i < 500; ++i) {
        const double size = random.magnitude(0.001, 0.16);
        TriangleMesh ball = shared::icosphere(random.below(4), size);
        const Vec3 place = random.in_box(0.4);
        for (Vec3& v : ball.vertices) {
            v += place;
        }
        shared::append(mesh, ball);
    }
    const shared::JudgeTree judge(mesh);
    TouchRig rig(radius);
    rig.add(mesh);
    limit_work(rig, 1'000);
    Vec3 hand(1.0);
    for (int i = 0; i < 800; ++i) {
        if (i % 20 == 19) {
            const int corner = random.below(static_cast<int>(mesh.vertices.size()));
            hand = mesh.vertices[static_cast<std::size_t>(corner)] + random.in_ball(radius);
        }
        const ProxyTick tick = rig.tick(hand + random.in_ball(0.02 * radius));
        if ((tick.status & proxy_absent) == 0) {
            ASSERT_GE(judge.nearest(tick.position, 2.0 * radius).distance, radius) << "tick " << i;
        }
    }
}

// A proxy appears where up to a thousandth of its radius is missing, and is lifted off in the same tick: or,
// where the work does not suffice for that, in a later one.
TEST(ProxyBudget, ItAppearsOnlyWhereItIsNotTooDeep) {
    constexpr double radius = 0.05;
    const TriangleMesh mesh = shared::terrain(60, 1.0, 0.0);
    const shared::JudgeTree judge(mesh);
    int begun = 0;
    for (std::int64_t work = 20; work < 2'000; work += 20) {
        TouchRig rig(radius);
        rig.add(mesh);
        limit_work(rig, work);
        for (int i = 0; i < 8; ++i) {
            const ProxyTick tick = rig.tick({0.01, radius * (0.9993 + 1e-4 * i), 0.01});
            if (tick.status & proxy_absent) {
                continue;
            }
            ++begun;
            ASSERT_GE(judge.nearest(tick.position, 1.0).distance, radius)
                << "work " << work << ", tick " << i;
        }
    }
    EXPECT_GT(begun, 100);
}

}  // namespace
}  // namespace tactus::proxy_budget_test
