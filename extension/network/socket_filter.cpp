#include "network/socket_filter.hpp"

#include <arpa/inet.h>
#include <linux/filter.h>
#include <linux/sock_diag.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

#include "network/sealed_format.hpp"
#include "network/wire_stream.hpp"

namespace tactus {
namespace {

// What a filter of a UDP socket sees begins with the header of UDP.
constexpr std::uint32_t udp_header = 8;

// A program of the classic packet filter. A load beyond the end of the datagram ends it, and drops that.
class Program {
public:
    // A word or two bytes of the datagram, as the wire's order makes a number of them.
    void load_word(std::size_t at) { load(BPF_W, at); }
    void load_half(std::size_t at) { load(BPF_H, at); }
    void load_length() { code_.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_LEN, 0)); }

    // The loaded number is this, or `steps` are skipped.
    void unless_equal_skip(std::uint32_t number, std::uint8_t steps) {
        code_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 0, steps));
    }
    void unless_at_least_skip(std::uint32_t number, std::uint8_t steps) {
        code_.push_back(BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, number, 0, steps));
    }
    void admit() { code_.push_back(BPF_STMT(BPF_RET | BPF_K, 0xffff'ffffu)); }
    void drop() { code_.push_back(BPF_STMT(BPF_RET | BPF_K, 0)); }
    void append(const Program& other) { code_.insert(code_.end(), other.code_.begin(), other.code_.end()); }
    std::uint8_t steps() const { return static_cast<std::uint8_t>(code_.size()); }

    bool attach(int file) {
        const sock_fprog program{static_cast<unsigned short>(code_.size()), code_.data()};
        return setsockopt(file, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program) == 0;
    }

private:
    void load(int size, std::size_t at) {
        code_.push_back(BPF_STMT(static_cast<unsigned short>(BPF_LD | size | BPF_ABS),
                                 udp_header + static_cast<std::uint32_t>(at)));
    }

    std::vector<sock_filter> code_;
};

// The bytes of a value as they stand in a datagram, as the filter loads them.
std::uint32_t word_of(const void* bytes) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes, sizeof word);
    return ntohl(word);
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
            program.unless_equal_skip(ntohs(magic), 1);
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

bool attach_filter(int file, const Admission& admission) {
    return program_of(admission).attach(file);
}

std::uint64_t dropped_by_system(int file) {
    std::array<std::uint32_t, SK_MEMINFO_VARS> figures{};
    socklen_t size = sizeof figures;
    return getsockopt(file, SOL_SOCKET, SO_MEMINFO, figures.data(), &size) == 0 ? figures[SK_MEMINFO_DROPS]
                                                                                : 0;
}

}  // namespace tactus
