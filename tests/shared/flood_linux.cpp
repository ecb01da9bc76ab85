#include "shared/flood.hpp"

#include <arpa/inet.h>
#include <dirent.h>
#include <netinet/in.h>
#include <netinet/ip.h>
#include <netinet/udp.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <thread>
#include <vector>

#include "network/udp_link.hpp"
#include "platform/clock.hpp"
#include "platform/sleep.hpp"
#include "realtime/sleeper.hpp"
#include "session/operator_side.hpp"
#include "session/teleoperator_side.hpp"
#include "shared/attack_rig.hpp"
#include "shared/bench_kit.hpp"

namespace tactus::shared {
namespace {

constexpr Nanoseconds period = 1'000'000;
constexpr std::size_t flood_bytes = 200;
constexpr std::size_t at_once = 100;

// Processor time of a thread of this process (unit: seconds).
double time_of_thread(int id) {
    const std::string path = "/proc/self/task/" + std::to_string(id) + "/schedstat";
    unsigned long long nanoseconds = 0;
    if (std::FILE* const file = std::fopen(path.c_str(), "r")) {
        if (std::fscanf(file, "%llu", &nanoseconds) != 1) {
            nanoseconds = 0;
        }
        std::fclose(file);
    }
    return static_cast<double>(nanoseconds) * 1e-9;
}

std::vector<int> network_threads() {
    std::vector<int> found;
    DIR* const folder = opendir("/proc/self/task");
    for (dirent* entry = readdir(folder); entry != nullptr; entry = readdir(folder)) {
        std::array<char, 64> name{};
        const std::string path = std::string("/proc/self/task/") + entry->d_name + "/comm";
        if (std::FILE* const file = std::fopen(path.c_str(), "r")) {
            if (std::fgets(name.data(), name.size(), file) != nullptr &&
                std::strncmp(name.data(), "tactus-network", 14) == 0) {
                found.push_back(std::atoi(entry->d_name));
            }
            std::fclose(file);
        }
    }
    closedir(folder);
    return found;
}

std::vector<double> times_of(const std::vector<int>& threads) {
    std::vector<double> times;
    for (const int thread : threads) {
        times.push_back(time_of_thread(thread));
    }
    return times;
}

// Of the thread that has done most (unit: seconds).
double busiest_since(const std::vector<double>& before, const std::vector<double>& after) {
    double most = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        most = std::max(most, after[i] - before[i]);
    }
    return most;
}

// Headers of IPv4 and UDP and a packet that looks like a sealed one, counters rising.
struct Forged {
    std::array<std::byte, sizeof(iphdr) + sizeof(udphdr) + flood_bytes> bytes{};

