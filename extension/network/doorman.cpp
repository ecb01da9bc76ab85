#include "network/doorman.hpp"

#include <cstring>
#include <utility>

#include "network/messages.hpp"
#include "network/wire_stream.hpp"
#include "platform/side_socket.hpp"

namespace tactus {
namespace {

using namespace sealed_format;

constexpr Nanoseconds look_every = 50'000'000;
constexpr int answers_a_look = 4;

constexpr std::uint8_t hello_kind = 1;
constexpr std::size_t epoch_at = 4;
constexpr std::size_t least_hello_bytes = 14 + 50;

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

void Doorman::open(SocketHandle beside, IpFamily family) {
    close();
    socket_ = open_beside(beside, family);
}

void Doorman::close() {
    if (socket_ != no_socket) {
        close_udp(std::exchange(socket_, no_socket));
    }
}

void Doorman::answer(Nanoseconds now) {
    if (socket_ == no_socket || now < next_look_) {
        return;
    }
    next_look_ = now + look_every;
    std::array<std::byte, max_datagram_bytes> bytes;
    IpAddress from;
    for (int i = 0; i < answers_a_look; ++i) {
        const std::size_t came = receive_udp_from(socket_, bytes, from);
        if (came == 0) {
            return;
        }
        if (const auto number = number_of_knock(std::span(bytes).first(came))) {
            send_udp_to(socket_, refusal_of(*number, expects_another), from);
        }
    }
}

}  // namespace tactus
