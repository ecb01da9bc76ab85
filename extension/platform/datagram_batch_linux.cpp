#include <sys/socket.h>

#include <cerrno>

#include "platform/socket_error_posix.hpp"
#include "platform/udp_socket.hpp"

namespace tactus {

struct DatagramBatch::System {
    explicit System(std::size_t longest) : room(longest + 1), bytes(capacity * room) {
        for (std::size_t i = 0; i < capacity; ++i) {
            parts[i] = {bytes.data() + i * room, room};
            messages[i] = {};
            messages[i].msg_hdr.msg_iov = &parts[i];
            messages[i].msg_hdr.msg_iovlen = 1;
        }
    }

    std::size_t room;
    std::vector<std::byte> bytes;
    std::array<iovec, capacity> parts;
    std::array<mmsghdr, capacity> messages;
};

DatagramBatch::DatagramBatch(std::size_t longest) : system_(std::make_unique<System>(longest)) {}
DatagramBatch::~DatagramBatch() = default;

SocketError DatagramBatch::receive(SocketHandle socket) {
    const int came =
        recvmmsg(static_cast<int>(socket), system_->messages.data(), capacity, MSG_DONTWAIT, nullptr);
    size_ = static_cast<std::size_t>(came < 0 ? 0 : came);
    return came < 0 ? posix::socket_error(errno) : SocketError{};
}

std::span<const std::byte> DatagramBatch::operator[](std::size_t i) const {
    return std::span(system_->bytes).subspan(i * system_->room, system_->messages[i].msg_len);
}

}  // namespace tactus
