// A link under a key that both sides know beforehand: what passes can neither be read nor altered, nor played
// again later, not even from before a restart.
//
// Each datagram is sealed with XChaCha20-Poly1305 (libsodium). Its nonce of 24 bytes is the number of the
// sender's start, the number of the receiver's start and a counter. The start numbers are drawn at random, so
// no nonce ever comes twice under a key. A packet is believed when it is sealed to this very start of this
// side: a recording of an earlier start names another one. The two learn each other's number from empty
// packets that are sealed to nobody, and believe it once an answer sealed to themselves has come back
// (docs/wire_format.md, "Sealed packets").
//
// Belongs to the haptic thread; change nothing, allocate nothing, ask the system for nothing in send and
// receive.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/ports/link.hpp"
#include "network/sequence_window.hpp"

namespace tactus {

using SecretKey = std::array<std::uint8_t, 32>;

// Off the loop: takes a fraction of a second for a passphrase. 64 hexadecimal digits are the key itself;
// any other text of at least 8 bytes is stretched with Argon2id. Nothing where the text is shorter, or where
// the memory for stretching (64 MiB) is not to be had.
std::optional<SecretKey> secret_key(std::string_view text);

struct SecureCounts {
    std::uint64_t opened = 0;
    std::uint64_t not_sealed = 0;  // the far side uses no key, or another version
    std::uint64_t wrong_key = 0;   // sealed under another key, or altered on the way
    std::uint64_t replayed = 0;    // opened before, or too old to tell
    std::uint64_t other_start =
        0;  // sealed to an earlier start of this side, or by an earlier one of the far side
    std::uint64_t not_yet = 0;  // not sent: the far side has not been met
};

class SecureLink final : public Link {
public:
    static constexpr std::size_t overhead = 44;  // (unit: bytes) a datagram

    // `inner` must outlive the link. `start`: random_epoch(); never 0, never one that was used under this
    // key.
    SecureLink(Link& inner, const SecretKey& key, std::uint64_t start);

    bool send(std::span<const std::byte> datagram, Nanoseconds now) override;
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override;

    bool met() const { return peer_ != nobody; }
    const SecureCounts& counts() const { return counts_; }

private:
    static constexpr std::uint64_t nobody = 0;
    static constexpr std::size_t most_past =
        256;  // restarts of the far side that one start of this side sees

    bool seal(std::uint64_t to, std::span<const std::byte> plain, Nanoseconds now);
    std::size_t open(std::size_t size, std::span<std::byte> into, Nanoseconds now);
    bool is_past(std::uint64_t start) const;
    bool adopt(std::uint64_t sender, Nanoseconds now);
    void introduce_when_due(Nanoseconds now);

    Link& inner_;
    SecretKey key_;
    std::uint64_t own_;
    std::uint64_t peer_ = nobody;
    std::uint64_t counter_ = 0;
    SequenceWindow window_;
    std::array<std::uint64_t, most_past> past_{};
    std::size_t past_count_ = 0;
    Nanoseconds next_introduction_ = 0;
    Nanoseconds next_reply_ = 0;
    bool started_ = false;
    SecureCounts counts_;
    std::array<std::byte, most_datagram_bytes> sealed_;
};

}  // namespace tactus
