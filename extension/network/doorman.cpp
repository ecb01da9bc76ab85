#include "network/doorman.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <cstring>

#include "network/messages.hpp"
#include "network/wire_stream.hpp"

namespace tactus {
namespace {

using namespace sealed_format;

constexpr Nanoseconds look_every = 50'000'000;
constexpr int answers_a_look = 4;
constexpr int system_buffer_bytes = 4096;  // a few knocks: those that come meanwhile knock again

constexpr std::uint8_t hello_kind = 1;
constexpr std::size_t epoch_at = 4;
constexpr std::size_t least_hello_bytes = 14 + 50;

void reuse_address(int file, int may) {
    setsockopt(file, SOL_SOCKET, SO_REUSEADDR, &may, sizeof may);
}

}  // namespace

RefusalBytes refusal_of(std::uint64_t number, Reason reason) {
    RefusalBytes bytes;
    std::memcpy(bytes.data(), &sealed_magic, sizeof sealed_magic);
    bytes[2] = std::byte{version};
    bytes[3] = std::byte{refusal};
    std::memcpy(&bytes[refused_at], &number, sizeof number);
    bytes[reason_at] = std::byte{reason};
    return bytes;
}

std::optional<std::uint64_t> number_of_knock(std::span<const std::byte> datagram) {
    if (datagram.size() < front_bytes) {
        return std::nullopt;
    }
    const auto magic = read_at<std::uint16_t>(datagram, 0);
    if (magic == sealed_magic && datagram[3] == std::byte{greeting} && datagram.size() == greeting_bytes) {
        return read_at<std::uint64_t>(datagram, sender_at);
    }
    if (magic == packet_magic && datagram[3] == std::byte{hello_kind} &&
        datagram.size() >= least_hello_bytes) {
        return read_at<std::uint64_t>(datagram, epoch_at);
    }
    return std::nullopt;
}

std::optional<std::uint64_t> number_of_refusal(std::span<const std::byte> datagram) {
    if (datagram.size() != refusal_bytes || read_at<std::uint16_t>(datagram, 0) != sealed_magic ||
        datagram[2] != std::byte{version} || datagram[3] != std::byte{refusal} ||
        datagram[reason_at] != std::byte{expects_another}) {
        return std::nullopt;
    }
    return read_at<std::uint64_t>(datagram, refused_at);
}

// The place is shared with the one socket for as long as this one takes to be bound, and with nobody after.
void Doorman::open(int beside, int family) {
    close();
    sockaddr_storage here{};
    socklen_t size = sizeof here;
    const int made = socket(family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (made < 0 || getsockname(beside, reinterpret_cast<sockaddr*>(&here), &size) != 0) {
        ::close(made);
        return;
    }
    setsockopt(made, SOL_SOCKET, SO_RCVBUF, &system_buffer_bytes, sizeof system_buffer_bytes);
    reuse_address(beside, 1);
    reuse_address(made, 1);
    const bool bound = bind(made, reinterpret_cast<const sockaddr*>(&here), size) == 0;
    reuse_address(beside, 0);
    reuse_address(made, 0);
    if (bound) {
        file_ = made;
    } else {
        ::close(made);
    }
}

void Doorman::close() {
    if (file_ >= 0) {
        ::close(file_);
        file_ = -1;
    }
}

void Doorman::answer(Nanoseconds now) {
    if (file_ < 0 || now < next_look_) {
        return;
    }
    next_look_ = now + look_every;
    for (int i = 0; i < answers_a_look; ++i) {
        std::array<std::byte, most_datagram_bytes> bytes;
        sockaddr_storage from{};
        socklen_t size = sizeof from;
        auto* const address = reinterpret_cast<sockaddr*>(&from);
        const ssize_t came = recvfrom(file_, bytes.data(), bytes.size(), MSG_DONTWAIT, address, &size);
        if (came < 0) {
            return;
        }
        if (const auto number = number_of_knock(std::span(bytes).first(static_cast<std::size_t>(came)))) {
            const RefusalBytes said = refusal_of(*number, expects_another);
            sendto(file_, said.data(), said.size(), MSG_DONTWAIT | MSG_NOSIGNAL, address, size);
        }
    }
}

}  // namespace tactus
