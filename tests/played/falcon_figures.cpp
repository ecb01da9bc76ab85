#include "played/falcon_figures.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "devices/driver_device.hpp"
#include "devices/falcon/falcon_driver.hpp"
#include "devices/path_device.hpp"
#include "platform/realtime_thread.hpp"
#include "platform/sleep.hpp"
#include "played/played_stall.hpp"
#include "played/played_usb.hpp"
#include "realtime/awake_processor.hpp"
#include "session/session.hpp"
#include "shared/bench_kit.hpp"

namespace tactus::shared {

namespace {

constexpr Nanoseconds ms = 1'000'000;
constexpr Nanoseconds in_time = 2 * ms;
constexpr Nanoseconds patience = 20'000 * ms;
constexpr Nanoseconds stall = 15 * ms;
constexpr Nanoseconds verdict = 5 * ms;

std::unique_ptr<DriverDevice> open_falcon() {
    FalconSettings settings;
    settings.firmware = PlayedFalcon::firmware();
    return std::make_unique<DriverDevice>(std::make_unique<FalconDriver>(std::move(settings)));
}

// As the loop of a world asks for it.
RealtimeRequest loop_request() {
    RealtimeRequest request;
    request.lock_memory = false;
    return request;
}

// A loop of 1 kHz that asks for one force, and can be made to stop.
class Loop {
public:
    explicit Loop(DriverDevice& device) : device_(device), thread_([this] { run(); }) {}
    ~Loop() {
        end_ = true;
        thread_.join();
    }

    void ask(const Vec3& force) { force_ = force.y; }
    void stall(bool stalled) { stalled_ = stalled; }
    Nanoseconds last_sign() const { return last_; }
    bool is_connected() const { return connected_; }

    bool wait_for_hand(Nanoseconds span = patience) const {
        SleepTimer timer;
        for (const Nanoseconds end = monotonic_now() + span; !connected_ && monotonic_now() < end;) {
            timer.sleep_until(monotonic_now() + ms);
        }
        return connected_;
    }

private:
    void run() {
        const RealtimeReport granted = make_thread_realtime(loop_request());
        AwakeProcessor awake;
        if (granted.cpu != any_processor) {
            awake.start(granted.cpu);
        }
        SleepTimer timer;
        for (Nanoseconds tick = monotonic_now(); !end_; tick = std::max(tick + ms, monotonic_now() - ms)) {
            timer.sleep_until(tick);
            if (!stalled_) {
                connected_ = device_.read(tick).connected;
                last_ = monotonic_now();
                device_.write(tick, {0.0, force_.load(), 0.0});
            }
        }
        release_realtime(granted);
    }

