// What the systems must agree on. Waits are bounded by what a crowded machine may take.
#include "platform/udp_socket.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "platform/clock.hpp"
#include "support/emulation.hpp"

namespace tactus::udp_socket_test {
namespace {

constexpr Nanoseconds patience = 20 * nanoseconds_per_second;

std::vector<std::byte> bytes(std::size_t size, int fill) {
    return std::vector<std::byte>(size, static_cast<std::byte>(fill));
}

// One that is bound to a free port of this machine's loopback, and closes itself.
struct Bound {
    explicit Bound(IpFamily family = IpFamily::four) {
        SocketError error;
        handle = open_udp(family, error);
        EXPECT_FALSE(error);
        EXPECT_FALSE(bind_udp(handle, loopback(family, 0)));
    }
    ~Bound() { close_udp(handle); }
    SocketHandle handle = no_socket;
};

// What waits is waited for.
SocketError receive(DatagramBatch& batch, SocketHandle socket) {
    SocketWait wait;
    SocketError error{SocketTrouble::not_now, 0};
    for (const Nanoseconds end = monotonic_now() + patience;
         error.trouble == SocketTrouble::not_now && monotonic_now() < end;) {
        wait.wait(std::span(&socket, 1), 100'000'000);
        error = batch.receive(socket);
    }
    return error;
}

TEST(UdpSocket, CarriesDatagramsInTheirOrder) {
    Bound from, to;
    ASSERT_FALSE(connect_udp(from.handle, own_address(to.handle)));
    ASSERT_FALSE(connect_udp(to.handle, own_address(from.handle)));
    EXPECT_EQ(far_address(to.handle), own_address(from.handle));
    for (int i = 1; i <= 3; ++i) {
        EXPECT_FALSE(send_udp(from.handle, bytes(static_cast<std::size_t>(i), i)));
    }
    DatagramBatch batch(100);
    std::vector<std::size_t> sizes;
    while (sizes.size() < 3) {
        ASSERT_FALSE(receive(batch, to.handle));
        for (std::size_t i = 0; i < batch.size(); ++i) {
            sizes.push_back(batch[i].size());
            EXPECT_EQ(batch[i].back(), static_cast<std::byte>(sizes.size()));
        }
    }
    EXPECT_EQ(sizes, (std::vector<std::size_t>{1, 2, 3}));
    EXPECT_EQ(batch.receive(to.handle).trouble, SocketTrouble::not_now);
    EXPECT_EQ(batch.size(), 0u);
}

TEST(UdpSocket, OneThatIsTooLongComesCut) {
    Bound from, to;
    ASSERT_FALSE(connect_udp(from.handle, own_address(to.handle)));
    EXPECT_FALSE(send_udp(from.handle, bytes(500, 1)));
    EXPECT_FALSE(send_udp(from.handle, bytes(7, 2)));
    DatagramBatch batch(100);
    std::vector<std::size_t> sizes;
    while (sizes.size() < 2) {
        ASSERT_FALSE(receive(batch, to.handle));
        for (std::size_t i = 0; i < batch.size(); ++i) {
            sizes.push_back(batch[i].size());
        }
    }
    EXPECT_EQ(sizes, (std::vector<std::size_t>{101, 7}));
}

TEST(UdpSocket, NobodyThereIsSaid) {
    Bound from;
    IpAddress nobody;
    {
        const Bound gone;
        nobody = own_address(gone.handle);
    }
    ASSERT_FALSE(connect_udp(from.handle, nobody));
    DatagramBatch batch(100);
    SocketError error;
    for (const Nanoseconds end = monotonic_now() + patience;
         error.trouble != SocketTrouble::unreachable && monotonic_now() < end;) {
        error = send_udp(from.handle, bytes(3, 1));
        if (!error) {
            error = batch.receive(from.handle);
        }
    }
    EXPECT_EQ(error.trouble, SocketTrouble::unreachable);
}

TEST(UdpSocket, APortThatSomebodyHasIsNamed) {
    const Bound first;
    SocketError error;
    const SocketHandle second = open_udp(IpFamily::four, error);
    EXPECT_EQ(bind_udp(second, own_address(first.handle)).trouble, SocketTrouble::in_use);
    close_udp(second);
}

TEST(UdpSocket, AnAddressOfAnotherMachineIsNamed) {
    if (testing::under_wine()) {
        GTEST_SKIP() << "Wine binds a socket to whatever address it is told";
    }
    SocketError error;
    const SocketHandle socket = open_udp(IpFamily::four, error);
    IpAddress elsewhere = loopback(IpFamily::four, 0);
    elsewhere.host = {192, 0, 2, 1};  // a number kept for documents
    EXPECT_EQ(bind_udp(socket, elsewhere).trouble, SocketTrouble::not_here);
    close_udp(socket);
}

TEST(FindAddresses, KnowsNumbersAndSaysWhatItDoesNotKnow) {
    std::string error;
    EXPECT_EQ(find_addresses("127.0.0.1", 9, IpFamily::any, error),
              std::vector<IpAddress>{loopback(IpFamily::four, 9)});
    EXPECT_EQ(find_addresses("::1", 9, IpFamily::any, error),
              std::vector<IpAddress>{loopback(IpFamily::six, 9)});
    EXPECT_EQ(error, "");
    EXPECT_TRUE(find_addresses("not an address", 9, IpFamily::any, error).empty());
    EXPECT_NE(error, "");
}

TEST(FindAddresses, WithoutANameThereIsOneToListenOn) {
    std::string error;
    const std::vector<IpAddress> found = find_addresses("", 9, IpFamily::four, error);
    ASSERT_FALSE(found.empty()) << error;
    EXPECT_EQ(found[0].host, (std::array<std::uint8_t, 16>{}));
    EXPECT_EQ(found[0].port, 9);
}

TEST(IsLoopback, KnowsBothFamilies) {
    EXPECT_TRUE(is_loopback(loopback(IpFamily::four, 1)));
    EXPECT_TRUE(is_loopback(loopback(IpFamily::six, 1)));
    EXPECT_TRUE(is_loopback({IpFamily::four, {127, 3, 2, 1}, 0, 1}));
    EXPECT_FALSE(is_loopback({IpFamily::four, {10, 0, 0, 1}, 0, 1}));
    EXPECT_FALSE(is_loopback({IpFamily::six, {}, 0, 1}));
}

TEST(SocketWait, EndsByItselfAndAtOnceWhenWoken) {
    const Bound quiet;
    SocketWait wait;
    ASSERT_EQ(wait.error(), "");
    wait.wait(std::span(&quiet.handle, 1), 1'000'000);
    std::thread other([&wait] { wait.wake(); });
    wait.wait(std::span(&quiet.handle, 1), 3600 * nanoseconds_per_second);
    other.join();
    wait.wait({}, 3600 * nanoseconds_per_second);  // for good
}

TEST(SocketWait, EndsWhenADatagramComesAndWhileItStays) {
    Bound from, to;
    ASSERT_FALSE(connect_udp(from.handle, own_address(to.handle)));
    SocketWait wait;
    EXPECT_FALSE(send_udp(from.handle, bytes(3, 1)));
    for (int i = 0; i < 3; ++i) {
        wait.wait(std::span(&to.handle, 1), 3600 * nanoseconds_per_second);
    }
    DatagramBatch batch(100);
    EXPECT_FALSE(batch.receive(to.handle));
    EXPECT_EQ(batch.size(), 1u);
}

}  // namespace
}  // namespace tactus::udp_socket_test
