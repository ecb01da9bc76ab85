#include "network/messages.hpp"

#include <cstring>
#include <numeric>
#include <type_traits>

#include "network/wire_stream.hpp"

namespace tactus {
namespace {

constexpr std::size_t header_bytes = 32;
constexpr Nanoseconds longest_period = nanoseconds_per_second;

template <typename Kind>
consteval std::uint8_t type_of() {
    // The wire's numbers are the order of Message's kinds, from 1.
    return []<typename... Kinds>(std::variant<Kinds...>*) {
        std::uint8_t number = 0;
        bool found = false;
        ((found = found || (++number, std::is_same_v<Kind, Kinds>)), ...);
        return number;
    }(static_cast<Message*>(nullptr));
}
static_assert(type_of<Hello>() == 1 && type_of<DiscoveryFragment>() == 5 && type_of<ForceSample>() == 10);

// One list of fields for each kind, for a WireWriter and const values or a WireReader and plain ones.

template <typename Stream, typename Value>
void hash_fields(Stream& s, Value& hash) {
    for (auto& byte : hash) {
        s.integer(byte);
    }
}

template <typename Stream>
void fields(Stream& s, auto& m, const Hello&) {
    s.choice(m.side, Side::teleoperator_side);
    s.integer(m.scenario);
    s.require(m.scenario >= 1 && m.scenario <= 5);
    s.time(m.period);
    s.require(m.period > 0 && m.period <= longest_period);
    s.integer(m.heard_epoch);
    s.integer(m.object_count);
    s.vector(m.gravity);
}

template <typename Stream>
void fields(Stream&, auto&, const Bye&) {}

template <typename Stream>
void fields(Stream& s, auto& m, const ClockRequest&) {
    s.integer(m.number);
    s.time(m.t0);
}

template <typename Stream>
void fields(Stream& s, auto& m, const ClockAnswer&) {
    s.integer(m.number);
    s.time(m.t0);
    s.time(m.t1);
    s.time(m.t2);
}

// The bytes fill the rest of the body; total_bytes says how many they have to be.
template <typename Stream>
void fields(Stream& s, auto& m, const DiscoveryFragment&) {
    s.integer(m.object);
    s.integer(m.revision);
    hash_fields(s, m.hash);
    s.integer(m.total_bytes);
    s.integer(m.offset);
    s.require(m.object != no_object && m.total_bytes >= 1 && m.total_bytes <= most_description_bytes);
    s.require(m.offset < m.total_bytes && m.offset % most_fragment_bytes == 0);
    if (!s.good()) {
        return;
    }
    const std::size_t size = std::min<std::size_t>(most_fragment_bytes, m.total_bytes - m.offset);
    if constexpr (Stream::reads) {
        m.bytes = s.bytes(size);
    } else {
        s.require(m.bytes.size() == size);
        s.bytes(m.bytes);
    }
}

template <typename Stream>
void fields(Stream& s, auto& m, const ObjectRemoval&) {
    s.integer(m.object);
    s.require(m.object != no_object);
    s.integer(m.revision);
    hash_fields(s, m.hash);
}

template <typename Stream>
void fields(Stream& s, auto& m, const DiscoveryAcknowledgement&) {
    s.integer(m.object);
    s.require(m.object != no_object);
    hash_fields(s, m.hash);
    s.choice(m.verdict, DiscoveryVerdict::removed);
}

template <typename Stream>
void fields(Stream& s, auto& m, const ObjectState&) {
    s.integer(m.object);
    s.require(m.object != no_object);
    s.flag(m.asleep);
    s.pose(m.pose);
    s.vector(m.linear_velocity);
    s.vector(m.angular_velocity);
}

template <typename Stream>
void fields(Stream& s, auto& m, const ObjectStates&) {
    s.time(m.true_at);
    s.integer(m.newest_operator_sample);
    s.integer(m.count);
    s.require(m.count <= ObjectStates::most);
    for (std::size_t i = 0; s.good() && i < m.count; ++i) {
        fields(s, m.states[i], ObjectState{});
    }
}

template <typename Stream>
void fields(Stream& s, auto& m, const OperatorSample&) {
    s.integer(m.sequence);
    s.require(m.sequence != no_sample);
    s.time(m.time);
    s.integer(m.pointer);
    s.flag(m.connected);
    s.integer(m.buttons);
    s.vector(m.position);
    s.vector(m.velocity);
    s.vector(m.force);
    s.integer(m.nearest_object);
    s.vector(m.position_in_object);
}

template <typename Stream>
void fields(Stream& s, auto& m, const OperatorSamples&) {
    s.integer(m.count);
    s.require(m.count >= 1 && m.count <= OperatorSamples::most);
    for (std::size_t i = 0; s.good() && i < m.count; ++i) {
        fields(s, m.samples[i], OperatorSample{});
    }
}

template <typename Stream>
void fields(Stream& s, auto& m, const ForceSample&) {
    s.integer(m.pointer);
    s.time(m.true_at);
    s.integer(m.newest_operator_sample);
    s.vector(m.force);
    s.vector(m.proxy);
    s.integer(m.object);
}

template <typename Stream>
void header_fields(Stream& s, auto& header) {
    s.integer(header.epoch);
    s.integer(header.sequence);
    s.time(header.sent_at);
    s.require(header.epoch != 0 && header.sequence != 0);
}

template <typename Kind>
void read_body(WireReader& reader, Message& message) {
    fields(reader, message.emplace<Kind>(), Kind{});
}

void read_message(WireReader& reader, std::uint8_t type, Message& message) {
    using Read = void (*)(WireReader&, Message&);
    static constexpr auto readers = []<typename... Kinds>(std::variant<Kinds...>*) {
        return std::array<Read, sizeof...(Kinds)>{&read_body<Kinds>...};
    }(static_cast<Message*>(nullptr));
    if (type < 1 || type > readers.size()) {
        reader.refuse(Refusal::unknown_type);
        return;
    }
    readers[type - 1u](reader, message);
}

}  // namespace

std::uint64_t RefusalCounts::total() const {
    return std::accumulate(by_reason.begin() + 1, by_reason.end(), std::uint64_t{0});
}

std::size_t encode(const PacketHeader& header, const Message& message, std::span<std::byte> into) {
    const std::size_t room = std::min(into.size(), most_message_bytes);
    if (room < header_bytes) {
        return 0;
    }
    WireWriter body(into.subspan(header_bytes, room - header_bytes));
    std::visit([&body]<typename Kind>(const Kind& kind) { fields(body, kind, kind); }, message);

    WireWriter front(into.first(header_bytes));
    front.integer(packet_magic);
    front.integer(wire_version);
    front.integer(static_cast<std::uint8_t>(message.index() + 1));
    front.integer(static_cast<std::uint16_t>(body.written()));
    front.integer(std::uint16_t{0});
    header_fields(front, header);
    return front.good() && body.good() ? header_bytes + body.written() : 0;
}

Refusal decode(std::span<const std::byte> datagram, Packet& packet) {
    WireReader reader(datagram);
    std::uint16_t found_magic = 0, body_bytes = 0, reserved = 0;
    std::uint8_t version = 0, type = 0;
    reader.integer(found_magic);
    if (reader.good() && found_magic != packet_magic) {
        return found_magic == sealed_magic ? Refusal::sealed : Refusal::wrong_magic;
    }
    reader.integer(version);
    if (reader.good() && version != wire_version) {
        return Refusal::wrong_version;
    }
    if (datagram.size() > most_message_bytes) {
        return Refusal::oversized;
    }
    reader.integer(type);
    reader.integer(body_bytes);
    reader.integer(reserved);
    header_fields(reader, packet.header);
    if (!reader.good()) {
        return reader.refusal();
    }
    if (reader.remaining() != body_bytes) {
        return reader.remaining() < body_bytes ? Refusal::truncated : Refusal::oversized;
    }
    reader.require(reserved == 0);
    if (reader.good()) {
        read_message(reader, type, packet.message);
    }
    if (reader.good() && reader.remaining() != 0) {
        return Refusal::oversized;
    }
    return reader.refusal();
}

}  // namespace tactus
