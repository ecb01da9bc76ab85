#include "devices/falcon/falcon_packet.hpp"

#include <algorithm>
#include <cstring>

namespace tactus {

namespace {

constexpr std::uint8_t zero = 'A';

FalconPacket encode(const std::array<std::int16_t, 3>& values, unsigned flags) {
    FalconPacket packet{'<'};
    std::size_t at = 1;
    for (const std::int16_t value : values) {
        for (unsigned shift = 0; shift < 16; shift += 4) {
            const unsigned nibble = (static_cast<std::uint16_t>(value) >> shift) & 0xfu;
            packet[at++] = static_cast<std::uint8_t>(zero + nibble);
        }
    }
    packet[at++] = static_cast<std::uint8_t>(zero + flags);
    packet[at++] = zero;
    packet[at] = '>';
    return packet;
}

bool is_packet(const std::uint8_t* bytes) {
    return bytes[0] == '<' && bytes[falcon_packet_size - 1] == '>' && bytes[13] >= zero &&
           std::all_of(bytes + 1, bytes + 13, [](std::uint8_t b) { return b >= zero && b < zero + 16; });
}

std::array<std::int16_t, 3> values_of(const std::uint8_t* bytes) {
    std::array<std::int16_t, 3> values{};
    for (std::size_t i = 0; i < 12; ++i) {
        values[i / 4] = static_cast<std::int16_t>(static_cast<unsigned>(values[i / 4]) |
                                                  static_cast<unsigned>(bytes[1 + i] - zero) << 4 * (i % 4));
    }
    return values;
}

void decode(const std::uint8_t* bytes, FalconReport& report) {
    const unsigned flags = static_cast<unsigned>(bytes[13] - zero);
    report = {values_of(bytes), static_cast<std::uint8_t>(flags & 0xfu),
              static_cast<std::uint8_t>(flags >> 4 & 7u)};
}

void decode(const std::uint8_t* bytes, FalconCommand& command) {
    const unsigned flags = static_cast<unsigned>(bytes[13] - zero);
    command = {values_of(bytes), (flags & 1u) != 0, static_cast<std::uint8_t>(flags >> 1 & 7u)};
}

}  // namespace

FalconPacket falcon_encode(const FalconCommand& command) {
    return encode(command.torques, (command.homing ? 1u : 0u) | unsigned{command.leds} << 1);
}

FalconPacket falcon_encode(const FalconReport& report) {
    return encode(report.encoders, report.buttons | unsigned{report.homed} << 4);
}

template <typename Message>
void FalconStream<Message>::take(std::span<const std::uint8_t> bytes) {
    if (bytes.size() > bytes_.size() - size_) {
        dropped_ += size_;
        size_ = 0;
        const std::size_t room = std::min(bytes.size(), bytes_.size());
        dropped_ += bytes.size() - room;
        bytes = bytes.last(room);
    }
    if (!bytes.empty()) {
        std::memcpy(bytes_.data() + size_, bytes.data(), bytes.size());
        size_ += bytes.size();
    }
}

// A packet's beginning cannot be part of one, so that whatever was lost, the next whole packet is found.
template <typename Message>
bool FalconStream<Message>::next(Message& message) {
    std::size_t at = 0;
    bool found = false;
    while (size_ - at >= falcon_packet_size && !found) {
        if (is_packet(bytes_.data() + at)) {
            decode(bytes_.data() + at, message);
            at += falcon_packet_size;
            found = true;
        } else {
            const auto from = bytes_.begin() + static_cast<std::ptrdiff_t>(at + 1);
            const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(size_);
            at = static_cast<std::size_t>(std::find(from, end, std::uint8_t{'<'}) - bytes_.begin());
            ++dropped_;
        }
    }
    std::memmove(bytes_.data(), bytes_.data() + at, size_ - at);
    size_ -= at;
    return found;
}

template class FalconStream<FalconReport>;
template class FalconStream<FalconCommand>;

}  // namespace tactus
