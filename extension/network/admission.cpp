#include "network/admission.hpp"

#include <algorithm>

#include "network/sealed_format.hpp"
#include "network/wire_stream.hpp"

namespace tactus {

bool Admission::admits(std::span<const std::byte> datagram) const {
    using namespace sealed_format;
    if (datagram.size() < front_bytes) {
        return false;
    }
    const auto magic = read_at<std::uint16_t>(datagram, 0);
    const bool is_sealed =
        magic == sealed_magic && datagram[2] == std::byte{version} && datagram[3] <= std::byte{packet};
    if (!is_sealed) {
        return strangers && (magic == sealed_magic || magic == packet_magic);
    }
    if (datagram[3] == std::byte{greeting}) {
        return datagram.size() == greeting_bytes &&
               (strangers || read_at<std::uint64_t>(datagram, receiver_at) == own_start);
    }
    if (datagram.size() < overhead) {
        return false;
    }
    const auto session = read_at<std::uint32_t>(datagram, session_at);
    return std::find(sessions.begin(), sessions.begin() + session_count, session) !=
           sessions.begin() + session_count;
}

}  // namespace tactus
