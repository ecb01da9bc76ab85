#include "network/secure_session.hpp"

#include <sodium.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "network/wire_stream.hpp"

namespace tactus {
namespace {

using namespace sealed_format;

static_assert(tag_bytes == crypto_aead_chacha20poly1305_ietf_ABYTES);
static_assert(SecureSession::overhead + max_message_bytes <= max_datagram_bytes);
static_assert(sizeof(SecretKey) == crypto_aead_chacha20poly1305_ietf_KEYBYTES);
static_assert(salt_at + sizeof(SecureIdentity::salt) == public_key_at);
static_assert(public_key_at + sizeof(SecureIdentity::public_key) == greeting_bytes);

constexpr Nanoseconds greet_every = 100'000'000;
constexpr Nanoseconds answer_every = 10'000'000;
constexpr Nanoseconds make_every = 500'000'000;

// A side that lives says something at least every 100 ms.
constexpr Nanoseconds silent_after = 250'000'000;

// Strangers that greet too often are not heard for so long.
constexpr Nanoseconds deaf_for = 20'000'000;

unsigned char* raw(std::byte* bytes) {
    return reinterpret_cast<unsigned char*>(bytes);
}
const unsigned char* raw(const std::byte* bytes) {
    return reinterpret_cast<const unsigned char*>(bytes);
}

void write_front(std::span<std::byte> into, Kind kind) {
    std::memcpy(into.data(), &sealed_magic, 2);
    into[2] = std::byte{version};
    into[3] = std::byte{kind};
}

bool has_front(std::span<const std::byte> datagram) {
    return datagram.size() >= SecureSession::overhead &&
           std::memcmp(datagram.data(), &sealed_magic, 2) == 0 && datagram[2] == std::byte{version} &&
           datagram[3] <= std::byte{packet};
}

using SealNonce = std::array<unsigned char, crypto_aead_chacha20poly1305_ietf_NPUBBYTES>;

// Keys are of one session and one direction: the counter alone makes it unique.
SealNonce nonce_of(std::uint64_t counter) {
    SealNonce nonce{};
    std::memcpy(nonce.data() + 4, &counter, sizeof counter);
    return nonce;
}

}  // namespace

SecureSession::SecureSession(SharedSecret secret, const SecureIdentity& own, Run run)
    : secret_(std::move(secret)), own_(own), run_(std::move(run)) {}

// --- sending

std::size_t SecureSession::seal(std::span<const std::byte> plain, std::span<std::byte> into) {
    if (!current_) {
        ++counts_.not_yet;
        return 0;
    }
    return plain.empty() ? 0 : seal_with(*current_, plain, into);
}

std::size_t SecureSession::seal_with(Session& session, std::span<const std::byte> plain,
                                     std::span<std::byte> into) {
    if (plain.size() + overhead > into.size()) {
        return 0;
    }
    write_front(into, packet);
    const std::uint64_t counter = ++session.counter;
    std::memcpy(&into[session_at], &session.keys.id, sizeof session.keys.id);
    std::memcpy(&into[counter_at], &counter, sizeof counter);
    unsigned long long written = 0;
    crypto_aead_chacha20poly1305_ietf_encrypt(raw(into.data()) + ciphertext_at, &written, raw(plain.data()),
                                              plain.size(), raw(into.data()), ciphertext_at, nullptr,
                                              nonce_of(counter).data(), session.keys.send.data());
    return ciphertext_at + written;
}

std::size_t SecureSession::greet(std::uint64_t whom, std::span<std::byte> into) const {
    if (into.size() < greeting_bytes) {
        return 0;
    }
    write_front(into, greeting);
    std::memcpy(&into[sender_at], &own_.start, 8);
    std::memcpy(&into[receiver_at], &whom, 8);
    std::memcpy(&into[salt_at], own_.salt.data(), own_.salt.size());
    std::memcpy(&into[public_key_at], own_.public_key.data(), own_.public_key.size());
    return greeting_bytes;
}

std::size_t SecureSession::due(std::span<std::byte> into, Nanoseconds now) {
    if (!started_) {
        started_ = true;
        next_greeting_ = next_answer_ = next_confirmation_ = next_making_ = now;
    }
    take_keys();
    if (answer_to_ != nobody && now >= next_answer_) {
        next_answer_ = now + answer_every;
        answers_known_ = false;
        return greet(std::exchange(answer_to_, nobody), into);
    }
    if (!lives(now) && now >= next_greeting_) {
        next_greeting_ = now + greet_every;
        return greet(seen_, into);
    }
    if (confirm_ && current_) {
        confirm_ = false;
        return seal_with(*current_, {}, into);
    }
    if (next_ && now >= next_confirmation_) {
        next_confirmation_ = now + greet_every;
        return seal_with(*next_, {}, into);
    }
    return 0;
}

// --- receiving

bool SecureSession::lives(Nanoseconds now) const {
    return current_ && now - opened_at_ < silent_after;
}

Admission SecureSession::admission(Nanoseconds now) const {
    Admission admission;
    admission.own_start = own_.start;
    for (const std::optional<Session>* const session : {&current_, &next_}) {
        if (*session) {
            admission.sessions[admission.session_count++] = (*session)->keys.id;
        }
    }
    admission.strangers = !lives(now) && now >= strangers_again_;
    return admission;
}

bool SecureSession::concerns(std::span<const std::byte> datagram, Nanoseconds now) {
    if (!has_front(datagram)) {
        ++counts_.not_sealed;
        return false;
    }
    take_keys();
    if (datagram[3] == std::byte{greeting}) {
        return hears(datagram, now);
    }
    const Session* const session = session_of(datagram);
    if (session == nullptr) {
        ++counts_.other_start;
        return false;
    }
    const auto counter = read_at<std::uint64_t>(datagram, counter_at);
    if (counter == 0 || counter > plausible::max_sequence || session->window.has_come(counter)) {
        ++counts_.replayed;
        return false;
    }
    return true;
}

// Who names this start has heard this side. Anybody else may be nobody at all: while a session lives none of
// them is wanted, and else they are kept from crowding out the one that is.
bool SecureSession::hears(std::span<const std::byte> greeting, Nanoseconds now) {
    if (greeting.size() != greeting_bytes) {
        ++counts_.not_sealed;
        return false;
    }
    if (read_at<std::uint64_t>(greeting, receiver_at) == own_.start) {
        return true;
    }
    if (!lives(now) && now >= strangers_again_) {
        if (strangers_.pass(now)) {
            return true;
        }
        strangers_again_ = now + deaf_for;
    }
    ++counts_.unheard;
    return false;
}

SecureSession::Session* SecureSession::session_of(std::span<const std::byte> datagram) {
    const auto id = read_at<std::uint32_t>(datagram, session_at);
    for (std::optional<Session>* const session : {&current_, &next_}) {
        if (*session && (*session)->keys.id == id) {
            return &**session;
        }
    }
    return nullptr;
}

std::size_t SecureSession::take(std::span<const std::byte> datagram, std::span<std::byte> into,
                                Nanoseconds now) {
    if (datagram[3] == std::byte{greeting}) {
        take_greeting(datagram, now);
        return 0;
    }
    Session& session = *session_of(datagram);
    const std::uint64_t before = counts_.opened;
    const std::size_t size = open_with(session, datagram, into);
    if (counts_.opened > before) {
        if (next_ && &session == &*next_) {
            believe_next();
        }
        opened_at_ = now;
    }
    return size;
}

std::size_t SecureSession::open_with(Session& session, std::span<const std::byte> datagram,
                                     std::span<std::byte> into) {
    unsigned long long plain = 0;
    const auto counter = read_at<std::uint64_t>(datagram, counter_at);
    if (datagram.size() - overhead > into.size() ||
        crypto_aead_chacha20poly1305_ietf_decrypt(
            raw(into.data()), &plain, nullptr, raw(datagram.data()) + ciphertext_at,
            datagram.size() - ciphertext_at, raw(datagram.data()), ciphertext_at, nonce_of(counter).data(),
            session.keys.receive.data()) != 0) {
        ++counts_.wrong_key;
        return 0;
    }
    session.window.note(counter);
    ++counts_.opened;
    return static_cast<std::size_t>(plain);
}

void SecureSession::believe_next() {
    if (current_ && past_count_ < max_past) {
        past_[past_count_++] = current_->start;
    }
    current_ = std::exchange(next_, std::nullopt);
    confirm_ = true;
}

bool SecureSession::is_past(std::uint64_t start) const {
    const auto end = past_.begin() + static_cast<std::ptrdiff_t>(past_count_);
    return std::find(past_.begin(), end, start) != end;
}

// It may be a recording: an answer is all that it gets. Only who names this very start has heard it.
void SecureSession::take_greeting(std::span<const std::byte> datagram, Nanoseconds now) {
    SecurePeer peer;
    peer.start = read_at<std::uint64_t>(datagram, sender_at);
    const auto receiver = read_at<std::uint64_t>(datagram, receiver_at);
    const bool known = current_ && current_->start == peer.start;
    if (peer.start == nobody || peer.start == own_.start || is_past(peer.start) || past_count_ == max_past) {
        ++counts_.other_start;
        return;
    }
    if (known) {
        return;  // it was on its way when the two met
    }
    const bool knows_this = receiver == own_.start;
    if (knows_this || !answers_known_) {
        seen_ = answer_to_ = peer.start;
        answers_known_ = knows_this;
    }
    if (knows_this) {
        peer.salt = read_at<decltype(peer.salt)>(datagram, salt_at);
        peer.public_key = read_at<decltype(peer.public_key)>(datagram, public_key_at);
        make_keys(peer, now);
    }
}

void SecureSession::make_keys(const SecurePeer& peer, Nanoseconds now) {
    if (making_ || now < next_making_ || (next_ && next_->start == peer.start)) {
        return;
    }
    next_making_ = now + make_every;
    ++counts_.keys_made;
    making_ = std::make_shared<Making>();
    making_->start = peer.start;
    run_([secret = secret_, own = own_, peer, making = making_] {
        making->keys = session_keys(secret, own, peer);
        making->done.store(true, std::memory_order_release);
    });
}

void SecureSession::take_keys() {
    if (!making_ || !making_->done.load(std::memory_order_acquire)) {
        return;
    }
    if (making_->keys) {
        next_ = Session{making_->start, *making_->keys, 0, {}};
        next_confirmation_ = 0;
    }
    making_.reset();
}

}  // namespace tactus