    DriverDevice& device_;
    std::atomic<double> force_{0.0};
    std::atomic<bool> stalled_{false}, connected_{false}, end_{false};
    std::atomic<Nanoseconds> last_{0};
    std::thread thread_;
};

bool wait_until(const auto& done, Nanoseconds span = patience) {
    SleepTimer timer;
    for (const Nanoseconds end = monotonic_now() + span; monotonic_now() < end;) {
        if (done()) {
            return true;
        }
        timer.sleep_until(monotonic_now() + 200'000);
    }
    return false;
}

StallFigures figures_of(std::vector<double> milliseconds, int stalls) {
    StallFigures figures;
    figures.stalls = stalls;
    for (const double one : milliseconds) {
        figures.ok += one <= to_seconds(in_time) * 1e3 ? 1 : 0;
        figures.max_ms = std::max(figures.max_ms, one);
    }
    figures.p99_ms = quantile(milliseconds, 0.99);
    return figures;
}

// Puts the hand under a force, makes something stall, and takes the time until the force is gone for good:
// what was still on its way has come by the time of the verdict.
template <typename Stall, typename GoOn>
StallFigures time_stalls(int stalls, const Stall& begin, const GoOn& go_on) {
    PlayedUsb usb({});
    usb.plug();
    const auto device = open_falcon();
    Loop loop(*device);
    std::vector<double> times;
    if (loop.wait_for_hand()) {
        RandomValues random(3);
        for (int i = 0; i < stalls; ++i) {
            loop.ask({0.0, 2.0, 0.0});
            if (!wait_until([&] { return usb.force().y > 1.0; })) {
                continue;
            }
            SleepTimer().sleep_until(monotonic_now() + static_cast<Nanoseconds>(random.between(2e6, 5e6)));
            const Nanoseconds began = begin(loop);
            SleepTimer().sleep_until(began + verdict);
            if (wait_until([&] { return usb.is_let_go(); }, stall + 50 * ms)) {
                times.push_back(to_seconds(std::max<Nanoseconds>(0, usb.let_go_at() - began)) * 1e3);
            }
            go_on(loop);
        }
    }
    return figures_of(std::move(times), stalls);
}

CircleWave way_of_the_hand() {
    CircleWave way;
    way.centre = {0.0, -0.004, 0.0};
    way.radius = 0.02;
    way.amplitude = 0.003;
    return way;
}

// Of a session in real time, with a floor at y = 0 (unit: microseconds). `move` is called before each tick.
double tick_p99(Device& device, double seconds, const auto& move) {
    Session session{SessionSettings{}};
    BodyAddition floor;
    floor.description.shapes = {{BoxShape{Vec3(0.5, 0.05, 0.5)}, Pose{}}};
    floor.description.pose.position = {0.0, -0.05, 0.0};
    floor.description.motion = Motion::Static;
    session.add_body(floor);
    ProxyDescription pointer;
    pointer.device = session.add_device(device, Workspace{}).handle;
    pointer.settings.radius = 0.005;
    session.add_proxy(pointer);
    const SpanClock clock;
    std::vector<double> spans;
    const RealtimeReport granted = make_thread_realtime(loop_request());
    SleepTimer timer;
    const Nanoseconds start = monotonic_now();
    for (Nanoseconds tick = start; tick < start + from_seconds(seconds); tick += ms) {
        move(to_seconds(tick - start));
        timer.sleep_until(tick);
        const std::uint64_t from = clock.now();
        session.tick(tick - start);
        spans.push_back(1e-3 * clock.nanoseconds(from, clock.now()));
    }
    release_realtime(granted);
    return quantile(spans, 0.99);
}

}  // namespace

int starts_ok(int starts, double failing) {
    int ok = 0;
    for (int i = 0; i < starts; ++i) {
        PlayedUsbSettings played;
        played.failing = failing;
        played.seed = 100 + static_cast<std::uint64_t>(i);
        PlayedUsb usb(played);
        usb.plug();
        const auto device = open_falcon();
        ok += Loop(*device).wait_for_hand() ? 1 : 0;
    }
    return ok;
}

double exchanges_per_second(double seconds) {
    PlayedUsb usb({});
    usb.plug();
    const auto device = open_falcon();
    Loop loop(*device);
    if (!loop.wait_for_hand()) {
        return 0.0;
    }
    const std::uint64_t before = device->health().readings;
    const Nanoseconds start = monotonic_now();
    SleepTimer().sleep_until(start + from_seconds(seconds));
    return static_cast<double>(device->health().readings - before) / to_seconds(monotonic_now() - start);
}

int replugs_ok(int replugs) {
    PlayedUsb usb({});
    usb.plug();
    const auto device = open_falcon();
    Loop loop(*device);
    loop.ask({0.0, 2.0, 0.0});
    const auto is_pushed = [&] { return loop.is_connected() && usb.force().y > 1.0; };
    int ok = 0;
    for (int i = 0; i < replugs && wait_until(is_pushed); ++i) {
        usb.unplug();
        wait_until([&] { return !loop.is_connected(); });
        usb.plug();
        ok += wait_until(is_pushed) ? 1 : 0;
    }
    return ok;
}

double tick_over_path(double seconds) {
    PathDevice path{way_of_the_hand()};
    const double by_path = tick_p99(path, seconds, [](double) {});
    PlayedUsb usb({});
    usb.plug();
    const auto falcon = open_falcon();
    if (!Loop(*falcon).wait_for_hand()) {
        return 0.0;
    }
    const double by_falcon = tick_p99(*falcon, seconds, [&usb](double time) {
        usb.mean(sample_path(way_of_the_hand(), from_seconds(time)).position);
    });
    return by_falcon / by_path;
}

StallFigures stall_loop(int stalls) {
    return time_stalls(
        stalls,
        [](Loop& loop) {
            loop.stall(true);
            SleepTimer().sleep_until(monotonic_now() + 100'000);  // a write under way is the last one
            return loop.last_sign();
        },
        [](Loop& loop) { loop.stall(false); });
}

StallFigures stall_driver(int stalls) {
    return time_stalls(
        stalls, [](Loop&) { return stall_thread("tactus-device", stall); },
        [](Loop&) { SleepTimer().sleep_until(monotonic_now() + stall); });
}

}  // namespace tactus::shared
