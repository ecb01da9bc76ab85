#include "network/shared_secret.hpp"

#include <sodium.h>

#include <cstring>
#include <tuple>

namespace tactus {
namespace {

constexpr std::size_t half_bytes = 24;  // a start and its salt
using BothStarts = std::array<std::uint8_t, 2 * half_bytes>;

void write_half(std::uint8_t* into, std::uint64_t start, const std::array<std::uint8_t, 16>& salt) {
    std::memcpy(into, &start, sizeof start);
    std::memcpy(into + sizeof start, salt.data(), salt.size());
}

// The same on both sides: the lower public key's first.
BothStarts both_starts(const SecureIdentity& own, const SecurePeer& peer, bool own_first) {
    BothStarts both;
    write_half(both.data() + (own_first ? 0 : half_bytes), own.start, own.salt);
    write_half(both.data() + (own_first ? half_bytes : 0), peer.start, peer.salt);
    return both;
}

bool stretch(const SharedSecret& secret, const BothStarts& both, SecretKey& key) {
    if (secret.key) {
        return crypto_generichash(key.data(), key.size(), both.data(), both.size(), secret.key->data(),
                                  secret.key->size()) == 0;
    }
    std::array<std::uint8_t, crypto_pwhash_SALTBYTES> salt;
    crypto_generichash(salt.data(), salt.size(), both.data(), both.size(), nullptr, 0);
    return crypto_pwhash(key.data(), key.size(), secret.passphrase.data(), secret.passphrase.size(),
                         salt.data(), crypto_pwhash_OPSLIMIT_INTERACTIVE, crypto_pwhash_MEMLIMIT_INTERACTIVE,
                         crypto_pwhash_ALG_ARGON2ID13) == 0;
}

void mix(SecretKey& key, const SecretKey& secret) {
    SecretKey mixed;
    crypto_generichash(mixed.data(), mixed.size(), key.data(), key.size(), secret.data(), secret.size());
    key = mixed;
    sodium_memzero(mixed.data(), mixed.size());
}

}  // namespace

std::optional<SharedSecret> shared_secret(std::string_view text) {
    constexpr std::string_view blanks = " \t\r\n";
    constexpr std::size_t least_passphrase = 8;
    const std::size_t begin = text.find_first_not_of(blanks);
    if (begin == std::string_view::npos) {
        return std::nullopt;
    }
    text = text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
    SecretKey key;
    std::size_t size = 0;
    const char* end = nullptr;
    if (text.size() == 2 * key.size() &&
        sodium_hex2bin(key.data(), key.size(), text.data(), text.size(), nullptr, &size, &end) == 0 &&
        size == key.size()) {
        return SharedSecret{key, {}};
    }
    if (text.size() < least_passphrase) {
        return std::nullopt;
    }
    return SharedSecret{std::nullopt, std::string(text)};
}

SecureIdentity random_identity() {
    // Chooses the code for this processor; the plain code serves where that fails.
    [[maybe_unused]] const int initialised = sodium_init();
    SecureIdentity identity;
    while (identity.start == 0) {
        randombytes_buf(&identity.start, sizeof identity.start);
    }
    randombytes_buf(identity.salt.data(), identity.salt.size());
    crypto_kx_keypair(identity.public_key.data(), identity.private_key.data());
    return identity;
}

std::optional<SessionKeys> session_keys(const SharedSecret& secret, const SecureIdentity& own,
                                        const SecurePeer& peer) {
    const bool own_first = std::tie(own.public_key, own.start) < std::tie(peer.public_key, peer.start);
    SessionKeys keys;
    const auto exchange = own_first ? crypto_kx_client_session_keys : crypto_kx_server_session_keys;
    if (exchange(keys.receive.data(), keys.send.data(), own.public_key.data(), own.private_key.data(),
                 peer.public_key.data()) != 0) {
        return std::nullopt;
    }
    const BothStarts both = both_starts(own, peer, own_first);
    SecretKey stretched;
    if (!stretch(secret, both, stretched)) {
        return std::nullopt;
    }
    mix(keys.receive, stretched);
    mix(keys.send, stretched);
    sodium_memzero(stretched.data(), stretched.size());
    std::array<std::uint8_t, crypto_generichash_BYTES> digest;
    crypto_generichash(digest.data(), digest.size(), both.data(), both.size(), nullptr, 0);
    std::memcpy(&keys.id, digest.data(), sizeof keys.id);
    return keys;
}

}  // namespace tactus
