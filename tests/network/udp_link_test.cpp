// Real sockets on this machine. Waits are bounded by what a crowded machine may take; nothing asserts how
// long anything took.
#include "network/udp_link.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <thread>
#include <utility>

#include "network/endpoint.hpp"
#include "network/link_emulator.hpp"
#include "platform/clock.hpp"
#include "platform/side_socket.hpp"
#include "support/emulation.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::udp_link_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;
constexpr Nanoseconds patience = 20 * nanoseconds_per_second;

// Windows's library rounds what is shorter down to nothing.
void nap() {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

// Until `done` says so, or patience ends.
template <typename Done>
bool eventually(Done&& done) {
    for (const Nanoseconds end = monotonic_now() + patience; monotonic_now() < end; nap()) {
        if (done()) {
            return true;
        }
    }
    return false;
}

UdpSettings to(std::uint16_t remote_port, std::uint16_t local_port = 0) {
    UdpSettings settings;
    settings.remote_address = "127.0.0.1";
    settings.remote_port = remote_port;
    settings.local_address = "127.0.0.1";
    settings.local_port = local_port;
    return settings;
}

UdpSettings with_secret(UdpSettings settings) {
    settings.secret = SharedSecret{SecretKey{1}, {}};
    return settings;
}

// A port that is free now.
std::uint16_t free_port() {
    UdpLink probe;
    EXPECT_EQ(probe.open(to(9)), "");
    return probe.local_port();
}

struct Pair {
    explicit Pair(bool sealed = false) {
        const auto settings = [sealed](const UdpSettings& plain) {
            return sealed ? with_secret(plain) : plain;
        };
        const std::uint16_t first_port = free_port();
        EXPECT_EQ(second.open(settings(to(first_port))), "");
        EXPECT_EQ(first.open(settings(to(second.local_port(), first_port))), "");
    }
    UdpLink first, second;
};

// Sends from that port of this machine, as a program that is no link may.
void send_from(std::uint16_t from, std::uint16_t to, const std::vector<std::vector<std::byte>>& datagrams) {
    SocketError error;
    const SocketHandle socket = open_udp(IpFamily::four, error);
    ASSERT_FALSE(bind_udp(socket, loopback(IpFamily::four, from)));
    ASSERT_FALSE(connect_udp(socket, loopback(IpFamily::four, to)));
    for (const std::vector<std::byte>& datagram : datagrams) {
        EXPECT_FALSE(send_udp(socket, datagram));
    }
    close_udp(socket);
}

std::vector<std::byte> bytes(std::size_t size, int fill) {
    return std::vector<std::byte>(size, static_cast<std::byte>(fill));
}

TEST(UdpLink, CarriesDatagramsBothWays) {
    Pair pair;
    std::array<std::byte, max_datagram_bytes> buffer;
    for (UdpLink* from : {&pair.first, &pair.second}) {
        UdpLink& other = from == &pair.first ? pair.second : pair.first;
        for (const std::size_t size : {std::size_t{1}, std::size_t{100}, max_datagram_bytes}) {
            const Nanoseconds before = monotonic_now();
            ASSERT_TRUE(from->send(bytes(size, 7), before));
            ReceivedDatagram received;
            ASSERT_TRUE(eventually([&] {
                received = other.receive(buffer, monotonic_now());
                return static_cast<bool>(received);
            }));
            EXPECT_EQ(received.bytes, size);
            EXPECT_EQ(buffer[size - 1], std::byte{7});
            EXPECT_GE(received.arrived, before);
            EXPECT_LE(received.arrived, monotonic_now());
        }
    }
    EXPECT_EQ(pair.first.figures().state, UdpState::open);
    EXPECT_EQ(pair.first.figures().sent, 3u);
    EXPECT_EQ(pair.first.figures().received, 3u);
}

TEST(UdpLink, RefusesTheEmptyAndTheTooLong) {
    Pair pair;
    EXPECT_FALSE(pair.first.send({}, 0));
    EXPECT_FALSE(pair.first.send(bytes(max_datagram_bytes + 1, 0), 0));
    EXPECT_EQ(pair.first.figures().no_room_to_send, 2u);
}

TEST(UdpLink, APortInUseIsSaidWithWhatToDo) {
    UdpLink first, second;
    ASSERT_EQ(first.open(to(9)), "");
    const std::string error = second.open(to(9, first.local_port()));
    EXPECT_EQ(error, "port " + std::to_string(first.local_port()) +
                         " is in use by another program: end that one or choose another port");
    EXPECT_EQ(second.figures().state, UdpState::closed);
    first.close();
    EXPECT_EQ(second.open(to(9, free_port())), "");
}

TEST(UdpLink, WrongAddressesAreSaidInWords) {
    UdpLink link;
    UdpSettings settings = to(9);
    settings.remote_address = "not an address";
    EXPECT_EQ(link.open(settings).find("the address \"not an address\" is not known"), 0u);
    settings.remote_address = "";
    EXPECT_NE(link.open(settings).find("no address"), std::string::npos);
    settings = to(0);
    EXPECT_NE(link.open(settings).find("no address"), std::string::npos);
}

TEST(UdpLink, AnAddressOfAnotherMachineIsSaidInWords) {
    if (testing::under_wine()) {
        GTEST_SKIP() << "Wine binds a socket to whatever address it is told";
    }
    UdpLink link;
    UdpSettings settings = with_secret(to(9));
    settings.local_address = "192.0.2.1";  // a number kept for documents
    EXPECT_NE(link.open(settings).find("not one of this machine"), std::string::npos);
}

TEST(UdpLink, WithoutAKeyItStaysOnThisMachineAndSaysSo) {
    UdpLink link;
    UdpSettings settings = to(9);
    settings.local_address.clear();
    ASSERT_EQ(link.open(settings), "");
    UdpSockets alone = open_udp_sockets({}, {"127.0.0.1", 9}, true);
    ASSERT_EQ(alone.sockets.size(), 1u) << alone.error;
    EXPECT_EQ(own_address(alone.sockets[0].handle), loopback(IpFamily::four, alone.local_port));
    close_udp(alone.sockets[0].handle);
    settings.remote_address = "192.0.2.1";
    EXPECT_EQ(link.open(settings).find("without a key this side talks within this machine only"), 0u);
}

TEST(UdpLink, ItsOwnAddressIsNamedAsTheMistakeThatItIs) {
    const std::uint16_t port = free_port();
    for (const char* host : {"127.0.0.1", "localhost"}) {
        UdpLink link;
        UdpSettings settings = to(port, port);
        settings.local_address.clear();
        settings.remote_address = host;
        EXPECT_NE(link.open(settings).find("is this side's own address"), std::string::npos) << host;
    }
}

TEST(UdpLink, AnAddressInBracketsIsUnderstood) {
    UdpLink link;
    UdpSettings settings;
    settings.remote_address = "[::1]";
    settings.remote_port = 9;
    const std::string error = link.open(settings);
    if (!error.empty() && error.find("is not known") == std::string::npos) {
        GTEST_SKIP() << "this machine has no IPv6: " << error;
    }
    EXPECT_EQ(error, "");
}

// A name that stands for ::1 and for 127.0.0.1, where only one of them listens.
TEST(UdpLink, AllAddressesOfANameAreTried) {
    const std::uint16_t port = free_port();
    UdpLink first, second;
    UdpSettings settings = to(port);
    settings.local_address.clear();
    settings.remote_address = "localhost";
    ASSERT_EQ(first.open(settings), "");
    ASSERT_EQ(second.open(to(first.local_port(), port)), "");
    std::array<std::byte, max_datagram_bytes> buffer{};
    EXPECT_TRUE(eventually([&] {
        first.send(bytes(4, 2), 0);
        return static_cast<bool>(second.receive(buffer, 0));
    }));
    EXPECT_TRUE(eventually([&] {
        second.send(bytes(4, 2), 0);
        return static_cast<bool>(first.receive(buffer, 0));
    }));
}

bool has_ip6() {
    UdpLink link;
    UdpSettings settings;
    settings.local_address = settings.remote_address = "::1";
    settings.remote_port = 9;
    return link.open(settings).empty();
}

// One machine, one side set to ::1 and the other to 127.0.0.1.
TEST(UdpLink, TheLoopbacksOfBothFamiliesMeet) {
    if (!has_ip6()) {
        GTEST_SKIP() << "this machine has no IPv6";
    }
    for (const bool six_opens_first : {true, false}) {
        const std::uint16_t port = free_port();
        UdpLink six, four;
        UdpSettings settings = to(port);
        settings.local_address.clear();
        settings.remote_address = "::1";
        if (six_opens_first) {
            ASSERT_EQ(six.open(settings), "");
            ASSERT_EQ(four.open(to(six.local_port(), port)), "");
        } else {
            settings.local_port = free_port();
            ASSERT_EQ(four.open(to(settings.local_port, port)), "");
            ASSERT_EQ(six.open(settings), "");
        }
        std::array<std::byte, max_datagram_bytes> buffer{};
        EXPECT_TRUE(eventually([&] {
            six.send(bytes(4, 2), 0);
            return static_cast<bool>(four.receive(buffer, 0));
        }));
        EXPECT_TRUE(eventually([&] {
            four.send(bytes(4, 2), 0);
            return static_cast<bool>(six.receive(buffer, 0));
        }));
    }
}

TEST(UdpLink, AddressesOfTwoKindsAreNamedAsTheMistakeThatTheyAre) {
    UdpLink link;
    UdpSettings settings;
    settings.remote_port = 9;
    for (const auto& [local, remote] : {std::pair{"::1", "127.0.0.1"}, std::pair{"127.0.0.1", "fe80::1"}}) {
        settings.local_address = local;
        settings.remote_address = remote;
        const std::string error = link.open(with_secret(settings));
        EXPECT_NE(error.find("or give both of one kind"), std::string::npos) << error;
    }
}

// A local address that is none is still named as that.
TEST(UdpLink, ALocalAddressThatIsNoneIsNotOneOfAnotherKind) {
    UdpLink link;
    UdpSettings settings;
    settings.remote_port = 9;
    settings.remote_address = "127.0.0.1";
    settings.local_address = "fe80::zz";
    EXPECT_NE(link.open(settings).find("is not known"), std::string::npos);
}

// So many at a stretch that they are too fast on average where a nap takes a clock's whole period, too.
TEST(UdpLink, WhatComesTooFastIsDropped) {
    Pair pair;
    const std::vector<std::byte> datagram = bytes(10, 1);
    EXPECT_TRUE(eventually([&] {
        for (int i = 0; i < 5000; ++i) {
            pair.second.send(datagram, 0);
        }
        return pair.first.figures().too_many > 0;
    }));
}

// Thrown from the far side's own address, as who forges it would.
TEST(UdpLink, WhatIsNotSealedForTheSessionIsNotEvenSeen) {
    SocketError error;
    const SocketHandle probe = open_udp(IpFamily::four, error);
    const bool filters = attach_filter(probe, {});
    close_udp(probe);
    if (!filters) {
        GTEST_SKIP() << "this system filters no sockets";
    }
    if (testing::under_qemu()) {
        GTEST_SKIP() << "QEMU does not hand on how much the system has dropped";
    }
    Pair pair(true);
    ASSERT_TRUE(eventually([&] {
        pair.first.send(bytes(3, 1), 0);
        pair.second.send(bytes(3, 1), 0);
        return pair.first.figures().met && pair.second.figures().met;
    }));
    const std::uint16_t second_port = pair.second.local_port();
    pair.second.close();
    std::vector<std::byte> packet = bytes(100, 9);
    std::memcpy(packet.data(), "TS\2\1", 4);
    const std::uint64_t unseen = pair.first.figures().dropped_by_system;
    const std::uint64_t seen = pair.first.figures().secure.other_start;
    send_from(second_port, pair.first.local_port(), std::vector(1000, packet));
    EXPECT_TRUE(eventually([&] { return pair.first.figures().dropped_by_system >= unseen + 1000; }));
    EXPECT_EQ(pair.first.figures().secure.other_start, seen);
}

bool a_socket_may_sit_beside_another() {
    SocketError error;
    const SocketHandle socket = open_udp(IpFamily::four, error);
    EXPECT_FALSE(bind_udp(socket, loopback(IpFamily::four, 0)));
    const SocketHandle beside = open_beside(socket, IpFamily::four);
    close_udp(socket);
    if (beside != no_socket) {
        close_udp(beside);
    }
    return beside != no_socket;
}

// One more operator at a port that is for another one: it is told, and the two go on talking.
TEST(UdpLink, WhoIsNotExpectedIsToldWhy) {
    if (!a_socket_may_sit_beside_another()) {
        GTEST_SKIP() << "this system lets no socket hear what another one's port is not for";
    }
    for (const bool sealed : {false, true}) {
        Pair pair(sealed);
        UdpLink third;
        UdpSettings settings = to(pair.first.local_port());
        ASSERT_EQ(third.open(sealed ? with_secret(settings) : settings), "");
        std::array<std::byte, max_message_bytes> hello;
        const std::size_t size = encode({99, 1, 0}, Hello{}, hello);
        std::array<std::byte, max_datagram_bytes> buffer{};
        ASSERT_TRUE(eventually([&] {
            third.send(std::span(hello).first(size), 0);
            EXPECT_FALSE(third.receive(buffer, 0));
            return third.figures().refused > 1;
        }));
        EXPECT_FALSE(third.figures().met);
        EXPECT_EQ(pair.first.figures().refused, 0u);
        EXPECT_TRUE(eventually([&] {
            pair.second.send(bytes(7, 3), 0);
            return pair.first.receive(buffer, 0).bytes == 7;
        }));
        EXPECT_TRUE(eventually([&] {
            pair.first.send(bytes(8, 3), 0);
            return pair.second.receive(buffer, 0).bytes == 8;
        }));
    }
}

TEST(UdpLink, AClosedLinkTakesNothingAndGivesNothing) {
    UdpLink link;
    std::array<std::byte, max_datagram_bytes> buffer{};
    EXPECT_FALSE(link.send(bytes(3, 1), 0));
    EXPECT_FALSE(link.receive(buffer, 0));
    EXPECT_EQ(link.local_port(), 0);
    ASSERT_EQ(link.open(to(9)), "");
    link.close();
    link.close();
    EXPECT_EQ(link.figures().state, UdpState::closed);
}

TEST(UdpLink, AFarSideThatIsNotThereIsNoticedAndMayComeLater) {
    const std::uint16_t port = free_port();
    UdpLink first;
    ASSERT_EQ(first.open(to(port)), "");
    ASSERT_TRUE(eventually([&] {
        first.send(bytes(4, 1), 0);
        return first.figures().state == UdpState::unreachable;
    }));
    EXPECT_GT(first.figures().unreachable, 0u);
    UdpLink second;
    ASSERT_EQ(second.open(to(first.local_port(), port)), "");
    std::array<std::byte, max_datagram_bytes> buffer{};
    EXPECT_TRUE(eventually([&] {
        first.send(bytes(4, 2), 0);
        second.send(bytes(4, 3), 0);
        return static_cast<bool>(second.receive(buffer, 0)) && first.figures().state == UdpState::open;
    }));
}

TEST(UdpLink, StrangersAndGiantsAreDropped) {
    Pair pair;
    send_from(0, pair.first.local_port(), {bytes(50, 9)});

    // From the right address, but longer than any of ours: by way of the second link's port.
    const std::uint16_t second_port = pair.second.local_port();
    pair.second.close();
    send_from(second_port, pair.first.local_port(), {bytes(max_datagram_bytes + 1, 9), {}, bytes(3, 5)});

    std::array<std::byte, max_datagram_bytes> buffer{};
    ReceivedDatagram received;
    ASSERT_TRUE(eventually([&] { return (received = pair.first.receive(buffer, 0)).bytes != 0; }));
    EXPECT_EQ(received.bytes, 3u);
    EXPECT_EQ(pair.first.figures().oversized, 1u);
    EXPECT_FALSE(pair.first.receive(buffer, 0));
}

TEST(UdpLink, WhatNobodyTakesIsBounded) {
    UdpSettings settings = to(9);
    settings.capacity = 8;
    UdpLink first, second;
    ASSERT_EQ(second.open(to(9)), "");
    settings.remote_port = second.local_port();
    ASSERT_EQ(first.open(settings), "");
    settings = to(first.local_port(), second.local_port());
    second.close();
    ASSERT_EQ(second.open(settings), "");
    EXPECT_TRUE(eventually([&] {
        second.send(bytes(10, 1), 0);
        return first.figures().no_room_to_take > 0;
    }));
    std::array<std::byte, max_datagram_bytes> buffer{};
    int waiting = 0;
    while (first.receive(buffer, 0)) {
        ++waiting;
    }
    EXPECT_GE(waiting, 8);
}

TEST(UdpLink, IsTheSameOverTheNewInternet) {
    UdpLink first, second;
    UdpSettings settings;
    settings.local_address = settings.remote_address = "::1";
    settings.remote_port = 9;
    if (!first.open(settings).empty()) {
        GTEST_SKIP() << "this machine has no IPv6";
    }
    const std::uint16_t first_port = first.local_port();
    settings.remote_port = first_port;
    ASSERT_EQ(second.open(settings), "");
    first.close();
    settings.local_port = first_port;
    settings.remote_port = second.local_port();
    ASSERT_EQ(first.open(settings), "");
    std::array<std::byte, max_datagram_bytes> buffer{};
    EXPECT_TRUE(eventually([&] {
        second.send(bytes(10, 1), 0);
        return static_cast<bool>(first.receive(buffer, 0));
    }));
}

// The thread that ticks touches no lock of the network thread's, allocates nothing and makes no system call.
TEST(UdpLink, TheHapticThreadWaitsForNobody) {
    Pair pair(true);
    EndpointSettings settings;
    LinkEmulator near_link(pair.first, {}, 1);
    Endpoint near(near_link, settings);
    settings.side = Side::teleoperator_side;
    settings.epoch = 2;
    Endpoint far(pair.second, settings);
    const Message samples = DiscoveryAcknowledgement{1, {}, DiscoveryVerdict::known};
    int received = 0;
    std::atomic<bool> done{false};
    const testing::LockAudit locks;
    std::thread far_side([&] {
        while (!done) {
            far.begin_tick(monotonic_now());
            while (far.receive() != nullptr) {
            }
            far.send(samples);
            far.end_tick();
            nap();
        }
        far.leave();
    });
    std::size_t offences = 0;
    std::string first_offence;
    const Nanoseconds end = monotonic_now() + patience;
    while (monotonic_now() < end && (received < 200 || near.statistics().clock.exchanges < 3)) {
        testing::AuditScope audit;
        near.begin_tick(monotonic_now());
        while (near.receive() != nullptr) {
            ++received;
        }
        near.send(samples);
        near.end_tick();
        audit.finish();
        const std::size_t found =
            audit.allocations() + audit.frees() + audit.locks() + audit.waits() + audit.system_calls();
        first_offence = offences == 0 && found != 0 ? audit.describe() : first_offence;
        offences += found;
        nap();
    }
    done = true;
    far_side.join();
    EXPECT_GE(received, 200);
    EXPECT_TRUE(near.connected());
    EXPECT_EQ(offences, 0u) << first_offence;
    EXPECT_TRUE(locks.shared_locks().empty());
}

TEST(UdpLink, ClosingSendsWhatWasSaidLast) {
    Pair pair;
    pair.first.send(bytes(5, 42), 0);
    pair.first.close();
    std::array<std::byte, max_datagram_bytes> buffer{};
    ReceivedDatagram received;
    ASSERT_TRUE(eventually([&] { return (received = pair.second.receive(buffer, 0)).bytes != 0; }));
    EXPECT_EQ(buffer[0], std::byte{42});
}

}  // namespace
}  // namespace tactus::udp_link_test
