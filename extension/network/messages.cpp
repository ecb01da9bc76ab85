#include "network/messages.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <numeric>
#include <type_traits>

#include "network/sample_fields.hpp"
#include "network/wire_stream.hpp"

namespace tactus {
namespace {

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
static_assert(type_of<Hello>() == 1 && type_of<DiscoveryFragment>() == 5 && type_of<Ghosts>() == 11 &&
              type_of<ObjectEstimates>() == 12 && type_of<WrenchSamples>() == 13 &&
              type_of<SampleAcknowledgements>() == 14 && type_of<Terms>() == 15);

// A packet is of the version that its kind came with: who speaks an older one refuses it, and no other.
constexpr std::uint8_t version_of(std::uint8_t type) {
    return type < type_of<SampleAcknowledgements>() ? 3 : 4;
}
static_assert(version_of(type_of<WrenchSamples>()) == oldest_wire_version &&
              version_of(type_of<Terms>()) == wire_version);

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
    s.require(m.period > 0 && m.period <= plausible::max_period);
    s.integer(m.heard_epoch);
    s.integer(m.object_count);
    s.vector(m.gravity, -plausible::max_gravity, plausible::max_gravity);
    s.integer(m.oldest_version);
    s.integer(m.newest_version);
    s.require(m.oldest_version <= m.newest_version);
    s.varint(m.heard_packets);
    s.varint(m.heard_sequence);
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
    s.require(m.object != no_object && m.total_bytes >= 1 && m.total_bytes <= max_description_bytes);
    s.require(m.offset < m.total_bytes && m.offset % max_fragment_bytes == 0);
    if (!s.good()) {
        return;
    }
    const std::size_t size = std::min<std::size_t>(max_fragment_bytes, m.total_bytes - m.offset);
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
void fields(Stream& s, auto& m, const ObjectStates&) {
    s.time_near(m.true_at);
    s.varint(m.newest_operator_sample);
    s.integer(m.count);
    s.require(m.count <= ObjectStates::max_count && m.newest_operator_sample <= plausible::max_sequence);
    for (std::size_t i = 0; s.good() && i < m.count; ++i) {
        object_state_fields(s, m.states[i]);
    }
}

template <typename Stream>
void fields(Stream& s, auto& m, const OperatorSamples&) {
    std::uint64_t period = static_cast<std::uint64_t>(m.period);
    s.varint(period);
    s.require(period > 0 && period <= static_cast<std::uint64_t>(plausible::max_period));
    s.integer(m.count);
    s.require(m.count >= 1 && m.count <= OperatorSamples::max_count);
    if constexpr (Stream::reads) {
        m.period = s.good() ? static_cast<Nanoseconds>(period) : 1;
    }
    operator_sample_fields(s, m);
}

template <typename Stream>
void fields(Stream& s, auto& m, const ForceSamples&) {
    s.integer(m.count);
    s.require(m.count >= 1 && m.count <= ForceSamples::max_count);
    for (std::size_t i = 0; s.good() && i < m.count; ++i) {
        force_sample_fields(s, m.samples[i]);
    }
}

template <typename Stream>
void fields(Stream& s, auto& m, const WrenchSamples&) {
    s.integer(m.count);
    s.require(m.count >= 1 && m.count <= WrenchSamples::max_count);
    for (std::size_t i = 0; s.good() && i < m.count; ++i) {
        wrench_sample_fields(s, m.samples[i]);
    }
}

template <typename Stream>
void fields(Stream& s, auto& m, const Ghosts&) {
    s.integer(m.count);
    s.require(m.count >= 1 && m.count <= Ghosts::max_count);
    for (std::size_t i = 0; s.good() && i < m.count; ++i) {
        ghost_fields(s, m.ghosts[i]);
    }
}

template <typename Stream>
void fields(Stream& s, auto& m, const ObjectEstimates&) {
    s.integer(m.count);
    s.require(m.count >= 1 && m.count <= ObjectEstimates::max_count);
    for (std::size_t i = 0; s.good() && i < m.count; ++i) {
        object_estimate_fields(s, m.estimates[i]);
    }
}

template <typename Stream>
void fields(Stream& s, auto& m, const SampleAcknowledgements&) {
    s.integer(m.count);
    s.require(m.count >= 1 && m.count <= SampleAcknowledgements::max_count);
    for (std::size_t i = 0; s.good() && i < m.count; ++i) {
        std::uint64_t pointer = m.samples[i].pointer;
        s.varint(pointer);
        s.require(pointer <= 0xffffu);
        s.varint(m.samples[i].sequence);
        s.require(m.samples[i].sequence <= plausible::max_sequence);
        if constexpr (Stream::reads) {
            m.samples[i].pointer = static_cast<std::uint16_t>(pointer);
        }
    }
}

// In whole quanta, which stay below `most`.
template <typename Stream>
void quanta_field(Stream& s, auto& value, double quantum, double most) {
    s.require(value >= 0.0 && value <= most);  // false for what is no number
    std::uint64_t quanta = s.good() ? static_cast<std::uint64_t>(std::llround(value / quantum)) : 0;
    s.varint(quanta);
    s.require(static_cast<double>(quanta) <= most / quantum);
    if constexpr (Stream::reads) {
        value = s.good() ? static_cast<double>(quanta) * quantum : 0.0;
    }
}

template <typename Stream>
void hand_terms_fields(Stream& s, auto& m) {
    s.choice(m.kind, HandTerms::Kind::tool);
    if (m.kind == HandTerms::Kind::fingertip) {
        quanta_field(s, m.radius, fine_radius_quantum, max_ghost_radius);
    } else if (m.kind == HandTerms::Kind::tool) {
        s.integer(m.shape);
    }
}

// Hands that are none at the end are not told.
template <typename Stream>
void fields(Stream& s, auto& m, const Terms&) {
    s.integer(m.scenario);
    s.require(m.scenario >= 1 && m.scenario <= 5);
    s.integer(m.passivity);
    if constexpr (Stream::reads) {
        m.impedance = 0.0;
    }
    if (m.passivity == Terms::with_waves) {
        quanta_field(s, m.impedance, impedance_quantum, max_impedance);
    }
    std::uint64_t bodies = m.bodies;
    s.varint(bodies);
    s.require(bodies < no_object);
    std::uint8_t count = 0;
    if constexpr (Stream::reads) {
        m.bodies = static_cast<std::uint32_t>(bodies);
        m.hands = {};
    } else {
        for (std::size_t i = 0; i < Terms::max_hands; ++i) {
            count = m.hands[i].kind != HandTerms::Kind::none ? static_cast<std::uint8_t>(i + 1) : count;
        }
    }
    s.integer(count);
    s.require(count <= Terms::max_hands);
    for (std::size_t i = 0; s.good() && i < count; ++i) {
        hand_terms_fields(s, m.hands[i]);
    }
}

template <typename Stream>
void header_fields(Stream& s, auto& header) {
    s.integer(header.epoch);
    s.varint(header.sequence);
    std::int64_t time = header.sent_at;
    s.folded_varint(time);
    s.require(time >= -plausible::max_time && time <= plausible::max_time);
    if constexpr (Stream::reads) {
        header.sent_at = s.good() ? time : 0;
    }
    s.require(header.epoch != 0 && header.sequence != 0 && header.sequence <= plausible::max_sequence);
    s.set_sent_at(header.sent_at);
}

// What was added to a message later: a tag, a size and so many bytes, each skipped by who does not know it.
void read_extensions(WireReader& reader, Message& message) {
    while (reader.good() && reader.remaining() > 0) {
        std::uint8_t tag = 0, size = 0;
        reader.integer(tag);
        if (reader.good() && tag == 0) {
            reader.refuse(Refusal::oversized);
        }
        reader.integer(size);
        auto* const forces = std::get_if<ForceSamples>(&message);
        if (reader.good() && forces != nullptr && tag == ForceSamples::taken_tag &&
            size == forces->count * sizeof(std::uint32_t)) {
            for (std::size_t i = 0; i < forces->count; ++i) {
                reader.integer(forces->samples[i].taken);
            }
        } else {
            reader.bytes(size);
        }
    }
}

void write_extensions(WireWriter& writer, const Message& message) {
    const auto* const forces = std::get_if<ForceSamples>(&message);
    const auto tells = [](const ForceSample& sample) { return sample.taken != 0; };
    if (forces != nullptr && std::ranges::any_of(std::span(forces->samples).first(forces->count), tells)) {
        writer.integer(ForceSamples::taken_tag);
        writer.integer(static_cast<std::uint8_t>(forces->count * sizeof(std::uint32_t)));
        for (std::size_t i = 0; i < forces->count; ++i) {
            writer.integer(forces->samples[i].taken);
        }
    }
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

Vec3 position_as_sent(const Vec3& position) {
    return glm::round(position / position_quantum) * position_quantum;
}

Vec3 velocity_as_sent(const Vec3& velocity) {
    return glm::round(velocity / velocity_quantum) * velocity_quantum;
}

Quat rotation_as_sent(const Quat& rotation) {
    return rotation_of(whole_turn(rotation));
}

Vec3 spin_as_sent(const Vec3& spin) {
    return glm::round(spin / spin_quantum) * spin_quantum;
}

std::size_t encode(const PacketHeader& header, const Message& message, std::span<std::byte> into) {
    WireWriter writer(into.first(std::min(into.size(), max_message_bytes)));
    writer.integer(packet_magic);
    const auto type = static_cast<std::uint8_t>(message.index() + 1);
    writer.integer(version_of(type));
    writer.integer(type);
    header_fields(writer, header);
    std::visit([&writer]<typename Kind>(const Kind& kind) { fields(writer, kind, kind); }, message);
    if (writer.good()) {
        write_extensions(writer, message);
    }
    return writer.good() ? writer.written() : 0;
}

Refusal decode(std::span<const std::byte> datagram, Packet& packet) {
    WireReader reader(datagram);
    std::uint16_t found_magic = 0;
    std::uint8_t version = 0, type = 0;
    reader.integer(found_magic);
    if (reader.good() && found_magic != packet_magic) {
        return found_magic == sealed_magic ? Refusal::sealed : Refusal::wrong_magic;
    }
    reader.integer(version);
    if (reader.good() && (version < oldest_wire_version || version > wire_version)) {
        return Refusal::wrong_version;
    }
    if (datagram.size() > max_message_bytes) {
        return Refusal::oversized;
    }
    reader.integer(type);
    header_fields(reader, packet.header);
    if (reader.good()) {
        read_message(reader, type, packet.message);
    }
    read_extensions(reader, packet.message);
    return reader.refusal();
}

}  // namespace tactus
