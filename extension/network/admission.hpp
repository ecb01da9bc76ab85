// Which datagrams a side under a key looks at, told from their first bytes alone: what cannot be meant for it
// is dropped before anything is done for it, by the system where that can be taught to
// (network/socket_filter.hpp), else here.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus {

struct Admission {
    std::uint64_t own_start = 0;              // a greeting that names it comes from who has heard this side
    std::array<std::uint32_t, 2> sessions{};  // whose sealed packets are opened
    std::uint32_t session_count = 0;          // 0 … 2
    bool strangers = true;                    // other greetings, and what is not sealed, are looked at, too

    bool admits(std::span<const std::byte> datagram) const;
    friend bool operator==(const Admission&, const Admission&) = default;
};

}  // namespace tactus
