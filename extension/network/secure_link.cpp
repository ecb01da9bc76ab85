#include "network/secure_link.hpp"

#include <sodium.h>

#include <algorithm>
#include <cstring>

#include "network/wire_stream.hpp"

namespace tactus {
namespace {

constexpr std::uint8_t seal_version = 1;
constexpr std::size_t front_bytes = 4;  // magic, version, a zero: authenticated, not encrypted
constexpr std::size_t nonce_bytes = crypto_aead_xchacha20poly1305_ietf_NPUBBYTES;
constexpr std::size_t tag_bytes = crypto_aead_xchacha20poly1305_ietf_ABYTES;
static_assert(front_bytes + nonce_bytes + tag_bytes == SecureLink::overhead);
static_assert(SecureLink::overhead + most_message_bytes <= most_datagram_bytes);
static_assert(sizeof(SecretKey) == crypto_aead_xchacha20poly1305_ietf_KEYBYTES);

constexpr Nanoseconds introduce_every = 100'000'000;
constexpr Nanoseconds reply_every = 10'000'000;
constexpr int most_refused_at_once = 64;  // a flood must not hold up the tick

struct Nonce {
    std::uint64_t sender = 0, receiver = 0, counter = 0;
};
static_assert(sizeof(Nonce) == nonce_bytes);

unsigned char* raw(std::byte* bytes) {
    return reinterpret_cast<unsigned char*>(bytes);
}
const unsigned char* raw(const std::byte* bytes) {
    return reinterpret_cast<const unsigned char*>(bytes);
}

void write_front(std::span<std::byte> into, const Nonce& nonce) {
    std::memcpy(into.data(), &sealed_magic, 2);
    into[2] = std::byte{seal_version};
    into[3] = std::byte{0};
    std::memcpy(into.data() + front_bytes, &nonce, nonce_bytes);
}

bool has_front(std::span<const std::byte> datagram) {
    return datagram.size() >= SecureLink::overhead && std::memcmp(datagram.data(), &sealed_magic, 2) == 0 &&
           datagram[2] == std::byte{seal_version} && datagram[3] == std::byte{0};
}

}  // namespace

std::optional<SecretKey> secret_key(std::string_view text) {
    constexpr std::size_t least_passphrase = 8;
    constexpr std::string_view salt = "tactus link v1.0";
    static_assert(salt.size() == crypto_pwhash_SALTBYTES);
    SecretKey key;
    std::size_t size = 0;
    const char* end = nullptr;
    if (text.size() == 2 * key.size() &&
        sodium_hex2bin(key.data(), key.size(), text.data(), text.size(), nullptr, &size, &end) == 0 &&
        size == key.size()) {
        return key;
    }
    const bool stretched =
        text.size() >= least_passphrase &&
        crypto_pwhash(key.data(), key.size(), text.data(), text.size(),
                      reinterpret_cast<const unsigned char*>(salt.data()), crypto_pwhash_OPSLIMIT_INTERACTIVE,
                      crypto_pwhash_MEMLIMIT_INTERACTIVE, crypto_pwhash_ALG_ARGON2ID13) == 0;
    return stretched ? std::optional(key) : std::nullopt;
}

SecureLink::SecureLink(Link& inner, const SecretKey& key, std::uint64_t start)
    : inner_(inner), key_(key), own_(start) {
    // Chooses the code for this processor; the plain code serves where that fails.
    [[maybe_unused]] const int initialised = sodium_init();
}

bool SecureLink::send(std::span<const std::byte> datagram, Nanoseconds now) {
    if (!met()) {
        ++counts_.not_yet;
        return false;
    }
    return !datagram.empty() && datagram.size() + overhead <= most_datagram_bytes &&
           seal(peer_, datagram, now);
}

bool SecureLink::seal(std::uint64_t to, std::span<const std::byte> plain, Nanoseconds now) {
    std::array<std::byte, most_datagram_bytes> sealed;
    const Nonce nonce{own_, to, ++counter_};
    write_front(sealed, nonce);
    unsigned long long written = 0;
    crypto_aead_xchacha20poly1305_ietf_encrypt(
        raw(sealed.data()) + front_bytes + nonce_bytes, &written, raw(plain.data()), plain.size(),
        raw(sealed.data()), front_bytes, nullptr, raw(sealed.data()) + front_bytes, key_.data());
    return inner_.send(std::span(sealed).first(front_bytes + nonce_bytes + written), now);
}

ReceivedDatagram SecureLink::receive(std::span<std::byte> into, Nanoseconds now) {
    introduce_when_due(now);
    for (int i = 0; i < most_refused_at_once; ++i) {
        const ReceivedDatagram received = inner_.receive(sealed_, now);
        if (!received) {
            break;
        }
        const std::size_t size = open(received.bytes, into, now);
        if (size != 0) {
            return {size, received.arrived};
        }
    }
    return {};
}

// The number of bytes for the caller; 0 where the packet is empty or not believed.
std::size_t SecureLink::open(std::size_t size, std::span<std::byte> into, Nanoseconds now) {
    const std::span<const std::byte> datagram = std::span(sealed_).first(size);
    if (!has_front(datagram)) {
        ++counts_.not_sealed;
        return 0;
    }
    Nonce nonce;
    std::memcpy(&nonce, datagram.data() + front_bytes, nonce_bytes);
    const bool introduction = nonce.receiver == nobody;
    if (nonce.sender == own_ || nonce.sender == nobody || is_past(nonce.sender) ||
        (!introduction && nonce.receiver != own_)) {
        ++counts_.other_start;
        return 0;
    }
    if (size - overhead > into.size()) {
        ++counts_.wrong_key;  // longer than any packet of ours
        return 0;
    }
    unsigned long long plain = 0;
    const std::size_t begin = front_bytes + nonce_bytes;
    if (crypto_aead_xchacha20poly1305_ietf_decrypt(
            raw(into.data()), &plain, nullptr, raw(datagram.data()) + begin, size - begin,
            raw(datagram.data()), front_bytes, raw(datagram.data()) + front_bytes, key_.data()) != 0) {
        ++counts_.wrong_key;
        return 0;
    }
    if (introduction) {
        // It may be a recording: an answer is all that it gets. Whoever is there now can open that.
        if (now >= next_reply_) {
            next_reply_ = now + reply_every;
            seal(nonce.sender, {}, now);
        }
        return 0;
    }
    if (nonce.sender != peer_ && !adopt(nonce.sender, now)) {
        return 0;
    }
    const SequenceWindow::Arrival arrival = window_.note(nonce.counter);
    if (arrival == SequenceWindow::Arrival::copy || arrival == SequenceWindow::Arrival::too_old) {
        ++counts_.replayed;
        return 0;
    }
    ++counts_.opened;
    return static_cast<std::size_t>(plain);
}

// The sender has sealed a packet to this start, so it is no recording: it is the far side, or its next start.
bool SecureLink::adopt(std::uint64_t sender, Nanoseconds now) {
    if (met()) {
        if (past_count_ == most_past) {
            ++counts_.other_start;
            return false;
        }
        past_[past_count_++] = peer_;
    }
    peer_ = sender;
    window_.forget();
    seal(peer_, {}, now);  // so that it can believe this side as well
    return true;
}

bool SecureLink::is_past(std::uint64_t start) const {
    const auto end = past_.begin() + static_cast<std::ptrdiff_t>(past_count_);
    return std::find(past_.begin(), end, start) != end;
}

void SecureLink::introduce_when_due(Nanoseconds now) {
    if (!started_) {
        started_ = true;
        next_introduction_ = next_reply_ = now;
    }
    if (!met() && now >= next_introduction_) {
        next_introduction_ = now + introduce_every;
        seal(nobody, {}, now);
    }
}

}  // namespace tactus
