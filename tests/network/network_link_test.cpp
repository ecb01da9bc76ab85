// Socket, emulated network and key together, as a scene opens them.
#include "network/network_link.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "network/endpoint.hpp"
#include "platform/clock.hpp"

namespace tactus::network_link_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;
constexpr Nanoseconds patience = 20 * nanoseconds_per_second;

NetworkSettings here(std::uint16_t local_port, std::uint16_t remote_port, const std::string& key = {}) {
    NetworkSettings settings;
    settings.udp.local_address = settings.udp.remote_address = "127.0.0.1";
    settings.udp.local_port = local_port;
    settings.udp.remote_port = remote_port;
    settings.key = key;
    return settings;
}

std::uint16_t free_port() {
    UdpLink probe;
    EXPECT_EQ(probe.open(here(0, 9).udp), "");
    return probe.local_port();
}

// Two sides in this process, ticked together until `done` or patience ends.
struct NetworkRig {
    NetworkRig(const std::string& near_key, const std::string& far_key,
               const LinkConditions& conditions = {}) {
        const std::uint16_t near_port = free_port(), far_port = free_port();
        NetworkSettings settings = here(near_port, far_port, near_key);
        settings.conditions = conditions;
        EXPECT_EQ(near_link.open(settings), "");
        settings = here(far_port, near_port, far_key);
        settings.conditions = conditions;
        EXPECT_EQ(far_link.open(settings), "");
    }

    template <typename Done>
    bool run_until(Done&& done) {
        for (const Nanoseconds end = monotonic_now() + patience; monotonic_now() < end;) {
            const Nanoseconds now = monotonic_now();
            for (Endpoint* side : {&near, &far}) {
                side->begin_tick(now);
                while (side->receive() != nullptr) {
                }
                side->end_tick();
            }
            if (done()) {
                return true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    }

    static EndpointSettings side(Side which, std::uint64_t epoch) {
        EndpointSettings settings;
        settings.side = which;
        settings.epoch = epoch;
        return settings;
    }

    NetworkLink near_link, far_link;
    Endpoint near{near_link, side(Side::operator_side, 1)};
    Endpoint far{far_link, side(Side::teleoperator_side, 2)};
};

TEST(NetworkLink, MeetsThroughSocketEmulationAndKey) {
    LinkConditions conditions;
    conditions.delay = 30 * ms;
    for (const char* key : {"", "a key both know"}) {
        NetworkRig rig(key, key, conditions);
        ASSERT_TRUE(rig.run_until([&] {
            return rig.near.connected() && rig.far.connected() && rig.near.statistics().clock.exchanges >= 3;
        })) << key;
        EXPECT_GE(rig.near.statistics().clock.least_delay, 60 * ms);
        EXPECT_TRUE(rig.run_until([&] { return rig.near_link.figures().emulator.delivered > 0; }));
        EXPECT_EQ(rig.near_link.figures().udp.sealed, *key != '\0');
        EXPECT_EQ(rig.near_link.figures().sealing() > 0, *key != '\0');
        EXPECT_EQ(28 + rig.near_link.figures().sealing(), rig.near_link.overhead()) << "of IPv4 and UDP";
        EXPECT_TRUE(rig.run_until([&] { return rig.near_link.figures().udp.met == (*key != '\0'); }));
    }
}

TEST(NetworkLink, AnotherKeyOrNoneIsCountedAndNobodyMeets) {
    NetworkRig other("a key both know", "a key one knows");
    ASSERT_TRUE(other.run_until([&] { return other.near_link.figures().udp.secure.wrong_key > 0; }));
    EXPECT_EQ(other.near.statistics().peer, PeerState::silent);
    EXPECT_FALSE(other.near_link.figures().udp.met);

    NetworkRig none("a key both know", "");
    ASSERT_TRUE(none.run_until([&] {
        return none.near_link.figures().udp.secure.not_sealed > 0 &&
               none.far.statistics().refused.of(Refusal::sealed) > 0;
    }));
    EXPECT_EQ(none.near.statistics().peer, PeerState::silent);
    EXPECT_EQ(none.far.statistics().peer, PeerState::silent);
}

TEST(NetworkLink, TheEmulatedNetworkMayChangeWhileItRuns) {
    NetworkRig rig("", "");
    ASSERT_TRUE(rig.run_until([&] { return rig.near.connected(); }));
    LinkConditions nothing;
    nothing.loss = 1.0;
    rig.near_link.change(nothing);
    EXPECT_TRUE(rig.run_until([&] { return rig.near.statistics().peer == PeerState::vanished; }));
    rig.near_link.change({});
    EXPECT_TRUE(rig.run_until([&] { return rig.near.connected(); }));
}

TEST(NetworkLink, SaysWhatIsWrong) {
    NetworkLink link;
    EXPECT_EQ(link.open(here(0, 9, "short")).find("the key is too short"), 0u);
    EXPECT_NE(link.open(here(0, 0)), "");
    std::array<std::byte, max_datagram_bytes> buffer{};
    EXPECT_FALSE(link.send(buffer, 0));
    EXPECT_FALSE(link.receive(buffer, 0));
    EXPECT_EQ(link.figures().udp.state, UdpState::closed);
}

}  // namespace
}  // namespace tactus::network_link_test
