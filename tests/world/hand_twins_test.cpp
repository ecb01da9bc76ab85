// The twins of devices and proxies: what comes, changes and goes.
#include "world/hand_twins.hpp"

#include <gtest/gtest.h>

namespace tactus::hand_twins_test {
namespace {

SessionSettings settings() {
    SessionSettings settings;
    settings.max_bodies = 4;
    return settings;
}

TEST(DeviceTwin, HasNoneWithoutAPort) {
    Session session(settings());
    RetiredPorts retired;
    DeviceTwin twin;
    EXPECT_EQ(twin.synchronise(session, {}, nullptr, {}, retired), "");
    EXPECT_EQ(twin.handle(), no_handle);
    EXPECT_TRUE(retired.empty());
}

TEST(DeviceTwin, StaysWithItsPortAndIsAnotherOneWithAnother) {
    Session session(settings());
    RetiredPorts retired;
    DeviceTwin twin;
    const auto port = std::make_shared<StandInDevice>();
    EXPECT_EQ(twin.synchronise(session, {}, port, {}, retired), "");
    const SessionHandle first = twin.handle();
    EXPECT_NE(first, no_handle);
    Workspace larger;
    larger.scale = 2.0;
    twin.synchronise(session, {}, port, larger, retired);
    EXPECT_EQ(twin.handle(), first);
    twin.synchronise(session, {}, std::make_shared<StandInDevice>(), {}, retired);
    EXPECT_NE(twin.handle(), first);
    ASSERT_EQ(retired.size(), 1u) << "the loop may still read it";
    EXPECT_EQ(retired.front(), port);
}

TEST(DeviceTwin, RemovesItsDeviceAndKeepsThePort) {
    Session session(settings());
    RetiredPorts retired;
    DeviceTwin twin;
    twin.synchronise(session, {}, std::make_shared<StandInDevice>(), {}, retired);
    twin.remove(session, retired);
    twin.remove(session, retired);
    EXPECT_EQ(twin.handle(), no_handle);
    EXPECT_EQ(retired.size(), 1u);
}

TEST(DeviceTwin, SaysWhyThereIsNoPlaceForAnother) {
    Session session(settings());
    RetiredPorts retired;
    std::vector<DeviceTwin> twins(1000);
    std::string problem;
    for (DeviceTwin& twin : twins) {
        problem = twin.synchronise(session, {}, std::make_shared<StandInDevice>(), {}, retired);
        EXPECT_EQ(problem.empty(), twin.handle() != no_handle);
    }
    EXPECT_NE(problem, "");
}

TEST(ProxyTwin, ComesChangesAndGoes) {
    Session session(settings());
    RetiredPorts retired;
    DeviceTwin device;
    device.synchronise(session, {}, std::make_shared<StandInDevice>(), {}, retired);
    ProxyTwin twin;
    ProxyDescription description;
    description.device = device.handle();
    EXPECT_EQ(twin.synchronise(session, description), "");
    const SessionHandle handle = twin.handle();
    EXPECT_NE(handle, no_handle);
    session.settle();
    session.tick(0);
    session.refresh();
    EXPECT_EQ(session.snapshot().proxy_count, 1u);

    description.settings.radius = 0.5;
    twin.synchronise(session, description);
    EXPECT_EQ(twin.handle(), handle);

    twin.remove(session);
    session.settle();
    session.tick(1'000'000);
    session.refresh();
    EXPECT_EQ(session.snapshot().proxy_count, 0u);
}

}  // namespace
}  // namespace tactus::hand_twins_test
