// The system drops what an Admission does not admit, and that alone.
#include "network/socket_filter.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <vector>

#include "network/sealed_format.hpp"
#include "shared/random_values.hpp"

namespace tactus {
namespace {

using Bytes = std::vector<std::byte>;
constexpr std::uint64_t own_start = 0x8182838485868788u;

// Two sockets of this machine that talk to each other.
class Sockets {
public:
    Sockets() {
        for (int& file : files_) {
            file = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
            sockaddr_in here{};
            here.sin_family = AF_INET;
            here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
            EXPECT_EQ(bind(file, reinterpret_cast<const sockaddr*>(&here), sizeof here), 0);
        }
        for (int i = 0; i < 2; ++i) {
            sockaddr_in there{};
            socklen_t size = sizeof there;
            getsockname(files_[1 - i], reinterpret_cast<sockaddr*>(&there), &size);
            EXPECT_EQ(connect(files_[i], reinterpret_cast<const sockaddr*>(&there), sizeof there), 0);
        }
    }
    ~Sockets() {
        ::close(files_[0]);
        ::close(files_[1]);
    }
    int receiver() const { return files_[1]; }

    // Of this machine: what has been sent is there, or will never be.
    bool arrives(const Bytes& datagram) {
        EXPECT_EQ(send(files_[0], datagram.data(), datagram.size(), 0),
                  static_cast<ssize_t>(datagram.size()));
        std::array<std::byte, 2048> into;
        return recv(files_[1], into.data(), into.size(), 0) == static_cast<ssize_t>(datagram.size());
    }

private:
    int files_[2] = {-1, -1};
};

Bytes datagram(const char* front, std::size_t size) {
    Bytes bytes(std::max<std::size_t>(size, 4), std::byte{0x33});
    std::memcpy(bytes.data(), front, 4);
    bytes.resize(size);
    return bytes;
}
Bytes packet_of(std::uint32_t session, std::size_t size = 100) {
    Bytes bytes = datagram("TS\2\1", size);
    std::memcpy(&bytes[sealed_format::session_at], &session, sizeof session);
    return bytes;
}
Bytes greeting_to(std::uint64_t receiver, std::size_t size = sealed_format::greeting_bytes) {
    Bytes bytes = datagram("TS\2\0", size);
    std::memcpy(&bytes[sealed_format::receiver_at], &receiver, sizeof receiver);
    return bytes;
}

Admission of_two_sessions(bool strangers) {
    return {own_start, {0x12345678u, 0x9abcdef0u}, 2, strangers};
}

TEST(Admission, ALivingSessionHearsItselfAndWhoHasHeardIt) {
    const Admission admission = of_two_sessions(false);
    EXPECT_TRUE(admission.admits(packet_of(0x12345678u)));
    EXPECT_TRUE(admission.admits(packet_of(0x9abcdef0u, 32)));
    EXPECT_FALSE(admission.admits(packet_of(0x9abcdef0u, 31)));
    EXPECT_FALSE(admission.admits(packet_of(0x78563412u)));
    EXPECT_TRUE(admission.admits(greeting_to(own_start)));
    EXPECT_FALSE(admission.admits(greeting_to(own_start ^ 1)));
    EXPECT_FALSE(admission.admits(greeting_to(own_start ^ (std::uint64_t{1} << 40))));
    EXPECT_FALSE(admission.admits(greeting_to(own_start, 69)));
    EXPECT_FALSE(admission.admits(greeting_to(0)));
    EXPECT_FALSE(admission.admits(datagram("TC\2\1", 60)));
    EXPECT_FALSE(admission.admits(datagram("TS\3\0", 68)));
    EXPECT_FALSE(admission.admits({}));
}

TEST(Admission, StrangersAreHeardWhereTheyMayBeTheFarSide) {
    const Admission admission = of_two_sessions(true);
    EXPECT_TRUE(admission.admits(greeting_to(0)));
    EXPECT_FALSE(admission.admits(greeting_to(0, 67)));
    EXPECT_TRUE(admission.admits(datagram("TC\2\1", 60))) << "it has no key: that is worth saying";
    EXPECT_TRUE(admission.admits(datagram("TS\3\0", 68))) << "another version: that is, too";
    EXPECT_FALSE(admission.admits(packet_of(1)));
    EXPECT_FALSE(admission.admits(datagram("GET ", 60)));
    EXPECT_FALSE(admission.admits(datagram("TC", 2)));
}

TEST(SocketFilter, TheSystemAdmitsTheSame) {
    Sockets sockets;
    shared::RandomValues random(11);
    int admitted = 0, dropped = 0;
    for (int i = 0; i < 4000; ++i) {
        Admission admission = of_two_sessions(random.below(2) == 0);
        admission.session_count = static_cast<std::uint32_t>(random.below(3));
        for (std::size_t k = admission.session_count; k < admission.sessions.size(); ++k) {
            admission.sessions[k] = 0;
        }
        ASSERT_TRUE(attach_filter(sockets.receiver(), admission));
        const auto size = static_cast<std::size_t>(1 + random.below(80));
        constexpr const char* fronts[] = {"TS\2\0", "TS\2\1", "TC\2\1", "TS\1\0", "TS\2\2", "noise"};
        Bytes one = datagram(fronts[random.below(6)], random.below(2) == 0 ? 68 : size);
        if (one.size() >= 20) {
            const std::uint64_t names[] = {0, own_start, own_start ^ 1, own_start << 32};
            std::memcpy(&one[sealed_format::receiver_at], &names[random.below(4)], 8);
            const std::uint32_t sessions[] = {0x12345678u, 0x9abcdef0u, 0};
            std::memcpy(&one[sealed_format::session_at], &sessions[random.below(3)], 4);
        }
        const bool expected = admission.admits(one);
        ASSERT_EQ(sockets.arrives(one), expected) << i;
        (expected ? admitted : dropped) += 1;
    }
    EXPECT_GT(admitted, 500);
    EXPECT_GT(dropped, 500);
    EXPECT_EQ(dropped_by_system(sockets.receiver()), static_cast<std::uint64_t>(dropped));
}

}  // namespace
}  // namespace tactus
