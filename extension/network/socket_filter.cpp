#include "network/socket_filter.hpp"

#include <array>
#include <cstddef>
#include <cstring>
#include <vector>

#include "network/sealed_format.hpp"
#include "network/wire_stream.hpp"

namespace tactus {
namespace {

// What a filter of a UDP socket sees begins with the header of UDP.
constexpr std::uint32_t udp_header = 8;

class Program {
public:
    // A word or two bytes of the datagram, as the wire's order makes a number of them.
    void load_word(std::size_t at) { load(FilterStep::load_word, at); }
    void load_half(std::size_t at) { load(FilterStep::load_half, at); }
    void load_length() { code_.push_back({FilterStep::load_length}); }

    // The loaded number is this, or `steps` are skipped.
    void unless_equal_skip(std::uint32_t number, std::uint8_t steps) {
        code_.push_back({FilterStep::jump_if_equal, 0, steps, number});
    }
    void unless_at_least_skip(std::uint32_t number, std::uint8_t steps) {
        code_.push_back({FilterStep::jump_if_at_least, 0, steps, number});
    }
    void admit() { code_.push_back({FilterStep::end_with, 0, 0, 0xffff'ffffu}); }
    void drop() { code_.push_back({FilterStep::end_with}); }
    void append(const Program& other) { code_.insert(code_.end(), other.code_.begin(), other.code_.end()); }
    std::uint8_t steps() const { return static_cast<std::uint8_t>(code_.size()); }

    bool attach(SocketHandle socket) const { return filter_udp(socket, code_); }

private:
    void load(FilterStep::Code code, std::size_t at) {
        code_.push_back({code, 0, 0, udp_header + static_cast<std::uint32_t>(at)});
    }

    std::vector<FilterStep> code_;
};

// The bytes of a value as they stand in a datagram, as the filter loads them.
std::uint32_t word_of(const void* bytes) {
    std::array<std::uint8_t, 4> b;
    std::memcpy(b.data(), bytes, sizeof b);
    return std::uint32_t{b[0]} << 24 | std::uint32_t{b[1]} << 16 | std::uint32_t{b[2]} << 8 | b[3];
}

std::uint32_t half_of(std::uint16_t value) {
    std::array<std::uint8_t, 2> b;
    std::memcpy(b.data(), &value, sizeof b);
    return std::uint32_t{b[0]} << 8 | b[1];
}

std::uint32_t front_of(std::uint8_t kind) {
    std::array<std::uint8_t, sealed_format::front_bytes> front{};
    std::memcpy(front.data(), &sealed_magic, sizeof sealed_magic);
    front[2] = sealed_format::version;
    front[3] = kind;
    return word_of(front.data());
}

Program for_packets(const Admission& admission) {
    Program program;
    program.load_length();
    program.unless_at_least_skip(udp_header + sealed_format::overhead,
                                 static_cast<std::uint8_t>(1 + 2 * admission.session_count));
    program.load_word(sealed_format::session_at);
    for (std::size_t i = 0; i < admission.session_count; ++i) {
        program.unless_equal_skip(word_of(&admission.sessions[i]), 1);
        program.admit();
    }
    program.drop();
    return program;
}

Program for_greetings(const Admission& admission) {
    Program program;
    program.load_length();
    if (admission.strangers) {
        program.unless_equal_skip(udp_header + sealed_format::greeting_bytes, 1);
    } else {
        std::array<std::byte, sizeof admission.own_start> own;
        std::memcpy(own.data(), &admission.own_start, sizeof own);
        program.unless_equal_skip(udp_header + sealed_format::greeting_bytes, 5);
        program.load_word(sealed_format::receiver_at);
        program.unless_equal_skip(word_of(&own[0]), 3);
        program.load_word(sealed_format::receiver_at + 4);
        program.unless_equal_skip(word_of(&own[4]), 1);
    }
    program.admit();
    program.drop();
    return program;
}

Program for_the_rest(const Admission& admission) {
    Program program;
    if (admission.strangers) {
        program.load_half(0);
        for (const std::uint16_t magic : {sealed_magic, packet_magic}) {
            program.unless_equal_skip(half_of(magic), 1);
            program.admit();
        }
    }
    program.drop();
    return program;
}

// Admission::admits(), step by step.
Program program_of(const Admission& admission) {
    const Program packets = for_packets(admission), greetings = for_greetings(admission);
    Program program;
    program.load_word(0);
    program.unless_equal_skip(front_of(sealed_format::packet), packets.steps());
    program.append(packets);
    program.unless_equal_skip(front_of(sealed_format::greeting), greetings.steps());
    program.append(greetings);
    program.append(for_the_rest(admission));
    return program;
}

}  // namespace

bool attach_filter(SocketHandle socket, const Admission& admission) {
    return program_of(admission).attach(socket);
}

}  // namespace tactus
