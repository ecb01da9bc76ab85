// What a hand's touch begins: one impact for each contact, with the speed and the impulse of its start.
#include "session/touch_events.hpp"

#include <glm/geometric.hpp>

#include "core/tool/tool_shape.hpp"
#include "session_rig.hpp"
#include "shared/meshes.hpp"

namespace tactus::touch_events_test {
namespace {

using namespace session_test;

TEST(TouchEvents, AnImpactHasTheSpeedOfItsStartAndTheImpulseOfItsFirstTenMilliseconds) {
    SessionRig rig;
    const SessionHandle floor = rig.add(ground());
    rig.device.position = {0.0, 0.05, 0.0};
    rig.ticks(5);
    EXPECT_EQ(rig.newest().touch_events[rig.proxy].count, 0u);
    rig.draw({0.0, 0.0, 0.0}, 250);  // 0.2 m/s; the sphere's radius is 10 mm
    rig.ticks(50);
    const TouchEvents& events = rig.newest().touch_events[rig.proxy];
    ASSERT_EQ(events.count, 1u);
    EXPECT_EQ(events.ring[0].body, floor);
    EXPECT_NEAR(events.ring[0].speed, 0.2, 1e-9);
    // The sum of K v t over the first ten ticks of touch.
    EXPECT_NEAR(events.ring[0].impulse, 500.0 * 0.2 * 1e-6 * 55.0, 500.0 * 0.2 * 1e-6 * 10.0);
}

TEST(TouchEvents, AContactThatEndsEarlierIsToldAtItsEnd) {
    SessionRig rig;
    rig.add(ground());
    rig.device.position = {0.0, 0.05, 0.0};
    rig.ticks(5);
    for (int i = 0; i < 3; ++i) {
        rig.device.position.y = 0.008;
        rig.ticks(4);
        rig.device.position.y = 0.05;
        rig.ticks(4);
    }
    const TouchEvents& events = rig.newest().touch_events[rig.proxy];
    ASSERT_EQ(events.count, 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(events.ring[i].impulse, 4.0 * 1e-3 * 500.0 * 0.002, 1e-9);
    }
}

TEST(TouchEvents, OfManyTheLastAreKept) {
    ImpactWatch watch;
    TouchEvents events;
    for (std::uint32_t body = 0; body < 20; ++body) {
        const ImpactContact contact{body, 0.1, 1.0};
        watch.tick({&contact, 1}, 1e-3, events);
        watch.tick({}, 1e-3, events);
    }
    ASSERT_EQ(events.count, 20u);
    EXPECT_EQ(events.ring[19 % TouchEvents::most].body, 19u);
}

// Bodies beyond its room are not told; no count goes wrong.
TEST(TouchEvents, MoreBodiesAtOnceThanThereIsRoomForAreLeftOut) {
    ImpactWatch watch;
    TouchEvents events;
    std::array<ImpactContact, ImpactWatch::most + 3> contacts;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        contacts[i] = {static_cast<std::uint32_t>(i), 0.1, 1.0};
    }
    watch.tick(contacts, 1e-3, events);
    watch.tick({}, 1e-3, events);
    EXPECT_EQ(events.count, ImpactWatch::most);
}

TEST(TouchEvents, AToolHasThemAsWell) {
    SessionRig rig;
    const ToolShapeResult bar = make_tool_shape(shared::box({0.1, 0.01, 0.01}), {1e-3, 500});
    rig.session.remove_proxy(rig.proxy);
    ToolUse use;
    use.device = rig.hand;
    rig.device.position = {0.0, 0.1, 0.0};
    const SessionHandle tool = rig.session.add_tool(bar.shape, use).handle;
    const SessionHandle floor = rig.add(ground());
    rig.ticks(5);
    rig.draw({0.0, 0.005, 0.0}, 475);  // 0.2 m/s
    rig.ticks(30);
    const TouchEvents& events = rig.newest().touch_events[hand_of_tool(tool)];
    ASSERT_EQ(events.count, 1u);
    EXPECT_EQ(events.ring[0].body, floor);
    EXPECT_NEAR(events.ring[0].speed, 0.2, 0.01);
    EXPECT_GT(events.ring[0].impulse, 0.0);
}

TEST(TouchEvents, EachContactHasItsForceAndTheyAddUp) {
    SessionRig rig;
    rig.add(ground());
    BodyAddition wall = body(BoxShape{{0.1, 0.1, 0.1}}, {0.15, 0.1, 0.0}, Motion::Static);
    rig.add(wall);
    rig.device.position = {0.0, 0.05, 0.0};
    rig.ticks(5);
    rig.draw({0.045, 0.004, 0.0}, 200);
    rig.ticks(50);
    const ProxyState& state = rig.proxy_state();
    ASSERT_EQ(state.contact_count, 2);
    EXPECT_LT(glm::distance(state.forces[0] + state.forces[1], state.force), 1e-9);
    for (int i = 0; i < 2; ++i) {
        const auto k = static_cast<std::size_t>(i);
        EXPECT_NEAR(glm::length(state.forces[k]), glm::dot(state.forces[k], state.normals[k]), 1e-6);
    }
}

TEST(TouchEvents, WhatIsAskedOfADeviceIsKnownBesideWhatItIsGiven) {
    SessionRig rig;
    rig.device.can.max_force = 8.0;
    rig.add(ground());
    rig.device.position = {0.0, 0.05, 0.0};
    rig.ticks(5);
    rig.draw({0.0, -0.03, 0.0}, 500);
    rig.ticks(50);
    const DeviceState& state = rig.newest().devices[0];
    EXPECT_NEAR(state.asked.y, 500.0 * 0.04, 1e-6);
    EXPECT_NEAR(state.force.y, 8.0, 1e-9);
    EXPECT_EQ(state.capabilities.max_force, 8.0);
}

}  // namespace
}  // namespace tactus::touch_events_test
