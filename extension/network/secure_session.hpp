// A conversation under a secret that both sides know beforehand: what passes can neither be read nor altered,
// nor played again later, not even from before a restart, and a secret that becomes known later opens no
// recording.
//
// Each start of a side has a number, a salt and a key pair (X25519), all drawn at random. The two tell each
// other these; keys for each direction come from the exchange of the pairs and from the secret, which is
// stretched with both salts. Packets are sealed with ChaCha20-Poly1305 and counted. Whoever seals a packet
// that opens knows the secret and this very start: then, and only then, it is believed
// (docs/wire_format.md, "Sealed packets").
//
// Nothing costly is done for a stranger: what names a session that there is not is dropped unopened; keys are
// made only for who has heard this side's present start, one at a time, elsewhere; answers are few, and there
// are none while a session lives, which goes on until another one is believed. A side whose session is silent
// greets, so that a far side that has started anew need not be heard first.
//
// Belongs to the network thread. Allocates only when keys are to be made.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "core/math/types.hpp"
#include "core/ports/link.hpp"
#include "network/admission.hpp"
#include "network/rate_limit.hpp"
#include "network/sealed_format.hpp"
#include "network/sequence_window.hpp"
#include "network/shared_secret.hpp"

namespace tactus {

struct SecureCounts {
    std::uint64_t opened = 0;
    std::uint64_t not_sealed = 0;   // the far side uses no key, or another version
    std::uint64_t wrong_key = 0;    // sealed under another key, or altered on the way
    std::uint64_t replayed = 0;     // opened before, or too old to tell
    std::uint64_t other_start = 0;  // of another session, or of a start that is over
    std::uint64_t unheard = 0;      // greetings of strangers: a session lives, or they are too many
    std::uint64_t not_yet = 0;      // not sent: the far side has not been met
    std::uint64_t keys_made = 0;    // times that keys were made for a start of the far side
};

class SecureSession {
public:
    static constexpr std::size_t overhead = sealed_format::overhead;  // (unit: bytes) a packet

    // Does what it is given somewhere else, now or later.
    using Run = std::function<void(std::function<void()>)>;

    SecureSession(SharedSecret secret, const SecureIdentity& own, Run run);

    // The plain packet's bytes in `into`, which holds max_datagram_bytes; 0 where there is nothing for the
    // caller. `now`: any steady clock.
    std::size_t open(std::span<const std::byte> datagram, std::span<std::byte> into, Nanoseconds now) {
        return concerns(datagram, now) ? take(datagram, into, now) : 0;
    }

    // open() in two steps, for who has to see to the rate of what is opened. Whether it may be worth opening:
    // a greeting, or a packet of a session that there is and that has not come yet. Costs next to nothing;
    // what does not is counted. Greetings of strangers are let pass so often only: ask once for each
    // datagram.
    bool concerns(std::span<const std::byte> datagram, Nanoseconds now);
    std::size_t take(std::span<const std::byte> datagram, std::span<std::byte> into, Nanoseconds now);

    // What is worth asking concerns() about: changes now and then, a hundred times a second at most.
    Admission admission(Nanoseconds now) const;

    // The sealed packet's bytes; 0 where the far side has not been met, or it does not fit.
    std::size_t seal(std::span<const std::byte> plain, std::span<std::byte> into);

    // What the session itself has to say now; 0: nothing. Call it until then, a few times a millisecond.
    std::size_t due(std::span<std::byte> into, Nanoseconds now);

    // Whether a refusal of this number can be for this side: it is this start, and nobody talks with it.
    bool may_be_refused(std::uint64_t number, Nanoseconds now) const {
        return number == own_.start && !lives(now);
    }

    bool met() const { return current_.has_value(); }
    const SecureCounts& counts() const { return counts_; }

private:
    struct Session {
        std::uint64_t start = 0;  // of the far side
        SessionKeys keys;
        std::uint64_t counter = 0;
        SequenceWindow window;
    };
    // Keys that are being made. Shared with who does it.
    struct Making {
        std::uint64_t start = 0;
        std::optional<SessionKeys> keys;
        std::atomic<bool> done{false};
    };

    static constexpr Nanoseconds stranger_every = 200'000;  // no faster than that
    static constexpr std::int64_t max_strangers = 32;       // at once
    static constexpr std::size_t max_past = 256;  // restarts of the far side that one start of this side sees

    Session* session_of(std::span<const std::byte> datagram);
    bool lives(Nanoseconds now) const;
    bool hears(std::span<const std::byte> greeting, Nanoseconds now);
    void take_greeting(std::span<const std::byte> datagram, Nanoseconds now);
    void make_keys(const SecurePeer& peer, Nanoseconds now);
    void take_keys();
    std::size_t open_with(Session& session, std::span<const std::byte> datagram, std::span<std::byte> into);
    void believe_next();
    bool is_past(std::uint64_t start) const;
    std::size_t greet(std::uint64_t whom, std::span<std::byte> into) const;
    static std::size_t seal_with(Session& session, std::span<const std::byte> plain,
                                 std::span<std::byte> into);

    SharedSecret secret_;
    SecureIdentity own_;
    Run run_;
    std::optional<Session> current_;
    std::optional<Session> next_;  // its keys are made, nothing sealed with them has come yet
    std::shared_ptr<Making> making_;
    std::array<std::uint64_t, max_past> past_{};
    std::size_t past_count_ = 0;

    std::uint64_t answer_to_ = 0;  // a start that has greeted
    bool answers_known_ = false;   // it knows this one: no stranger comes before it
    std::uint64_t seen_ = 0;       // the start that greeted last
    bool confirm_ = false;         // so that the far side can believe this one at once
    RateLimit strangers_{stranger_every, max_strangers};
    Nanoseconds strangers_again_ = 0;  // when they are listened to again
    Nanoseconds opened_at_ = 0;        // a packet of the session, last
    Nanoseconds next_greeting_ = 0;
    Nanoseconds next_answer_ = 0;
    Nanoseconds next_confirmation_ = 0;
    Nanoseconds next_making_ = 0;
    bool started_ = false;
    SecureCounts counts_;
};

}  // namespace tactus
