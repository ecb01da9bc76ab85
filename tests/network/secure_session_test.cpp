// Under a secret: what was not sealed for this start by the other side is not believed, whoever recorded it.
#include "network/secure_session.hpp"

#include <gtest/gtest.h>
#include <sodium.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <string>

#include "network/messages.hpp"
#include "network/sealed_format.hpp"
#include "published_vectors.hpp"
#include "shared/random_values.hpp"
#include "support/realtime_audit.hpp"

namespace tactus::secure_session_test {
namespace {

constexpr Nanoseconds ms = 1'000'000;
using Bytes = std::vector<std::byte>;

SharedSecret secret(std::uint8_t seed) {
    SecretKey key;
    for (std::size_t i = 0; i < key.size(); ++i) {
        key[i] = static_cast<std::uint8_t>(seed + i);
    }
    return {key, {}};
}

Bytes one(int value, std::size_t size = 10) {
    return Bytes(size, static_cast<std::byte>(value));
}

// Two sides and the wires between them, which keep a copy of all that was sent.
struct SecureRig {
    struct Side {
        std::unique_ptr<SecureSession> session;
        std::deque<Bytes> inbox;
        std::vector<Bytes> sent;
        std::vector<int> heard;  // the first byte of each packet
    };

    SecureRig() {
        start(near);
        start(far);
    }

    void start(Side& side, std::uint8_t seed = 1) {
        side.session = std::make_unique<SecureSession>(
            secret(seed), random_identity(),
            [this](std::function<void()> job) { slow ? jobs.push_back(std::move(job)) : job(); });
    }
    Side& other(Side& side) { return &side == &near ? far : near; }

    void transmit(Side& from, std::span<const std::byte> bytes) {
        from.sent.emplace_back(bytes.begin(), bytes.end());
        other(from).inbox.emplace_back(bytes.begin(), bytes.end());
    }
    bool say(Side& from, const Bytes& plain) {
        std::array<std::byte, max_datagram_bytes> sealed;
        const std::size_t size = from.session->seal(plain, sealed);
        if (size > 0) {
            transmit(from, std::span(sealed).first(size));
        }
        return size > 0;
    }
    void tick(Side& side) {
        std::array<std::byte, max_datagram_bytes> buffer;
        while (!side.inbox.empty()) {
            const Bytes datagram = std::move(side.inbox.front());
            side.inbox.pop_front();
            if (side.session->open(datagram, buffer, now) > 0) {
                side.heard.push_back(std::to_integer<int>(buffer[0]));
            }
        }
        if (const std::size_t size = side.session->due(buffer, now); size > 0) {
            transmit(side, std::span(buffer).first(size));
        }
    }
    void run(Nanoseconds span) {
        for (const Nanoseconds end = now + span; now < end; now += ms) {
            tick(near);
            tick(far);
        }
    }
    void expect_talk() {
        near.heard.clear();
        far.heard.clear();
        EXPECT_TRUE(say(near, one(3)));
        EXPECT_TRUE(say(far, one(4)));
        run(2 * ms);
        EXPECT_EQ(far.heard, std::vector<int>{3});
        EXPECT_EQ(near.heard, std::vector<int>{4});
    }

