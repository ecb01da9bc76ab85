// Under a key: what was not sealed for this start by the other side is not believed, whoever recorded it.
#include "network/secure_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <string>

#include "network/memory_link.hpp"
#include "published_vectors.hpp"
#include "shared/random_values.hpp"
#include "support/realtime_audit.hpp"

namespace tactus {
namespace {

constexpr Nanoseconds ms = 1'000'000;
using Bytes = std::vector<std::byte>;

// Passes on to another link and keeps a copy of everything that was sent.
class Recorder final : public Link {
public:
    explicit Recorder(Link& inner) : inner_(inner) {}
    bool send(std::span<const std::byte> datagram, Nanoseconds now) override {
        sent.emplace_back(datagram.begin(), datagram.end());
        return inner_.send(datagram, now);
    }
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override {
        return inner_.receive(into, now);
    }
    std::vector<Bytes> sent;

private:
    Link& inner_;
};

struct SecureRig {
    static SecretKey key(std::uint8_t seed) {
        SecretKey key;
        for (std::size_t i = 0; i < key.size(); ++i) {
            key[i] = static_cast<std::uint8_t>(seed + i);
        }
        return key;
    }

    SecureRig() { start(near, near_wire, 1), start(far, far_wire, 2); }

    static void start(std::unique_ptr<SecureLink>& side, Link& wire, std::uint64_t number,
                      std::uint8_t seed = 1) {
        side = std::make_unique<SecureLink>(wire, key(seed), number);
    }

    // Appends the first byte of each datagram that arrives at a side.
    static void drain(SecureLink& side, Nanoseconds now, std::vector<int>& into) {
        std::array<std::byte, most_datagram_bytes> buffer;
        while (const ReceivedDatagram received = side.receive(buffer, now)) {
            into.push_back(std::to_integer<int>(buffer[0]));
        }
    }

    void run(Nanoseconds span) {
        for (const Nanoseconds end = now + span; now < end; now += ms) {
            drain(*near, now, near_heard);
            drain(*far, now, far_heard);
        }
    }

