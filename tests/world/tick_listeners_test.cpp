// Who hears a proxy's ticks: of which proxy, into which ring, and until when.
#include "world/tick_listeners.hpp"

#include <gtest/gtest.h>

#include "world/hand_twins.hpp"

namespace tactus::tick_listeners_test {
namespace {

struct Scene {
    Scene() {
        Workspace workspace;
        const SessionHandle device = session.add_device(port, workspace).handle;
        for (SessionHandle& proxy : proxies) {
            ProxyDescription description;
            description.device = device;
            proxy = session.add_proxy(description).handle;
        }
    }
    void tick(int count) {
        for (int i = 0; i < count; ++i) {
            session.collect();
            session.tick(static_cast<Nanoseconds>(ticks++) * 1'000'000);
        }
        session.collect();
    }
    static SessionSettings settings() {
        SessionSettings settings;
        settings.max_bodies = 4;
        return settings;
    }

    StandInDevice port;
    Session session{settings()};
    SessionHandle proxies[2] = {no_handle, no_handle};
    TickListeners listeners;
    int ticks = 0;
};

// Of which proxies the ticks in a ring are, as many as there are.
std::vector<SessionHandle> heard(TickRing& ring) {
    std::vector<SessionHandle> proxies;
    ring.drain([&](const SessionRecord& record) { proxies.push_back(record.proxy); });
    return proxies;
}

TEST(TickListeners, HearEveryTickOfTheirProxy) {
    Scene scene;
    const auto ring = std::make_shared<TickRing>(64);
    EXPECT_TRUE(scene.listeners.listen(scene.session, 1, ring, scene.proxies[0], no_handle));
    scene.tick(10);
    EXPECT_EQ(heard(*ring), std::vector<SessionHandle>(10, scene.proxies[0]));
}

TEST(TickListeners, HearAnotherProxyWhenTheyAskForIt) {
    Scene scene;
    const auto ring = std::make_shared<TickRing>(64);
    scene.listeners.listen(scene.session, 1, ring, scene.proxies[0], no_handle);
    scene.tick(3);
    EXPECT_TRUE(scene.listeners.listen(scene.session, 1, ring, scene.proxies[1], no_handle));
    heard(*ring);
    scene.tick(3);
    EXPECT_EQ(heard(*ring), std::vector<SessionHandle>(3, scene.proxies[1]));
}

TEST(TickListeners, HearNothingOnceTheyHaveLeft) {
    Scene scene;
    auto ring = std::make_shared<TickRing>(64);
    scene.listeners.listen(scene.session, 1, ring, scene.proxies[0], no_handle);
    scene.tick(3);
    scene.listeners.end(scene.session, 1);
    scene.listeners.end(scene.session, 2);
    EXPECT_EQ(ring.use_count(), 2) << "the loop may still be writing into it";
    scene.tick(1);
    heard(*ring);
    scene.tick(5);
    EXPECT_TRUE(heard(*ring).empty());
    scene.listeners.forget_retired();
    EXPECT_EQ(ring.use_count(), 1);
}

TEST(TickListeners, ComeBackWithTheSameRingOrAnother) {
    Scene scene;
    const auto first = std::make_shared<TickRing>(64), second = std::make_shared<TickRing>(64);
    scene.listeners.listen(scene.session, 1, first, scene.proxies[0], no_handle);
    scene.listeners.end(scene.session, 1);
    EXPECT_TRUE(scene.listeners.listen(scene.session, 1, first, scene.proxies[0], no_handle));
    scene.tick(2);
    EXPECT_EQ(heard(*first).size(), 2u);
    EXPECT_TRUE(scene.listeners.listen(scene.session, 1, second, scene.proxies[0], no_handle));
    scene.tick(2);
    EXPECT_EQ(heard(*second).size(), 2u);
    EXPECT_TRUE(heard(*first).empty());
}

TEST(TickListeners, AreNoMoreThanThereIsRoomFor) {
    Scene scene;
    std::vector<std::shared_ptr<TickRing>> rings;
    for (std::uint64_t who = 1; who <= max_recordings; ++who) {
        rings.push_back(std::make_shared<TickRing>(8));
        EXPECT_TRUE(scene.listeners.listen(scene.session, who, rings.back(), scene.proxies[0], no_handle));
    }
    const auto late = std::make_shared<TickRing>(8);
    EXPECT_FALSE(scene.listeners.listen(scene.session, 99, late, scene.proxies[0], no_handle));
    scene.listeners.end(scene.session, 1);
    EXPECT_TRUE(scene.listeners.listen(scene.session, 99, late, scene.proxies[0], no_handle));
}

}  // namespace
}  // namespace tactus::tick_listeners_test
