#include <sys/socket.h>

#include <cerrno>

#include "platform/socket_error_posix.hpp"
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

SocketError DatagramBatch::receive(SocketHandle socket) {
    for (size_ = 0; size_ < capacity; ++size_) {
        std::byte* const into = system_->bytes.data() + size_ * system_->room;
        const ssize_t came = recv(static_cast<int>(socket), into, system_->room, 0);
        if (came < 0) {
            return size_ == 0 ? posix::socket_error(errno) : SocketError{};
        }
        system_->sizes[size_] = static_cast<std::size_t>(came);
    }
    return {};
}

std::span<const std::byte> DatagramBatch::operator[](std::size_t i) const {
    return std::span(system_->bytes).subspan(i * system_->room, system_->sizes[i]);
}

}  // namespace tactus