    MemoryLinkPair pair{4096};
    Recorder near_wire{pair.first()};
    Recorder far_wire{pair.second()};
    std::unique_ptr<SecureLink> near, far;
    std::vector<int> near_heard, far_heard;
    Nanoseconds now = 0;
};

Bytes one(int value, std::size_t size = 10) {
    return Bytes(size, static_cast<std::byte>(value));
}

TEST(SecureLink, TheTwoMeetAndTalk) {
    SecureRig rig;
    EXPECT_FALSE(rig.near->send(one(1), 0));
    EXPECT_EQ(rig.near->counts().not_yet, 1u);
    rig.run(5 * ms);
    ASSERT_TRUE(rig.near->met());
    ASSERT_TRUE(rig.far->met());
    for (int i = 0; i < 100; ++i) {
        EXPECT_TRUE(rig.near->send(one(i), rig.now));
        EXPECT_TRUE(rig.far->send(one(100 + i), rig.now));
        rig.run(ms);
    }
    ASSERT_EQ(rig.far_heard.size(), 100u);
    ASSERT_EQ(rig.near_heard.size(), 100u);
    EXPECT_EQ(rig.far_heard[50], 50);
    EXPECT_EQ(rig.near_heard[50], 150);
}

TEST(SecureLink, TheLongestMessageFits) {
    SecureRig rig;
    rig.run(5 * ms);
    EXPECT_TRUE(rig.near->send(one(1, most_message_bytes), rig.now));
    EXPECT_FALSE(rig.near->send(one(1, most_datagram_bytes - SecureLink::overhead + 1), rig.now));
    EXPECT_FALSE(rig.near->send({}, rig.now));
    rig.run(ms);
    EXPECT_EQ(rig.far_heard.size(), 1u);
}

TEST(SecureLink, NothingOfTheMessageIsToBeSeen) {
    SecureRig rig;
    rig.run(5 * ms);
    const Bytes secret(64, std::byte{0x5a});
    rig.near->send(secret, rig.now);
    const Bytes& sealed = rig.near_wire.sent.back();
    EXPECT_EQ(sealed.size(), secret.size() + SecureLink::overhead);
    EXPECT_EQ(std::search(sealed.begin(), sealed.end(), secret.begin(), secret.begin() + 4), sealed.end());
}

TEST(SecureLink, NoNonceComesTwice) {
    SecureRig rig;
    rig.run(5 * ms);
    for (int i = 0; i < 500; ++i) {
        rig.near->send(one(i), rig.now);
        rig.far->send(one(i), rig.now);
        rig.run(ms);
    }
    SecureRig::start(rig.far, rig.far_wire, 3);
    rig.run(300 * ms);
    for (int i = 0; i < 500; ++i) {
        rig.near->send(one(i), rig.now);
        rig.far->send(one(i), rig.now);
        rig.run(ms);
    }
    std::map<std::string, int> nonces;
    for (const Recorder* wire : {&rig.near_wire, &rig.far_wire}) {
        for (const Bytes& datagram : wire->sent) {
            EXPECT_EQ(++nonces[std::string(reinterpret_cast<const char*>(datagram.data()) + 4, 24)], 1);
        }
    }
    EXPECT_GT(nonces.size(), 2000u);
}

TEST(SecureLink, AnotherKeyIsNotUnderstood) {
    SecureRig rig;
    SecureRig::start(rig.far, rig.far_wire, 2, 99);
    rig.run(1000 * ms);
    EXPECT_FALSE(rig.near->met());
    EXPECT_FALSE(rig.far->met());
    EXPECT_GE(rig.near->counts().wrong_key, 9u);
}

TEST(SecureLink, AnAlteredDatagramIsDropped) {
    SecureRig rig;
    rig.run(5 * ms);
    rig.near->send(one(7), rig.now);
    const Bytes good = rig.near_wire.sent.back();
    rig.run(2 * ms);
    rig.far_heard.clear();
    const std::uint64_t before = rig.far->counts().wrong_key;
    for (std::size_t at = 0; at < good.size(); ++at) {
        Bytes damaged = good;
        damaged[at] ^= std::byte{0x10};
        rig.pair.first().send(damaged, rig.now);
    }
    for (std::size_t size = 1; size < good.size(); ++size) {
        rig.pair.first().send(std::span(good).first(size), rig.now);
    }
    rig.run(10 * ms);
    EXPECT_TRUE(rig.far_heard.empty());
    EXPECT_GT(rig.far->counts().wrong_key, before);
}

TEST(SecureLink, APlainDatagramIsDropped) {
    SecureRig rig;
    rig.run(5 * ms);
    rig.pair.first().send(one(1, 100), rig.now);
    rig.run(2 * ms);
    EXPECT_TRUE(rig.far_heard.empty());
    EXPECT_EQ(rig.far->counts().not_sealed, 1u);
}

TEST(SecureLink, ARecordingIsOpenedOnlyOnce) {
    SecureRig rig;
    rig.run(5 * ms);
    for (int i = 0; i < 50; ++i) {
        rig.near->send(one(i), rig.now);
    }
    rig.run(2 * ms);
    ASSERT_EQ(rig.far_heard.size(), 50u);
    for (const Bytes& datagram : std::vector<Bytes>(rig.near_wire.sent)) {
        rig.pair.first().send(datagram, rig.now);
    }
    rig.run(10 * ms);
    EXPECT_EQ(rig.far_heard.size(), 50u);
    EXPECT_GE(rig.far->counts().replayed, 50u);
}

TEST(SecureLink, DisorderIsNoReplay) {
    SecureRig rig;
    rig.run(5 * ms);
    std::vector<Bytes> held;
    for (int i = 0; i < 200; ++i) {
        rig.near->send(one(i), rig.now);
        held.push_back(rig.near_wire.sent.back());
    }
    std::array<std::byte, most_datagram_bytes> buffer;
    while (rig.pair.second().receive(buffer, rig.now)) {
    }
    for (auto it = held.rbegin(); it != held.rend(); ++it) {
        rig.pair.first().send(*it, rig.now);
    }
    rig.run(10 * ms);
    EXPECT_EQ(rig.far_heard.size(), 200u);
}

TEST(SecureLink, AReflectionIsDropped) {
    SecureRig rig;
    rig.run(5 * ms);
    rig.near->send(one(1), rig.now);
    rig.pair.second().send(rig.near_wire.sent.back(), rig.now);
    rig.run(2 * ms);
    EXPECT_TRUE(rig.near_heard.empty());
    EXPECT_GE(rig.near->counts().other_start, 1u);
}

TEST(SecureLink, ARestartIsMetAgain) {
    SecureRig rig;
    rig.run(5 * ms);
    for (std::uint64_t start = 10; start < 15; ++start) {
        SecureRig::start(rig.far, rig.far_wire, start);
        rig.run(150 * ms);
        rig.far_heard.clear();
        rig.near_heard.clear();
        EXPECT_TRUE(rig.near->send(one(3), rig.now));
        EXPECT_TRUE(rig.far->send(one(4), rig.now));
        rig.run(2 * ms);
        EXPECT_EQ(rig.far_heard.size(), 1u);
        EXPECT_EQ(rig.near_heard.size(), 1u);
    }
}

// Everything that an earlier start of the far side ever sent, played to a later start of this side and to
// the same one.
TEST(SecureLink, ARecordingOfAnEarlierStartIsWorthNothing) {
    SecureRig rig;
    rig.run(5 * ms);
    for (int i = 0; i < 20; ++i) {
        rig.far->send(one(i), rig.now);
    }
    rig.run(5 * ms);
    const std::vector<Bytes> recorded = rig.far_wire.sent;
    const auto play = [&] {
        rig.near_heard.clear();
        for (const Bytes& datagram : recorded) {
            rig.pair.second().send(datagram, rig.now);
        }
        rig.run(50 * ms);
        EXPECT_TRUE(rig.near_heard.empty());
    };
    SecureRig::start(rig.far, rig.far_wire, 30);
    rig.run(300 * ms);
    play();
    SecureRig::start(rig.near, rig.near_wire, 31);
    play();
    rig.run(300 * ms);
    EXPECT_TRUE(rig.near->met());
    play();
    rig.far_heard.clear();
    rig.near->send(one(9), rig.now);
    rig.run(2 * ms);
    EXPECT_EQ(rig.far_heard.size(), 1u) << "the two still hear each other";
}

TEST(SecureLink, NoiseIsDropped) {
    SecureRig rig;
    rig.run(5 * ms);
    shared::RandomValues random(3);
    for (int i = 0; i < 3000; ++i) {
        Bytes noise(static_cast<std::size_t>(1 + random.below(static_cast<int>(most_datagram_bytes))));
        for (std::byte& byte : noise) {
            byte = static_cast<std::byte>(random.below(256));
        }
        if (i % 2 == 0) {
            std::memcpy(noise.data(), "TS\1\0", std::min<std::size_t>(noise.size(), 4));
        }
        rig.pair.first().send(noise, rig.now);
    }
    rig.run(100 * ms);
    EXPECT_TRUE(rig.far_heard.empty());
    EXPECT_TRUE(rig.far->met());
}

TEST(SecureLink, ATickAllocatesLocksAndAsksForNothing) {
    SecureRig rig;
    MemoryLinkPair pair;
    SecureLink near(pair.first(), SecureRig::key(1), 5);
    SecureLink far(pair.second(), SecureRig::key(1), 6);
    const Bytes message = one(1, 200);
    std::array<std::byte, most_datagram_bytes> buffer;
    testing::AuditScope audit;
    for (Nanoseconds now = 0; now < 500 * ms; now += ms) {
        near.send(message, now);
        while (far.receive(buffer, now)) {
        }
        far.send(message, now);
        while (near.receive(buffer, now)) {
        }
    }
    audit.finish();
    EXPECT_EQ(audit.allocations() + audit.frees() + audit.locks() + audit.waits() + audit.system_calls(), 0u)
        << audit.describe();
    EXPECT_GT(near.counts().opened, 490u);
}

TEST(SecretKey, IsReadFromHexadecimalDigitsOrStretched) {
    std::string digits;
    for (int i = 0; i < 32; ++i) {
        digits += i % 2 == 0 ? "0f" : "F0";
    }
    const auto key = secret_key(digits);
    ASSERT_TRUE(key);
    EXPECT_EQ((*key)[0], 0x0f);
    EXPECT_EQ((*key)[31], 0xf0);
    EXPECT_FALSE(secret_key("short"));
    EXPECT_FALSE(secret_key(""));
    const auto passphrase = secret_key("correct horse battery");
    ASSERT_TRUE(passphrase);
    EXPECT_EQ(passphrase, secret_key("correct horse battery"));
    EXPECT_NE(passphrase, secret_key("correct horse batterz"));
}

// The sealed packet of the published vectors: tests/tools opens it without libsodium.
TEST(SecureLink, SealsAsThePublishedVectorsSay) {
    MemoryLinkPair pair;
    Recorder wire(pair.first());
    SecureLink near(wire, SecureRig::key(1), 0x1111111111111111u);
    SecureLink far(pair.second(), SecureRig::key(1), 0x2222222222222222u);
    std::array<std::byte, most_datagram_bytes> buffer;
    for (Nanoseconds now = 0; now < 5 * ms; now += ms) {
        near.receive(buffer, now);
        far.receive(buffer, now);
    }
    ASSERT_TRUE(
        near.send(Bytes{std::byte{'t'}, std::byte{'o'}, std::byte{'u'}, std::byte{'c'}, std::byte{'h'}}, 0));
    EXPECT_EQ(samples::hex(wire.sent.back()), samples::published_vectors().at("sealed"));
}

}  // namespace
}  // namespace tactus
