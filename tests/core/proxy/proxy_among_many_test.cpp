// Thousands of bodies, each with a shape of its own: what is far takes no time, what is near takes no more
// than there is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>

#include "core/proxy/proxy.hpp"
#include "shared/many_bodies.hpp"

namespace tactus::proxy_among_many_test {
namespace {

using shared::ManyBodies;

constexpr std::int64_t overrun = 100;  // what a question may spend too much: its last look

// To look at each of them takes longer than a question may.
TEST(ProxyAmongMany, AmongAThousandThatMoveItAppearsAndTouches) {
    constexpr double radius = 0.005;
    ManyBodies boxes = shared::boxes_apart(1'000);
    Proxy proxy(boxes.places.size(), {.radius = radius});
    const Vec3 hand(0.0, 0.081, 0.0);
    ProxyTick last;
    for (int i = 0; i < 10; ++i) {
        boxes.tick(1e-6);
        last = proxy.move(boxes.scene, hand);
    }
    EXPECT_EQ(last.status, 0u);
    boxes.tick();
    EXPECT_EQ(proxy.move(boxes.scene, hand - Vec3(0.0, 0.004, 0.0)).status, proxy_touching);
}

TEST(ProxyAmongMany, NobodyLooksAtAFarOneBecauseItMoves) {
    constexpr double radius = 0.005;
    ManyBodies boxes = shared::boxes_apart(3'000);
    BroadPhase broad_phase(boxes.places.size());
    const Vec3 center(0.0, 0.081, 0.0);
    for (int i = 0; i < 200; ++i) {
        boxes.tick(1e-5);
        broad_phase.begin_tick(boxes.scene, center, radius, 0xffff'ffffu);
        WorkBudget work(100'000);
        broad_phase.bring_near(radius, center, work);
        EXPECT_LE(broad_phase.near().size(), 4u) << i;
        EXPECT_GE(work.left(), i == 0 ? 50'000 : 99'000) << i;
    }
}

TEST(ProxyAmongMany, NoQuestionTakesMoreThanThereIs) {
    constexpr double radius = 0.05;
    constexpr std::int64_t units = 2'000;
    ManyBodies balls = shared::heap_of_balls(4'000, radius);
    for (const bool moves : {false, true}) {
        Surroundings surroundings(balls.places.size());
        ContactList contacts;
        FeatureId stopped_by;
        const auto ask = [&](const Vec3& center, auto&& question) {
            balls.tick(moves ? 1e-3 * radius : 0.0);
            surroundings.begin_tick(balls.scene, center, radius, 0xffff'ffffu, WorkBudget(units));
            question();
            EXPECT_GE(surroundings.work().left(), -overrun);
        };
        for (const Vec3& center : {Vec3(2.4 * radius, 0.0, 0.0), Vec3(1.5 * radius), Vec3(0.0)}) {
            ask(center, [&] { surroundings.has_room(center, radius); });
            ask(center, [&] { surroundings.find_contacts(center, contacts); });
            ask(center, [&] { surroundings.find_nearest_contacts(center, 0.01 * radius, contacts); });
            ask(center, [&] { surroundings.sweep(center, -0.1 * center, stopped_by); });
            ask(center, [&] {
                Surroundings::Push push;
                for (std::size_t from = 0; surroundings.next_push(from, center, -1, push);) {
                }
            });
        }
    }
}

// What has been looked at stays known: in the end all is, and the sphere is where it may be.
TEST(ProxyAmongMany, InAHeapOfThousandsItEntersNoneAndComesToRest) {
    constexpr double radius = 0.05;
    ManyBodies balls = shared::heap_of_balls(4'000, radius);
    Proxy proxy(balls.places.size(), {.radius = radius});
    const Vec3 hand(0.3 * radius, 0.1 * radius, 0.0);
    ProxyTick last;
    for (int i = 0; i < 300; ++i) {
        const double out = std::max(0.0, 1.0 - 0.005 * i);
        balls.tick();
        last = proxy.move(balls.scene, hand + Vec3(4.0 * radius * out, 0.0, 0.0));
        for (const Vec3& place : balls.places) {
            ASSERT_GE(glm::distance(place, last.position), 1.2 * radius) << i;
        }
    }
    EXPECT_EQ(last.status, proxy_touching);
}

}  // namespace
}  // namespace tactus::proxy_among_many_test
