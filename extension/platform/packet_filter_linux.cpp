#include "platform/packet_filter.hpp"

#include <linux/filter.h>
#include <linux/sock_diag.h>
#include <sys/socket.h>

namespace tactus {

static_assert(FilterStep::load_word == (BPF_LD | BPF_W | BPF_ABS));
static_assert(FilterStep::load_half == (BPF_LD | BPF_H | BPF_ABS));
static_assert(FilterStep::load_length == (BPF_LD | BPF_W | BPF_LEN));
static_assert(FilterStep::jump_if_equal == (BPF_JMP | BPF_JEQ | BPF_K));
static_assert(FilterStep::jump_if_at_least == (BPF_JMP | BPF_JGE | BPF_K));
static_assert(FilterStep::end_with == (BPF_RET | BPF_K));

bool filter_udp(SocketHandle socket, std::span<const FilterStep> program) {
    std::vector<sock_filter> code;
    for (const FilterStep& step : program) {
        code.push_back({step.code, step.skip_if_true, step.skip_if_false, step.value});
    }
    const sock_fprog given{static_cast<unsigned short>(code.size()), code.data()};
    return setsockopt(static_cast<int>(socket), SOL_SOCKET, SO_ATTACH_FILTER, &given, sizeof given) == 0;
}

std::uint64_t dropped_by_system(SocketHandle socket) {
    std::array<std::uint32_t, SK_MEMINFO_VARS> figures{};
    socklen_t size = sizeof figures;
    return getsockopt(static_cast<int>(socket), SOL_SOCKET, SO_MEMINFO, figures.data(), &size) == 0
               ? figures[SK_MEMINFO_DROPS]
               : 0;
}

}  // namespace tactus
