#include <winsock2.h>

#include "platform/socket_error_windows.hpp"
#include "platform/udp_socket.hpp"

namespace tactus {

struct DatagramBatch::System {
    explicit System(std::size_t longest) : room(longest + 1), bytes(capacity * room) {}

    std::size_t room;
    std::vector<std::byte> bytes;
    std::array<std::size_t, capacity> sizes{};
};

DatagramBatch::DatagramBatch(std::size_t longest) : system_(std::make_unique<System>(longest)) {}
DatagramBatch::~DatagramBatch() = default;

// One that is longer than its room is an error here, of which the beginning has come.
SocketError DatagramBatch::receive(SocketHandle socket) {
    for (size_ = 0; size_ < capacity; ++size_) {
        auto* const into = reinterpret_cast<char*>(system_->bytes.data() + size_ * system_->room);
        const int came = recv(static_cast<SOCKET>(socket), into, static_cast<int>(system_->room), 0);
        const int code = came < 0 ? WSAGetLastError() : 0;
        if (came < 0 && code != WSAEMSGSIZE) {
            return size_ == 0 ? windows::socket_error(code) : SocketError{};
        }
        system_->sizes[size_] = came < 0 ? system_->room : static_cast<std::size_t>(came);
    }
    return {};
}

std::span<const std::byte> DatagramBatch::operator[](std::size_t i) const {
    return std::span(system_->bytes).subspan(i * system_->room, system_->sizes[i]);
}

}  // namespace tactus
