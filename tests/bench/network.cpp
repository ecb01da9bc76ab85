// What the link costs: the haptic thread's part of a tick, and the way through real sockets on this machine.
//
//     network [--seconds=5]
#include <array>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "network/endpoint.hpp"
#include "network/link_emulator.hpp"
#include "network/memory_link.hpp"
#include "network/udp_link.hpp"
#include "platform/clock.hpp"
#include "realtime/sleeper.hpp"
#include "shared/bench_kit.hpp"
#include "shared/sealed_link.hpp"
#include "support/process.hpp"

namespace {

using namespace tactus;
using namespace tactus::shared;

constexpr Nanoseconds tick = 1'000'000;

// What a busy side sends each tick: ten moving objects, or nine samples of the hand.
Message ten_states(Nanoseconds now) {
    ObjectStates states{now, 1, ObjectStates::max_count, {}};
    for (std::size_t i = 0; i < ObjectStates::max_count; ++i) {
        states.states[i].object = static_cast<ObjectId>(i);
        states.states[i].pose.position = Vec3(0.1 * static_cast<double>(i));
    }
    return states;
}

Message nine_samples(Nanoseconds now) {
    OperatorSamples samples{1'000'000, OperatorSamples::max_count, {}};
    for (std::size_t i = 0; i < OperatorSamples::max_count; ++i) {
        samples.samples[i].sequence = OperatorSamples::max_count - i;
        samples.samples[i].time = now;
    }
    return samples;
}

void run_tick(Endpoint& side, Nanoseconds now, const Message& message) {
    side.begin_tick(now);
    while (side.receive() != nullptr) {
    }
    side.send(message);
    side.end_tick();
}

void report_spans(Report& report, const std::string& name, std::vector<double>& spans) {
    report.set(name + "_p50_us", quantile(spans, 0.5) * 1e-3);
    report.set(name + "_p99_us", quantile(spans, 0.99) * 1e-3);
    report.set(name + "_max_us", quantile(spans, 1.0) * 1e-3);
}

// The operator's tick: takes ten states, sends nine samples.
void measure_tick(Report& report, const std::string& name, Link& near_link, Link& far_link) {
    EndpointSettings settings;
    Endpoint near(near_link, settings);
    settings.side = Side::teleoperator_side;
    settings.epoch = 2;
    Endpoint far(far_link, settings);
    const SpanClock clock;
    std::vector<double> spans;
    for (Nanoseconds now = 0; now < 20'000 * tick; now += tick) {
        run_tick(far, now, ten_states(now));
        const Message samples = nine_samples(now);
        const std::uint64_t begin = clock.now();
        run_tick(near, now, samples);
        spans.push_back(clock.nanoseconds(begin, clock.now()));
    }
    report_spans(report, name + ".tick", spans);
}

void measure_ticks(Report& report) {
    MemoryLinkPair plain;
    measure_tick(report, "plain", plain.first(), plain.second());

    MemoryLinkPair emulated;
    LinkConditions conditions;
    conditions.delay = 100 * tick;
    conditions.jitter = 5 * tick;
    LinkEmulator near_way(emulated.first(), conditions, 1);
    measure_tick(report, "emulated", near_way, emulated.second());

    // As if the tick itself sealed and opened, which is the network thread's part.
    MemoryLinkPair sealed;
    SealedLink near_link(sealed.first(), {SecretKey{1}, {}});
    SealedLink far_link(sealed.second(), {SecretKey{1}, {}});
    measure_tick(report, "sealed", near_link, far_link);
}

// Processor time of this process but for the calling thread (unit: seconds).
double time_of_other_threads() {
    return to_seconds(tactus::testing::process_time() - thread_time());
}

// One datagram a tick from one socket to another of this process: from the call of send() to the stamp of its
// arrival.
bool measure_udp(Report& report, double seconds) {
    UdpLink first, second;
    UdpSettings settings;
    settings.local_address = settings.remote_address = "127.0.0.1";
    settings.remote_port = 9;
    std::string error = first.open(settings);
    const std::uint16_t first_port = first.local_port();
    settings.remote_port = first_port;
    error += second.open(settings);
    settings.remote_port = second.local_port();
    settings.local_port = first_port;
    first.close();
    error += first.open(settings);
    if (!error.empty()) {
        std::fprintf(stderr, "%s\n", error.c_str());
        return false;
    }
    std::vector<double> ways, sends;
    std::array<std::byte, max_datagram_bytes> datagram{};
    const SpanClock clock;
    Sleeper sleeper(SleepSettings{});
    const double others_before = time_of_other_threads();
    const Nanoseconds start = monotonic_now();
    Nanoseconds due = start;
    std::uint64_t sent = 0;
    for (; due < start + from_seconds(seconds); due += tick) {
        const Nanoseconds now = sleeper.wait_until(due);
        std::memcpy(datagram.data(), &now, sizeof now);
        const std::uint64_t begin = clock.now();
        first.send(std::span(datagram).first(300), now);
        sends.push_back(clock.nanoseconds(begin, clock.now()));
        ++sent;
        while (const ReceivedDatagram received = second.receive(datagram, now)) {
            Nanoseconds left = 0;
            std::memcpy(&left, datagram.data(), sizeof left);
            ways.push_back(static_cast<double>(received.arrived - left));
        }
    }
    const double elapsed = to_seconds(monotonic_now() - start);
    report.set("udp.threads_processor_percent",
               100.0 * (time_of_other_threads() - others_before) / elapsed / 2.0);
    report.set("udp.lost", static_cast<double>(sent - ways.size()));
    report_spans(report, "udp.send", sends);
    report_spans(report, "udp.way", ways);
    return true;
}

}  // namespace

int main(int count, char** arguments) {
    Options options(count, arguments);
    const double seconds = options.number("seconds", 5.0);
    if (!options.understood()) {
        return 2;
    }
    Report report;
    measure_ticks(report);
    return measure_udp(report, seconds) && report.write_json(result_path("network")) ? 0 : 1;
}
