#include "session/session.hpp"

#include <cmath>
#include <deque>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "session_rig.hpp"

namespace tactus::session_test {
namespace {

using namespace session_test;

TEST(Session, HandlesComeBackOnlyAfterTheLoopHasLetGo) {
    SessionRig rig;
    const SessionHandle first = rig.add(ground());
    rig.tick();
    rig.session.remove_body(first);
    const SessionHandle second = rig.add(ground());
    EXPECT_NE(second, first);  // the loop has not let go yet
    rig.tick();
    rig.session.collect();
    EXPECT_EQ(rig.add(ground()), first);
}

TEST(Session, AFullWorldSaysSo) {
    SessionSettings settings;
    settings.max_bodies = 2;
    Session session(settings);
    EXPECT_EQ(session.add_body(ground()).error, "");
    EXPECT_EQ(session.add_body(ground()).error, "");
    EXPECT_NE(session.add_body(ground()).error.find("2 bodies"), std::string::npos);
}

TEST(Session, PartsThatFindNoPlaceAreReportedAndGivenBack) {
    SessionSettings settings;
    settings.max_bodies = 8;
    settings.max_parts = 1;
    Session session(settings);
    const SessionHandle first = session.add_body(ground()).handle;
    const SessionHandle second = session.add_body(ground()).handle;
    EXPECT_TRUE(session.tick(period) & session_full);
    session.collect();
    EXPECT_EQ(session.tick(2 * period) & session_full, 0u);
    EXPECT_EQ(session.add_body(ground()).handle, second);  // given back
    EXPECT_NE(first, second);
}

TEST(Session, RefusesBadMaterialsAndProxies) {
    Session session({});
    BodyAddition bad = ground();
    bad.touch_material.stiffness = -1.0;
    EXPECT_NE(session.add_body(bad).error, "");
    bad.touch_material.stiffness = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(session.add_body(bad).error, "");
    for (const double radius : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        ProxyDescription description;
        description.settings.radius = radius;
        EXPECT_NE(session.add_proxy(description).error.find("radius"), std::string::npos);
    }
}

TEST(Session, MoreCommandsThanATickTakesWaitForTheNext) {
    SessionSettings settings;
    settings.commands_per_tick = 4;
    SessionRig rig(settings);
    for (int i = 0; i < 10; ++i) {
        rig.add(body(SphereShape{0.1}, {1.0 + i, 0.0, 0.0}, Motion::Kinematic));
    }
    EXPECT_TRUE(rig.tick() & session_commands_waiting);
    EXPECT_EQ(rig.newest().body_count, 2u);  // device, proxy, two bodies
    rig.ticks(3);
    EXPECT_EQ(rig.newest().body_count, 10u);
}

TEST(Session, DynamicBodiesThatComeAreSpreadOverMoreTicks) {
    SessionSettings settings;
    settings.commands_per_tick = 8;
    SessionRig rig(settings);
    rig.tick();
    for (int i = 0; i < 5; ++i) {
        rig.add(body(SphereShape{0.1}, {1.0 + i, 1.0, 0.0}, Motion::Dynamic));
    }
    EXPECT_TRUE(rig.tick() & session_commands_waiting);
    EXPECT_EQ(rig.newest().body_count, 2u);
    rig.tick();
    EXPECT_EQ(rig.newest().body_count, 4u);
    EXPECT_FALSE(rig.tick() & session_commands_waiting);
    EXPECT_EQ(rig.newest().body_count, 5u);
}

TEST(Session, MoreCommandsThanTheRingHoldsAreKept) {
    SessionSettings settings;
    settings.commands_per_tick = 64;
    SessionRig rig(settings);
    for (int i = 0; i < 1'500; ++i) {
        rig.add(body(SphereShape{0.1}, {1.0 + i, 0.0, 0.0}, Motion::Kinematic));
    }
    EXPECT_GT(rig.session.backlog(), 0u);
    for (int i = 0; i < 60; ++i) {
        rig.tick();
        rig.session.collect();
    }
    EXPECT_EQ(rig.session.backlog(), 0u);
    EXPECT_EQ(rig.newest().body_count, 1'500u);
}

TEST(Session, RecordsEveryTickOldestFirstAndCountsWhatIsLost) {
    SessionRig rig;
    const SessionHandle box = rig.add(body(BoxShape{Vec3(0.1)}, {0.0, -0.2, 0.0}, Motion::Kinematic));
    RecorderRing<SessionRecord> ring(64);
    rig.session.record(ring, rig.proxy, box);
    rig.device.position = {0.3, 0.5, 0.1};
    rig.ticks(40);
    Nanoseconds expected = 0;
    std::size_t count = ring.drain([&](const SessionRecord& row) {
        EXPECT_EQ(row.time, expected += period);
        EXPECT_EQ(row.hand, rig.device.position);
        EXPECT_EQ(row.object_position, Vec3(0.0, -0.2, 0.0));
    });
    EXPECT_EQ(count, 40u);
    TickStatus status = 0;
    for (int i = 0; i < 200; ++i) {
        status |= rig.tick();
    }
    EXPECT_TRUE(status & session_record_lost);
    EXPECT_EQ(ring.take_lost(), 200u - ring.capacity());
    rig.session.end_recording(ring);
    rig.tick();
    ring.drain([](const SessionRecord&) {});
    rig.ticks(5);
    EXPECT_EQ(ring.drain([](const SessionRecord&) {}), 0u);
}

TEST(Session, ARecordHasWhatIsAskedForAndWhatIsDisplayed) {
    SessionRig rig;
    rig.add(ground());
    RecorderRing<SessionRecord> ring(1024);
    rig.session.record(ring, rig.proxy, no_handle);
    rig.device.position = {0.0, 0.05, 0.0};
    rig.ticks(10);
    Workspace workspace;
    workspace.force_limit = 2.0;
    rig.session.set_workspace(rig.hand, workspace);
    rig.device.position = {0.0, -0.01, 0.0};
    rig.ticks(500);
    SessionRecord last;
    ring.drain([&](const SessionRecord& row) { last = row; });
    EXPECT_NEAR(last.force.y, 10.0, 0.1);
    EXPECT_NEAR(last.displayed.y, 2.0, 1e-9);
    EXPECT_EQ(last.displayed, rig.device.force);
}

// In the scene's measure and directions, as the force that was asked for.
TEST(Session, ARecordHasWhatADriverDisplaysAndWhyItWasCut) {
    SessionRig rig;
    RecorderRing<SessionRecord> ring(64);
    rig.session.record(ring, rig.proxy, no_handle);
    Workspace workspace;
    workspace.pose.rotation = Quat(std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5));
    workspace.force_scale = 2.0;
    rig.session.set_workspace(rig.hand, workspace);
    rig.device.shown = DisplayedForce{{4.0, 0.0, 0.0}, 0};
    rig.tick();
    rig.device.shown = DisplayedForce{Vec3(0.0), 5};
    rig.tick();
    rig.device.shown.reset();
    rig.tick();
    std::vector<SessionRecord> rows;
    ring.drain([&](const SessionRecord& row) { rows.push_back(row); });
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_LT(glm::distance(rows[0].displayed, Vec3(0.0, 2.0, 0.0)), 1e-12);
    EXPECT_EQ(rows[0].cuts, 0u);
    EXPECT_EQ(rows[1].displayed, Vec3(0.0));
    EXPECT_EQ(rows[1].cuts, 5u);
    EXPECT_EQ(rows[2].cuts, 0u);
}

TEST(Session, ARecordOfAPointerWithoutADeviceHasNothingDisplayed) {
    Session session({});
    const SessionHandle proxy = session.add_proxy({}).handle;
    RecorderRing<SessionRecord> ring(64);
    session.record(ring, proxy, no_handle);
    session.tick(period);
    SessionRecord last;
    last.displayed = Vec3(1.0);
    EXPECT_EQ(ring.drain([&](const SessionRecord& row) { last = row; }), 1u);
    EXPECT_EQ(last.displayed, Vec3(0.0));
}

TEST(Session, SeveralRecordingsGoOnSideBySide) {
    SessionRig rig;
    std::deque<RecorderRing<SessionRecord>> rings;
    for (std::size_t i = 0; i < max_recordings; ++i) {
        EXPECT_TRUE(rig.session.record(rings.emplace_back(64), rig.proxy, no_handle));
    }
    RecorderRing<SessionRecord> too_many(64);
    EXPECT_FALSE(rig.session.record(too_many, rig.proxy, no_handle));
    EXPECT_TRUE(rig.session.record(rings.front(), rig.proxy, no_handle)) << "again is no other one";
    rig.ticks(5);
    rig.session.end_recording(rings[2]);
    rig.ticks(5);
    const auto rows = [](RecorderRing<SessionRecord>& ring) {
        return ring.drain([](const SessionRecord&) {});
    };
    for (std::size_t i = 0; i < max_recordings; ++i) {
        EXPECT_EQ(rows(rings[i]), i == 2 ? 5u : 10u) << i;
    }
    EXPECT_TRUE(rig.session.record(too_many, rig.proxy, no_handle)) << "there is room again";
    rig.ticks(3);
    EXPECT_EQ(rows(too_many), 3u);
    EXPECT_EQ(rows(rings[2]), 0u);
}

TEST(Session, SettledBodiesAreThereAtTheFirstTick) {
    SessionRig rig;
    for (int i = 0; i < 200; ++i) {
        rig.add(body(SphereShape{0.1}, {1.0 + i, 0.0, 0.0}, Motion::Kinematic));
    }
    rig.session.settle();
    rig.tick();
    EXPECT_EQ(rig.newest().body_count, 200u);
}

// What a proxy remembered of its surroundings while its device was elsewhere must not hold afterwards.
TEST(Session, AProxyGivenToAnotherDeviceTouchesWhatIsThere) {
    SessionRig rig;
    rig.add(body(BoxShape{Vec3(0.5)}, {0.0, -0.6, 0.0}, Motion::Static));
    rig.add(body(BoxShape{Vec3(0.5)}, {50.0, -0.6, 0.0}, Motion::Static));
    HeldDevice other;
    other.position = {50.0, 0.1, 0.0};
    const SessionHandle second = rig.session.add_device(other, {}).handle;
    rig.device.position = {0.0, 0.1, 0.0};
    rig.ticks(100);
    ProxyDescription description;
    description.device = second;
    description.settings.radius = 0.01;
    rig.session.set_proxy(rig.proxy, description);
    rig.ticks(2);
    other.position.y = -0.2;
    rig.ticks(2);
    EXPECT_NEAR(rig.proxy_state().position.y, -0.09, 1e-6);
}

TEST(Session, ADisabledProxyFindsBodiesWhereTheyWentMeanwhile) {
    SessionRig rig;
    const SessionHandle lift = rig.add(body(BoxShape{Vec3(0.5)}, {0.0, -20.0, 0.0}, Motion::Kinematic));
    rig.device.position = {0.0, 0.1, 0.0};
    rig.ticks(50);
    ProxyDescription description;
    description.device = rig.hand;
    description.settings.radius = 0.01;
    description.enabled = false;
    rig.session.set_proxy(rig.proxy, description);
    rig.session.move_body(lift, {{0.0, -0.5, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)}, 0.2);
    rig.ticks(250);
    description.enabled = true;
    rig.session.set_proxy(rig.proxy, description);
    rig.ticks(2);
    rig.draw({0.0, -0.1, 0.0}, 20);
    EXPECT_NEAR(rig.proxy_state().position.y, 0.01, 1e-6);
}

}  // namespace
}  // namespace tactus::session_test
