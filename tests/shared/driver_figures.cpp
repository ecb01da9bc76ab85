#include "shared/driver_figures.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "devices/path_device.hpp"
#include "platform/clock.hpp"
#include "platform/sleep.hpp"
#include "session/session.hpp"
#include "shared/bench_kit.hpp"

namespace tactus::shared {

namespace {

constexpr Nanoseconds ms = 1'000'000;
constexpr Nanoseconds look_again = 200'000;
constexpr Nanoseconds look_closely = 20'000;

RealtimeRequest loop_request() {
    RealtimeRequest request;
    request.lock_memory = false;
    return request;
}

// A session with a floor at y = 0, and a hand.
struct OverFloor {
    explicit OverFloor(Device& device) {
        BodyAddition floor;
        floor.description.shapes = {{BoxShape{Vec3(0.5, 0.05, 0.5)}, Pose{}}};
        floor.description.pose.position = {0.0, -0.05, 0.0};
        floor.description.motion = Motion::Static;
        session.add_body(floor);
        ProxyDescription pointer;
        pointer.device = session.add_device(device, Workspace{}).handle;
        pointer.settings.radius = 0.005;
        session.add_proxy(pointer);
    }
    void tick(const SpanClock& clock, Nanoseconds now) {
        const std::uint64_t from = clock.now();
        session.tick(now);
        spans.push_back(1e-3 * clock.nanoseconds(from, clock.now()));
    }

    Session session{SessionSettings{}};
    std::vector<double> spans;  // (unit: microseconds)
};

}  // namespace

AsLoop::AsLoop() : granted_(make_thread_realtime(loop_request())) {
    if (granted_.cpu != any_processor) {
        awake_.start(granted_.cpu, {.lead = AwakeTimes{}.period});
    }
}

AsLoop::~AsLoop() {
    awake_.stop();
    release_realtime(granted_);
}

bool wait_until(const std::function<bool()>& done, Nanoseconds at_most) {
    SleepTimer timer;
    for (const Nanoseconds end = monotonic_now() + at_most; monotonic_now() < end;) {
        if (done()) {
            return true;
        }
        timer.sleep_until(monotonic_now() + look_again);
    }
    return false;
}

Loop::~Loop() {
    end_ = true;
    thread_.join();
}

void Loop::ask_by_button(double newtons) {
    by_button_ = true;
    force_ = newtons;
}

bool Loop::wait_for_hand() const {
    return wait_until([this] { return connected_.load(); });
}

void Loop::run() {
    const AsLoop as_loop;
    SleepTimer timer;
    for (Nanoseconds tick = monotonic_now(); !end_; tick = std::max(tick + ms, monotonic_now() - ms)) {
        timer.sleep_until(tick);
        if (stalled_) {
            continue;
        }
        const DeviceSample sample = device_.read(tick);
        const bool is_asked = !by_button_ || (sample.buttons & 1u) != 0;
        connected_ = sample.connected;
        last_ = monotonic_now();
        device_.write(tick, {0.0, is_asked ? force_.load() : 0.0, 0.0});
    }
}

HandPath path_over_floor() {
    CircleWave way;
    way.centre = {0.0, -0.004, 0.0};
    way.radius = 0.02;
    way.amplitude = 0.003;
    return way;
}

Vec3 way_over_floor(double seconds) {
    return sample_path(path_over_floor(), from_seconds(seconds)).position;
}

// Both in each millisecond; which is first follows the sequence of Thue and Morse. What else the machine does
// meets both then, whatever its period: a kernel that wakes every fourth millisecond would else always meet
// the same one.
double tick_over_path(Device& device, double seconds, const std::function<void(double)>& move) {
    PathDevice path{path_over_floor()};
    OverFloor by_path(path), by_device(device);
    const SpanClock clock;
    SleepTimer timer;
    const AsLoop as_loop;
    const Nanoseconds start = monotonic_now();
    const auto ticks = static_cast<std::uint32_t>(from_seconds(seconds) / ms);
    for (std::uint32_t i = 0; i < ticks; ++i) {
        const Nanoseconds tick = start + i * ms;
        move(to_seconds(tick - start));
        timer.sleep_until(tick);
        const bool path_first = std::popcount(i) % 2 == 0;
        (path_first ? by_path : by_device).tick(clock, tick - start);
        (path_first ? by_device : by_path).tick(clock, tick - start);
    }
    return quantile(by_device.spans, 0.99) / quantile(by_path.spans, 0.99);
}

ExchangeFigures exchanges(const DriverDevice& device, double seconds) {
    SleepTimer timer;
    const Nanoseconds start = monotonic_now();
    const std::uint64_t first = device.health().readings;
    std::uint64_t count = first;
    Nanoseconds last = start;
    std::vector<double> spans;
    while (last < start + from_seconds(seconds) && monotonic_now() < start + 2 * from_seconds(seconds)) {
        const std::uint64_t there = device.health().readings;
        const Nanoseconds now = monotonic_now();
        if (there > count) {
            spans.push_back(1e3 * to_seconds(now - last) / static_cast<double>(there - count));
            count = there;
            last = now;
        }
        timer.sleep_until(now + look_closely);
    }
    ExchangeFigures figures;
    figures.per_second = static_cast<double>(count - first) / to_seconds(last - start);
    for (double& span : spans) {
        span = std::abs(span - 1e3 / figures.per_second);
    }
    figures.jitter_p99_ms = quantile(spans, 0.99);
    return figures;
}

}  // namespace tactus::shared
