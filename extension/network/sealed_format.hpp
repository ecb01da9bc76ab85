// Where things stand in a greeting and in a sealed packet (docs/wire_format.md, "Sealed packets").
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace tactus::sealed_format {

inline constexpr std::uint8_t version = 2;
enum Kind : std::uint8_t { greeting = 0, packet = 1 };

// Magic, version and kind of either.
inline constexpr std::size_t front_bytes = 4;

// A greeting: front, sender, receiver, salt, public key. The two are numbers of starts.
inline constexpr std::size_t sender_at = 4, receiver_at = 12, salt_at = 20, public_key_at = 36;
inline constexpr std::size_t greeting_bytes = 68;
inline constexpr std::uint64_t nobody = 0;  // as a receiver: whoever hears it

// A sealed packet: front, session, counter, ciphertext, tag. What stands before the ciphertext is
// authenticated, not encrypted.
inline constexpr std::size_t session_at = 4, counter_at = 8, ciphertext_at = 16, tag_bytes = 16;
inline constexpr std::size_t overhead = ciphertext_at + tag_bytes;

template <typename Value>
Value read_at(std::span<const std::byte> bytes, std::size_t at) {
    Value value;
    std::memcpy(&value, &bytes[at], sizeof value);
    return value;
}

}  // namespace tactus::sealed_format
