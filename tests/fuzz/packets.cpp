// What comes over the wire: packets, descriptions, greetings and sealed packets of strangers, and whole
// conversations with a side that believes its peer.
#include <sodium.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "fuzz_target.hpp"
#include "network/discovery_receiver.hpp"
#include "network/doorman.hpp"
#include "network/endpoint.hpp"
#include "network/secure_session.hpp"
#include "shared/endpoints.hpp"
#include "shared/object_samples.hpp"
#include "shared/wire_samples.hpp"

namespace tactus::fuzz {
namespace {

enum Kind : std::uint8_t { packet, description, joint, stranger, sealed, conversation, count };

using Room = std::array<std::byte, max_datagram_bytes>;

// Whatever is believed can be said again, and says the same then.
void one_packet(std::span<const std::byte> bytes) {
    Packet read;
    if (decode(bytes, read) != Refusal::none) {
        return;
    }
    Room once{}, twice{};
    const std::size_t size = encode(read.header, read.message, once);
    must(size > 0, "what was read of a packet can be sent");
    Packet again;
    must(decode(std::span(once).first(size), again) == Refusal::none, "what was sent of it can be read");
    must(encode(again.header, again.message, twice) == size &&
             std::equal(once.begin(), once.begin() + size, twice.begin()),
         "a packet says the same the second time");
}

void one_description(std::span<const std::byte> bytes) {
    ObjectDescription read;
    if (decode_description(bytes, read) == Refusal::none) {
        must(std::ranges::equal(encode_description(read), bytes), "a description is read as it was written");
    }
}

void one_joint(std::span<const std::byte> bytes) {
    ObjectJoint read;
    if (decode_joint(bytes, read) == Refusal::none) {
        must(std::ranges::equal(encode_joint(read), bytes), "a joint is read as it was written");
    }
}

// --- who has no key

const SharedSecret& secret() {
    static const SharedSecret known{SecretKey{1, 2, 3}, {}};
    return known;
}

// The same in every process, so that an input means the same.
SecureIdentity identity(std::uint8_t number) {
    SecureIdentity own{number, {number}, {}, {number}};
    crypto_scalarmult_curve25519_base(own.public_key.data(), own.private_key.data());
    return own;
}

// Two sides that have met under a secret: how they stand then is where every input begins.
struct Met {
    Met() {
        const auto at_once = [](std::function<void()> job) { job(); };
        near.emplace(secret(), identity(1), at_once);
        far.emplace(secret(), identity(2), at_once);
        for (now = 0; !(near->met() && far->met()); now += 1'000'000) {
            pass(*near, *far);
            pass(*far, *near);
        }
    }
    void pass(SecureSession& from, SecureSession& to) {
        Room bytes, into;
        while (const std::size_t size = from.due(bytes, now)) {
            to.open(std::span(bytes).first(size), into, now);
        }
    }
    std::optional<SecureSession> near, far;
    Nanoseconds now = 0;
};

// Nothing that a stranger makes opens, be it to somebody who talks with another or to somebody who waits.
// Keys are made elsewhere, and not here: that takes longer than all the rest.
void by_a_stranger(std::span<const std::byte> bytes) {
    static const Met met;
    number_of_knock(bytes);
    number_of_refusal(bytes);
    Room into;
    SecureSession talks = *met.near;
    must(talks.open(bytes, into, met.now) == 0, "no stranger's packet opens");
    SecureSession waits(secret(), identity(7), [](std::function<void()>) {});
    must(waits.open(bytes, into, met.now) == 0, "no stranger's packet opens where nobody has been met");
    while (waits.due(into, met.now) > 0) {
    }
}

// A packet of the far side's, and what somebody on the way makes of it: it opens as it was, once, or not at
// all.
void sealed_packet(Numbers numbers) {
    static const Met met;
    SecureSession near = *met.near, far = *met.far;
    Room bytes{}, into{};
    const std::size_t length = 1 + numbers.below(max_message_bytes);
    const Bytes plain(length, static_cast<std::byte>(numbers.byte()));
    std::size_t size = far.seal(plain, bytes);
    must(size == length + SecureSession::overhead, "a packet that fits is sealed");
    const Room sealed = bytes;
    for (int hits = numbers.byte() % 8; hits > 0; --hits) {
        bytes[numbers.below(size)] ^= static_cast<std::byte>(numbers.byte());
    }
    if (numbers.flag()) {
        size = numbers.below(max_datagram_bytes + 1);
    }
    const bool whole = size == length + SecureSession::overhead && bytes == sealed;
    const std::size_t opened = near.open(std::span(bytes).first(size), into, met.now);
    must(opened == (whole ? length : 0) &&
             (opened == 0 || std::equal(plain.begin(), plain.end(), into.begin())),
         "what was altered does not open, what was not does");
    must(near.open(std::span(bytes).first(size), into, met.now) == 0, "nothing opens twice");
}

// --- a peer that is believed

class Wire final : public Link {
public:
    bool send(std::span<const std::byte>, Nanoseconds) override { return true; }
    ReceivedDatagram receive(std::span<std::byte> into, Nanoseconds now) override {
        if (size_ == 0 || size_ > into.size()) {
            return {};
        }
        std::copy_n(bytes_.begin(), size_, into.begin());
        return {std::exchange(size_, 0), now};
    }
    void put(std::span<const std::byte> bytes) {
        size_ = std::min(bytes.size(), bytes_.size());
        std::copy_n(bytes.begin(), size_, bytes_.begin());
    }

private:
    Room bytes_{};
    std::size_t size_ = 0;
};

constexpr std::uint64_t own_epoch = 11, peer_epoch = 22;

// A front that gets it past the first checks: what stands behind it is what is looked for.
Bytes with_front(std::span<const std::byte> bytes, std::uint64_t sequence) {
    Room front{};
    const std::size_t size = encode({peer_epoch, sequence, 0}, Bye{}, front);
    Bytes whole(front.begin(), front.begin() + static_cast<std::ptrdiff_t>(size));
    whole[3] = bytes.empty() ? std::byte{} : bytes[0];
    whole.insert(whole.end(), bytes.empty() ? bytes.end() : bytes.begin() + 1, bytes.end());
    return whole;
}

void say_hello(Wire& wire, std::uint64_t sequence) {
    Hello hello;
    hello.side = Side::teleoperator_side;
    hello.heard_epoch = own_epoch;
    Room bytes{};
    wire.put(std::span(bytes).first(encode({peer_epoch, sequence, 0}, hello, bytes)));
}

void take_all(Endpoint& endpoint, DiscoveryReceiver& objects) {
    while (const Endpoint::Received* const received = endpoint.receive()) {
        if (const auto* const fragment = std::get_if<DiscoveryFragment>(&received->packet.message)) {
            objects.put(*fragment);
        } else if (const auto* const removal = std::get_if<ObjectRemoval>(&received->packet.message)) {
            objects.put(*removal);
        }
    }
    while (const std::optional<DiscoveryEvent> event = objects.next()) {
        if (event->kind == DiscoveryEvent::Kind::described) {
            objects.answer(event->object, DiscoveryVerdict::known);
        }
    }
    for (DiscoveryAcknowledgement told; objects.next_acknowledgement(told);) {
        endpoint.send(told);
    }
}

void talk(Numbers numbers) {
    static const std::vector<Message> own = samples::one_of_each();
    Wire wire;
    Endpoint endpoint(wire, shared::endpoint(Side::operator_side, own_epoch));
    DiscoverySettings room;
    room.pieces_waiting = 16;
    DiscoveryReceiver objects(room);
    std::uint64_t sequence = 0, told = 0;
    Nanoseconds now = 0;
    say_hello(wire, ++sequence);
    for (int packets = 0; packets < 24 && !numbers.is_over(); ++packets) {
        const std::uint8_t how = numbers.byte();
        now += how < 0xf0 ? 1'000'000 * (how % 4) : numbers.integer<std::uint32_t>();
        endpoint.begin_tick(now);
        take_all(endpoint, objects);
        const std::span<const std::byte> bytes = numbers.bytes(numbers.below(max_datagram_bytes + 8));
        ++told;
        wire.put((how & 4u) != 0 ? std::span<const std::byte>(with_front(bytes, ++sequence)) : bytes);
        take_all(endpoint, objects);
        endpoint.send(own[how % own.size()]);
        endpoint.end_tick();
    }
    const LinkStatistics& statistics = endpoint.statistics();
    must(statistics.packets_received <= told + 1, "no more is believed than has come");
    must(std::isfinite(statistics.lost_there) && std::isfinite(statistics.one_way_delay) &&
             std::isfinite(statistics.one_way_jitter),
         "what is told of a link is a number");
}

}  // namespace

void play(std::span<const std::byte> input) {
    Numbers numbers(input);
    switch (numbers.byte() % Kind::count) {
        case packet:
            return one_packet(numbers.rest());
        case description:
            return one_description(numbers.rest());
        case joint:
            return one_joint(numbers.rest());
        case stranger:
            return by_a_stranger(numbers.rest());
        case sealed:
            return sealed_packet(numbers);
        default:
            return talk(numbers);
    }
}

std::vector<Bytes> seeds() {
    std::vector<Bytes> all;
    const auto add = [&all](Kind kind, std::span<const std::byte> bytes) {
        all.push_back(of_kind(kind, bytes));
    };
    Bytes conversation_of_all{std::byte{Kind::conversation}};
    for (const Message& message : samples::one_of_each()) {
        Room bytes{};
        const std::span<const std::byte> one =
            std::span(bytes).first(encode(samples::header, message, bytes));
        add(packet, one);
        add(stranger, one);
        // The kind and what follows the header: that of a packet from the peer.
        Room bare{};
        const std::size_t front = encode({peer_epoch, 1, 0}, Bye{}, bare);
        const std::size_t size = encode({peer_epoch, 1, 0}, message, bytes);
        const std::size_t length = 1 + size - front;
        const Bytes how{std::byte{5}, static_cast<std::byte>(length), static_cast<std::byte>(length >> 8),
                        bytes[3]};
        conversation_of_all.insert(conversation_of_all.end(), how.begin(), how.end());
        conversation_of_all.insert(conversation_of_all.end(),
                                   bytes.begin() + static_cast<std::ptrdiff_t>(front),
                                   bytes.begin() + static_cast<std::ptrdiff_t>(size));
    }
    all.push_back(std::move(conversation_of_all));
    add(description, encode_description(samples::object_of_all_shapes(5)));
    add(description, encode_description(samples::object_of_size(6, 8)));
    ObjectJoint hinge{first_joint + 1, 1, no_object, {}};
    hinge.joint.kind = JointKind::Hinge;
    hinge.joint.second_frame = Pose{};
    add(joint, encode_joint(hinge));
    const Met met;
    SecureSession near = *met.near;
    Room bytes{};
    add(stranger, std::span(bytes).first(near.seal(Bytes(40, std::byte{9}), bytes)));
    SecureSession waits(secret(), identity(7), [](std::function<void()>) {});
    add(stranger, std::span(bytes).first(waits.due(bytes, 0)));
    add(stranger, refusal_of(7, sealed_format::expects_another));
    add(sealed, Bytes{std::byte{40}, std::byte{0}, std::byte{9}, std::byte{1}, std::byte{20}, std::byte{0},
                      std::byte{1}});
    return all;
}

}  // namespace tactus::fuzz
