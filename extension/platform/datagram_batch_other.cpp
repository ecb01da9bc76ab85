#include "platform/receive_datagram_other.hpp"

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
        const std::span into = std::span(system_->bytes).subspan(size_ * system_->room, system_->room);
        if (const SocketError error = receive_datagram(socket, into, system_->sizes[size_])) {
            return size_ == 0 ? error : SocketError{};
        }
    }
    return {};
}

std::span<const std::byte> DatagramBatch::operator[](std::size_t i) const {
    return std::span(system_->bytes).subspan(i * system_->room, system_->sizes[i]);
}

}  // namespace tactus