    void make(std::uint16_t from, std::uint16_t to) {
        iphdr ip{};
        ip.version = 4;
        ip.ihl = sizeof(iphdr) / 4;
        ip.ttl = 64;
        ip.protocol = IPPROTO_UDP;
        ip.saddr = ip.daddr = htonl(INADDR_LOOPBACK);
        udphdr udp{};
        udp.source = htons(from);
        udp.dest = htons(to);
        udp.len = htons(sizeof(udphdr) + flood_bytes);
        std::memcpy(bytes.data(), &ip, sizeof ip);
        std::memcpy(bytes.data() + sizeof ip, &udp, sizeof udp);
    }
};

std::uint64_t scrambled(std::uint64_t number) {
    number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9u;
    return number ^ (number >> 27);
}

// In a child of its own: throws until it is ended. With `forges`, from the far side's address.
[[noreturn]] void throw_for_ever(std::uint16_t from, std::uint16_t to, double packets_per_s, bool forges,
                                 int report) {
    const int file = forges ? socket(AF_INET, SOCK_RAW, IPPROTO_RAW) : socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in target{};
    target.sin_family = AF_INET;
    target.sin_port = htons(forges ? 0 : to);
    target.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    std::vector<Forged> packets(at_once);
    std::vector<iovec> parts(at_once);
    std::vector<mmsghdr> messages(at_once);
    constexpr std::size_t headers = sizeof(iphdr) + sizeof(udphdr);
    for (std::size_t i = 0; i < at_once; ++i) {
        packets[i].make(from, to);
        std::byte* const begin = packets[i].bytes.data();
        parts[i] = forges ? iovec{begin, packets[i].bytes.size()} : iovec{begin + headers, flood_bytes};
        messages[i] = {};
        messages[i].msg_hdr.msg_iov = &parts[i];
        messages[i].msg_hdr.msg_iovlen = 1;
        messages[i].msg_hdr.msg_name = &target;
        messages[i].msg_hdr.msg_namelen = sizeof target;
    }
    std::uint64_t thrown = 0;
    SleepTimer timer;
    const auto every = static_cast<Nanoseconds>(1e9 * static_cast<double>(at_once) / packets_per_s);
    for (Nanoseconds due = monotonic_now();; due += every) {
        timer.sleep_until(due);
        for (Forged& packet : packets) {
            // Greetings, sealed packets of any session, and noise.
            std::byte* const body = packet.bytes.data() + headers;
            const std::uint64_t random = scrambled(++thrown);
            constexpr std::array<char, 4> fronts[] = {
                {'T', 'S', 2, 0}, {'T', 'S', 2, 1}, {'T', 'C', wire_version, 8}, {9, 9, 9, 9}};
            std::memcpy(body, fronts[random % 4].data(), 4);
            std::memcpy(body + 4, &random, sizeof random);
        }
        const int sent = sendmmsg(file, messages.data(), at_once, 0);
        const auto count = static_cast<std::uint64_t>(std::max(sent, 0));
        [[maybe_unused]] const ssize_t told = write(report, &count, sizeof count);
    }
}

class Flooder {
public:
    Flooder(std::uint16_t from, std::uint16_t to, double packets_per_s, bool forges) {
        int ends[2];
        if (pipe(ends) != 0) {
            return;
        }
        report_ = ends[0];
        child_ = fork();
        if (child_ == 0) {
            close(ends[0]);
            throw_for_ever(from, to, packets_per_s, forges, ends[1]);
        }
        close(ends[1]);
    }
    std::uint64_t stop() {
        kill(child_, SIGKILL);
        waitpid(child_, nullptr, 0);
        std::uint64_t thrown = 0;
        for (std::uint64_t count = 0;
             read(report_, &count, sizeof count) == static_cast<ssize_t>(sizeof count);) {
            thrown += count;
        }
        close(report_);
        return thrown;
    }

private:
    pid_t child_ = -1;
    int report_ = -1;
};

bool may_forge() {
    const int file = socket(AF_INET, SOCK_RAW, IPPROTO_RAW);
    if (file >= 0) {
        close(file);
    }
    return file >= 0;
}

UdpSettings to(std::uint16_t remote_port, std::uint16_t local_port) {
    UdpSettings settings;
    settings.local_address = settings.remote_address = "127.0.0.1";
    settings.remote_port = remote_port;
    settings.local_port = local_port;
    settings.secret = SharedSecret{SecretKey{1, 2, 3}, {}};
    return settings;
}

// Two sides over sockets. The operator's ticks are timed; the far side's are made by another thread.
struct FloodRig {
    std::string open() {
        std::string error = near_link.open(to(9, 0));
        const std::uint16_t near_port = near_link.local_port();
        error += far_link.open(to(near_port, 0));
        far_port = far_link.local_port();
        near_link.close();
        error += near_link.open(to(far_port, near_port));
        EndpointSettings endpoint;
        near.session.attach(std::make_unique<OperatorSide>(near.session.settings(), OperatorRoom{},
                                                           TeleopSettings{}, near_link, near.port, endpoint));
        endpoint.side = Side::teleoperator_side;
        endpoint.epoch = 2;
        far.session.attach(std::make_unique<TeleoperatorSide>(far.session.settings(), TeleopSettings{},
                                                              far_link, far.port, endpoint));
        near.fill(false);
        far.fill(true);
        return error;
    }

