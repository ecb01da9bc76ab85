// What both sides know beforehand, and what is made of it for one session.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tactus {

using SecretKey = std::array<std::uint8_t, 32>;

// 64 hexadecimal digits are a key; any other text of at least 8 bytes is a passphrase.
struct SharedSecret {
    std::optional<SecretKey> key;
    std::string passphrase;  // where there is no key
};

// Nothing where the text is too short. Blanks and line ends around it do not count.
std::optional<SharedSecret> shared_secret(std::string_view text);

// The start of a side: drawn at random each time.
struct SecureIdentity {
    std::uint64_t start = 0;  // never 0
    std::array<std::uint8_t, 16> salt{};
    std::array<std::uint8_t, 32> public_key{};
    std::array<std::uint8_t, 32> private_key{};
};
SecureIdentity random_identity();

// What the far side says of its start.
struct SecurePeer {
    std::uint64_t start = 0;
    std::array<std::uint8_t, 16> salt{};
    std::array<std::uint8_t, 32> public_key{};
};

struct SessionKeys {
    std::uint32_t id = 0;  // tells the session's packets from others
    SecretKey receive{};
    SecretKey send{};
};

// Takes a fraction of a second and 64 MiB for a passphrase (Argon2id, salted by both sides): off the loop and
// off the network thread. Nothing where the far side's public key is none, or the memory is not to be had.
// docs/wire_format.md, "Sealed packets".
std::optional<SessionKeys> session_keys(const SharedSecret& secret, const SecureIdentity& own,
                                        const SecurePeer& peer);

}  // namespace tactus