    Side near, far;
    bool slow = false;  // keys are made only when the test says so
    std::deque<std::function<void()>> jobs;
    Nanoseconds now = 0;
};

TEST(SecureSession, TheTwoMeetAndTalk) {
    SecureRig rig;
    EXPECT_FALSE(rig.say(rig.near, one(1)));
    EXPECT_EQ(rig.near.session->counts().not_yet, 1u);
    rig.run(20 * ms);
    ASSERT_TRUE(rig.near.session->met());
    ASSERT_TRUE(rig.far.session->met());
    for (int i = 0; i < 100; ++i) {
        EXPECT_TRUE(rig.say(rig.near, one(i)));
        EXPECT_TRUE(rig.say(rig.far, one(100 + i)));
        rig.run(ms);
    }
    rig.run(2 * ms);
    ASSERT_EQ(rig.far.heard.size(), 100u);
    ASSERT_EQ(rig.near.heard.size(), 100u);
    EXPECT_EQ(rig.far.heard[50], 50);
    EXPECT_EQ(rig.near.heard[50], 150);
}

TEST(SecureSession, EachStartHasKeysOfItsOwn) {
    const SecureIdentity own = random_identity(), first = random_identity(), second = random_identity();
    const auto peer = [](const SecureIdentity& identity) {
        return SecurePeer{identity.start, identity.salt, identity.public_key};
    };
    const auto forth = session_keys(secret(1), own, peer(first));
    const auto back = session_keys(secret(1), first, peer(own));
    const auto later = session_keys(secret(1), own, peer(second));
    const auto another = session_keys(secret(2), own, peer(first));
    ASSERT_TRUE(forth && back && later && another);
    EXPECT_EQ(forth->send, back->receive);
    EXPECT_EQ(forth->receive, back->send);
    EXPECT_EQ(forth->id, back->id);
    EXPECT_NE(forth->send, forth->receive);
    EXPECT_NE(forth->send, later->send);
    EXPECT_NE(forth->send, another->send);
    SecurePeer none = peer(first);
    none.public_key = {};
    EXPECT_FALSE(session_keys(secret(1), own, none)) << "a key exchange with nobody";
}

TEST(SecureSession, TheLongestMessageFits) {
    SecureRig rig;
    rig.run(20 * ms);
    EXPECT_TRUE(rig.say(rig.near, one(1, max_message_bytes)));
    EXPECT_FALSE(rig.say(rig.near, one(1, max_datagram_bytes - SecureSession::overhead + 1)));
    EXPECT_FALSE(rig.say(rig.near, {}));
    rig.run(2 * ms);
    EXPECT_EQ(rig.far.heard.size(), 1u);
}

TEST(SecureSession, NothingOfTheMessageIsToBeSeen) {
    SecureRig rig;
    rig.run(20 * ms);
    const Bytes plain(64, std::byte{0x5a});
    rig.say(rig.near, plain);
    const Bytes& sealed = rig.near.sent.back();
    EXPECT_EQ(sealed.size(), plain.size() + SecureSession::overhead);
    EXPECT_EQ(std::search(sealed.begin(), sealed.end(), plain.begin(), plain.begin() + 4), sealed.end());
}

TEST(SecureSession, NoCounterComesTwiceUnderAKey) {
    SecureRig rig;
    std::map<std::string, int> fronts;
    for (int start = 0; start < 3; ++start) {
        rig.run(1200 * ms);
        for (int i = 0; i < 500; ++i) {
            rig.say(rig.near, one(i));
            rig.say(rig.far, one(i));
            rig.run(ms);
        }
        rig.start(rig.far);
    }
    for (const SecureRig::Side* side : {&rig.near, &rig.far}) {
        const std::string who = side == &rig.near ? "near" : "far";
        for (const Bytes& datagram : side->sent) {
            if (datagram[3] == std::byte{1}) {
                EXPECT_EQ(++fronts[who + std::string(reinterpret_cast<const char*>(&datagram[4]), 12)], 1);
            }
        }
    }
    EXPECT_GT(fronts.size(), 2500u);
}

TEST(SecureSession, AnotherSecretIsNotUnderstood) {
    SecureRig rig;
    rig.start(rig.far, 99);
    rig.run(1000 * ms);
    EXPECT_FALSE(rig.near.session->met());
    EXPECT_FALSE(rig.far.session->met());
    EXPECT_GE(rig.near.session->counts().wrong_key, 5u);
}

TEST(SecureSession, AnAlteredDatagramIsDropped) {
    SecureRig rig;
    rig.run(20 * ms);
    rig.say(rig.near, one(7));
    const Bytes good = rig.near.sent.back();
    rig.run(2 * ms);
    rig.far.heard.clear();
    Bytes fresh = good;  // not a replay: the counter is part of what is altered
    for (std::size_t at = 0; at < good.size(); ++at) {
        Bytes damaged = good;
        damaged[at] ^= std::byte{0x10};
        rig.transmit(rig.near, damaged);
    }
    for (std::size_t size = 1; size < good.size(); ++size) {
        rig.transmit(rig.near, std::span(good).first(size));
    }
    rig.run(10 * ms);
    EXPECT_TRUE(rig.far.heard.empty());
    EXPECT_GT(rig.far.session->counts().wrong_key, 0u);
    rig.expect_talk();
}

TEST(SecureSession, APlainDatagramIsDropped) {
    SecureRig rig;
    rig.run(20 * ms);
    rig.transmit(rig.near, one(1, 100));
    rig.run(2 * ms);
    EXPECT_TRUE(rig.far.heard.empty());
    EXPECT_EQ(rig.far.session->counts().not_sealed, 1u);
}

TEST(SecureSession, ARecordingIsOpenedOnlyOnce) {
    SecureRig rig;
    rig.run(20 * ms);
    for (int i = 0; i < 50; ++i) {
        rig.say(rig.near, one(i));
    }
    rig.run(2 * ms);
    ASSERT_EQ(rig.far.heard.size(), 50u);
    for (const Bytes& datagram : std::vector<Bytes>(rig.near.sent)) {
        rig.transmit(rig.near, datagram);
    }
    rig.run(10 * ms);
    EXPECT_EQ(rig.far.heard.size(), 50u);
    EXPECT_GE(rig.far.session->counts().replayed, 50u);
    rig.expect_talk();
}

TEST(SecureSession, DisorderIsNoReplay) {
    SecureRig rig;
    rig.run(20 * ms);
    rig.far.inbox.clear();
    for (int i = 0; i < 200; ++i) {
        rig.say(rig.near, one(i));
    }
    std::reverse(rig.far.inbox.begin(), rig.far.inbox.end());
    rig.run(10 * ms);
    EXPECT_EQ(rig.far.heard.size(), 200u);
}

TEST(SecureSession, AReflectionIsDropped) {
    SecureRig rig;
    rig.run(20 * ms);
    rig.say(rig.near, one(1));
    for (const Bytes& own : std::vector<Bytes>(rig.near.sent)) {
        rig.transmit(rig.far, own);
    }
    rig.run(5 * ms);
    EXPECT_TRUE(rig.near.heard.empty());
    rig.expect_talk();
}

TEST(SecureSession, ARestartIsMetAgain) {
    SecureRig rig;
    rig.run(20 * ms);
    for (int start = 0; start < 5; ++start) {
        rig.start(start % 2 == 0 ? rig.far : rig.near);
        rig.run(800 * ms);
        rig.expect_talk();
    }
}

// While keys are made for another start, and after that if it never seals anything, the session goes on.
TEST(SecureSession, WhoOnlyGreetsShutsNobodyOut) {
    SecureRig rig;
    rig.run(20 * ms);
    rig.slow = true;
    SecureRig::Side stranger;
    for (int i = 0; i < 300; ++i) {
        rig.start(stranger, 99);
        std::array<std::byte, max_datagram_bytes> buffer;
        // The stranger hears what near says and answers it: it knows near's start, and not the secret.
        for (const Bytes& heard : rig.near.sent) {
            stranger.session->open(heard, buffer, rig.now);
        }
        if (const std::size_t size = stranger.session->due(buffer, rig.now); size > 0) {
            rig.near.inbox.emplace_back(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(size));
        }
        rig.run(5 * ms);
        if (!rig.jobs.empty() && i % 10 == 0) {
            rig.jobs.front()();
            rig.jobs.pop_front();
        }
    }
    EXPECT_LE(rig.near.session->counts().keys_made, 5u) << "one at a time, and not too often";
    rig.expect_talk();
}

// Greetings as they could be: of the right form, from a start that there is not.
Bytes strangers_greeting(int number) {
    Bytes greeting(sealed_format::greeting_bytes, std::byte{0x21});
    std::memcpy(greeting.data(), "TS\2\0", 4);
    const std::uint64_t sender = 0x1000'0000u + static_cast<std::uint64_t>(number), nobody = 0;
    std::memcpy(&greeting[sealed_format::sender_at], &sender, sizeof sender);
    std::memcpy(&greeting[sealed_format::receiver_at], &nobody, sizeof nobody);
    return greeting;
}

TEST(SecureSession, ALivingSessionAnswersNoStranger) {
    SecureRig rig;
    rig.run(20 * ms);
    const std::size_t before = rig.near.sent.size();
    for (int i = 0; i < 1000; ++i) {
        rig.near.inbox.push_back(strangers_greeting(i));
        rig.say(rig.far, one(i));
        rig.run(ms);
    }
    EXPECT_EQ(rig.near.sent.size(), before);
    EXPECT_EQ(rig.near.session->counts().unheard, 1000u);
    EXPECT_FALSE(rig.near.session->admission(rig.now).strangers);
}

TEST(SecureSession, ARefusalConcernsOnlyWhoTalksWithNobody) {
    SecureRig rig;
    const std::uint64_t own = rig.near.session->admission(0).own_start;
    EXPECT_TRUE(rig.near.session->may_be_refused(own, rig.now));
    EXPECT_FALSE(rig.near.session->may_be_refused(own ^ 1, rig.now)) << "somebody else's";
    rig.run(20 * ms);
    rig.expect_talk();
    EXPECT_FALSE(rig.near.session->may_be_refused(own, rig.now));
}

// So many strangers that near hears next to none of them: what far says first is lost among them, but far
// hears near and can then call it by its name.
TEST(SecureSession, ManyStrangersDoNotKeepARestartAway) {
    SecureRig rig;
    rig.run(20 * ms);
    rig.start(rig.far);
    int number = 0;
    std::uint64_t answered = rig.near.sent.size();
    const Nanoseconds begin = rig.now;
    while (rig.now < begin + 2000 * ms && !rig.far.session->met()) {
        for (int i = 0; i < 200; ++i) {
            rig.near.inbox.push_front(strangers_greeting(++number));
        }
        rig.run(ms);
    }
    answered = rig.near.sent.size() - answered;
    EXPECT_LT(rig.now - begin, 1500 * ms);
    EXPECT_LT(answered, 200u) << "few answers, whatever comes";
    rig.run(200 * ms);
    EXPECT_GT(rig.near.session->counts().unheard, static_cast<std::uint64_t>(number / 2));
    rig.expect_talk();
}

// Everything that an earlier start of the far side ever sent, played to a later start of this side and to
// the same one.
TEST(SecureSession, ARecordingOfAnEarlierStartIsWorthNothing) {
    SecureRig rig;
    rig.run(20 * ms);
    for (int i = 0; i < 20; ++i) {
        rig.say(rig.far, one(i));
    }
    rig.run(5 * ms);
    const std::vector<Bytes> recorded = rig.far.sent;
    const auto play = [&] {
        rig.near.heard.clear();
        for (const Bytes& datagram : recorded) {
            rig.near.inbox.push_back(datagram);
        }
        rig.run(50 * ms);
        EXPECT_TRUE(rig.near.heard.empty());
    };
    rig.start(rig.far);
    rig.run(800 * ms);
    play();
    rig.start(rig.near);
    play();
    rig.run(1200 * ms);
    EXPECT_TRUE(rig.near.session->met());
    play();
    rig.expect_talk();
}

TEST(SecureSession, NoiseIsDropped) {
    SecureRig rig;
    rig.run(20 * ms);
    shared::RandomValues random(3);
    for (int i = 0; i < 3000; ++i) {
        Bytes noise(static_cast<std::size_t>(1 + random.below(static_cast<int>(max_datagram_bytes))));
        for (std::byte& byte : noise) {
            byte = static_cast<std::byte>(random.below(256));
        }
        if (i % 2 == 0) {
            std::memcpy(noise.data(), i % 4 == 0 ? "TS\2\0" : "TS\2\1",
                        std::min<std::size_t>(noise.size(), 4));
        }
        rig.transmit(rig.near, noise);
    }
    rig.run(100 * ms);
    EXPECT_TRUE(rig.far.heard.empty());
    rig.expect_talk();
}

TEST(SharedSecret, IsReadFromHexadecimalDigitsOrKeptAsWords) {
    std::string digits;
    for (int i = 0; i < 32; ++i) {
        digits += i % 2 == 0 ? "0f" : "F0";
    }
    const auto key = shared_secret(digits + "\n");
    ASSERT_TRUE(key && key->key);
    EXPECT_EQ((*key->key)[0], 0x0f);
    EXPECT_EQ((*key->key)[31], 0xf0);
    for (const char* bad : {"short", "", "  \n", "   seven77   "}) {
        EXPECT_FALSE(shared_secret(bad)) << bad;
    }
    EXPECT_EQ(shared_secret(" correct horse battery\n")->passphrase, "correct horse battery");
}

TEST(SharedSecret, APassphraseIsStretchedWithTheSaltsOfBoth) {
    const SharedSecret words = *shared_secret("correct horse battery");
    const SecureIdentity own = random_identity(), far = random_identity();
    const SecurePeer peer{far.start, far.salt, far.public_key};
    SecurePeer salted = peer;
    salted.salt[3] ^= 1;
    const auto keys = session_keys(words, own, peer);
    const auto back = session_keys(words, far, {own.start, own.salt, own.public_key});
    const auto others = session_keys(*shared_secret("correct horse batterz"), own, peer);
    const auto resalted = session_keys(words, own, salted);
    ASSERT_TRUE(keys && back && others && resalted);
    EXPECT_EQ(keys->send, back->receive);
    EXPECT_NE(keys->send, others->send);
    EXPECT_NE(keys->send, resalted->send);
}

// The identities of the published vectors: tests/tools makes the same keys and opens the packet without
// libsodium.
SecureIdentity published_identity(std::uint8_t seed) {
    SecureIdentity identity;
    identity.start = 0x1111111111111111u * seed;
    identity.salt.fill(static_cast<std::uint8_t>(0x50 + seed));
    std::array<std::uint8_t, 32> bytes;
    bytes.fill(seed);
    crypto_kx_seed_keypair(identity.public_key.data(), identity.private_key.data(), bytes.data());
    return identity;
}

TEST(SecureSession, SealsAsThePublishedVectorsSay) {
    const auto inline_run = [](std::function<void()> job) { job(); };
    SecureSession near(secret(1), published_identity(1), inline_run);
    SecureSession far(secret(1), published_identity(2), inline_run);
    std::array<std::byte, max_datagram_bytes> wire, plain;
    std::string greeting;
    for (Nanoseconds now = 0; now < 30 * ms; now += ms) {
        for (SecureSession* side : {&near, &far}) {
            if (const std::size_t size = side->due(wire, now); size > 0) {
                const auto bytes = std::span<const std::byte>(wire).first(size);
                greeting = side == &near && wire[3] == std::byte{0} ? samples::hex(bytes) : greeting;
                (side == &near ? far : near).open(bytes, plain, now);
            }
        }
    }
    ASSERT_TRUE(near.met() && far.met());
    std::size_t size = 0;
    for (const char letter : {'t', 'o', 'u', 'c', 'h'}) {
        size = near.seal(Bytes(3, static_cast<std::byte>(letter)), wire);
    }
    EXPECT_EQ(samples::published_vectors()["greeting"], greeting);
    EXPECT_EQ(samples::published_vectors()["sealed"], samples::hex(std::span(wire).first(size)));
    EXPECT_EQ(far.open(std::span(wire).first(size), plain, 0), 3u);
}

}  // namespace
}  // namespace tactus::secure_session_test