    // Processor times of the operator's ticks (unit: nanoseconds).
    std::vector<double> run(double seconds) {
        std::vector<double> spans;
        Sleeper sleeper(SleepSettings{});
        const Nanoseconds end = due + from_seconds(seconds);
        for (; due < end; due += period) {
            sleeper.wait_until(due);
            const Nanoseconds begin = thread_time();
            near.tick(due);
            spans.push_back(static_cast<double>(thread_time() - begin));
        }
        return spans;
    }

    AttackPlace near, far;
    UdpLink near_link, far_link;
    std::uint16_t far_port = 0;
    Nanoseconds due = monotonic_now();
};

}  // namespace

FloodFigures run_flood(const FloodSettings& settings) {
    FloodFigures figures;
    FloodRig rig;
    figures.error = rig.open();
    if (!figures.error.empty()) {
        return figures;
    }
    std::atomic<bool> done{false};
    std::thread far_side([&] {
        Sleeper sleeper(SleepSettings{});
        for (Nanoseconds due = monotonic_now(); !done; due += period) {
            sleeper.wait_until(due);
            rig.far.tick(due);
        }
    });
    rig.run(2.0);
    if (!rig.near_link.figures().met) {
        figures.error = "the two sides did not meet";
    }
    // The operator's network thread is the one that the flood keeps busy.
    const std::vector<int> threads = network_threads();
    std::vector<double> quiet, flooded;
    double thrown = 0.0, flooded_seconds = 0.0, thread_seconds = 0.0, quiet_seconds = 0.0, reached = 0.0;
    const auto missing = [&rig] { return static_cast<double>(rig.near.statistics().link.missing); };
    const auto came = [&rig] { return static_cast<double>(rig.near.statistics().link.packets_received); };
    const auto looked_at = [&rig] {
        const UdpFigures udp = rig.near_link.figures();
        return static_cast<double>(udp.too_many + udp.secure.not_sealed + udp.secure.other_start +
                                   udp.secure.replayed + udp.secure.unheard);
    };
    double lost = 0.0, honest = 0.0;
    figures.from_peers_address = may_forge();
    for (int round = 0; round < settings.rounds && figures.error.empty(); ++round) {
        const std::vector<double> idle = times_of(threads);
        const std::vector<double> calm = rig.run(settings.seconds);
        quiet.insert(quiet.end(), calm.begin(), calm.end());
        const std::vector<double> before = times_of(threads);
        quiet_seconds += busiest_since(idle, before);
        const double lost_before = missing(), came_before = came(), looked_before = looked_at();
        Flooder flooder(rig.far_port, rig.near_link.local_port(), settings.packets_per_s,
                        figures.from_peers_address);
        const Nanoseconds begin = monotonic_now();
        const std::vector<double> wild = rig.run(settings.seconds);
        const double elapsed = to_seconds(monotonic_now() - begin);
        thrown += static_cast<double>(flooder.stop());
        flooded.insert(flooded.end(), wild.begin(), wild.end());
        flooded_seconds += elapsed;
        thread_seconds += busiest_since(before, times_of(threads));
        lost += missing() - lost_before;
        honest += came() - came_before;
        reached += looked_at() - looked_before;
    }
    done = true;
    far_side.join();
    if (!figures.error.empty()) {
        return figures;
    }
    figures.packets_per_s = thrown / flooded_seconds;
    figures.reached = reached / std::max(thrown, 1.0);
    figures.tick_over_quiet = quantile(flooded, 0.5) / quantile(quiet, 0.5);
    figures.tick_p99_over_quiet = quantile(flooded, 0.99) / quantile(quiet, 0.99);
    figures.network_thread_percent = 100.0 * thread_seconds / flooded_seconds;
    figures.quiet_network_thread_percent = 100.0 * quiet_seconds / (settings.rounds * settings.seconds);
    figures.honest_lost_percent = 100.0 * lost / std::max(lost + honest, 1.0);
    return figures;
}

}  // namespace tactus::shared
