#include "played/falcon_figures.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "devices/driver_device.hpp"
#include "devices/falcon/falcon_driver.hpp"
#include "platform/sleep.hpp"
#include "played/played_stall.hpp"
#include "played/played_usb.hpp"
#include "shared/bench_kit.hpp"

namespace tactus::shared {

namespace {

constexpr Nanoseconds ms = 1'000'000;
constexpr Nanoseconds in_time = 2 * ms;
constexpr Nanoseconds given_up = 50 * ms;
constexpr Nanoseconds verdict = 5 * ms;

std::unique_ptr<DriverDevice> open_falcon() {
    FalconSettings settings;
    settings.firmware = PlayedFalcon::firmware();
    return std::make_unique<DriverDevice>(std::make_unique<FalconDriver>(std::move(settings)));
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
            loop.ask(2.0);
            if (!wait_until([&] { return usb.force().y > 1.0; })) {
                continue;
            }
            SleepTimer().sleep_until(monotonic_now() + static_cast<Nanoseconds>(random.between(2e6, 5e6)));
            const Nanoseconds began = begin(loop);
            SleepTimer().sleep_until(began + verdict);
            if (wait_until([&] { return usb.is_let_go(); }, given_up)) {
                times.push_back(to_seconds(std::max<Nanoseconds>(0, usb.let_go_at() - began)) * 1e3);
            }
            go_on(loop);
        }
    }
    return figures_of(std::move(times), stalls);
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

ExchangeFigures falcon_exchanges(double seconds) {
    PlayedUsb usb({});
    usb.plug();
    const auto device = open_falcon();
    const Loop loop(*device);
    return loop.wait_for_hand() ? exchanges(*device, seconds) : ExchangeFigures{};
}

RoundTrips falcon_round_trips(int times) {
    PlayedUsb usb({});
    usb.plug();
    const auto device = open_falcon();
    Loop loop(*device);
    loop.ask_by_button(2.0);
    std::vector<double> spans;
    RandomValues random(5);
    for (int i = 0; i < times && loop.wait_for_hand(); ++i) {
        usb.press(1);
        wait_until([&] { return !usb.is_let_go(); });
        SleepTimer().sleep_until(monotonic_now() + static_cast<Nanoseconds>(random.between(2e6, 5e6)));
        const Nanoseconds released = monotonic_now();
        usb.press(0);
        wait_until([&] { return usb.let_go_at() > released; });
        spans.push_back(1e3 * to_seconds(usb.let_go_at() - released));
    }
    return {quantile(spans, 0.5), quantile(spans, 0.99)};
}

int replugs_ok(int replugs) {
    PlayedUsb usb({});
    usb.plug();
    const auto device = open_falcon();
    Loop loop(*device);
    loop.ask(2.0);
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

double falcon_tick_over_path(double seconds) {
    PlayedUsb usb({});
    usb.plug();
    const auto falcon = open_falcon();
    if (!Loop(*falcon).wait_for_hand()) {
        return 0.0;
    }
    return tick_over_path(*falcon, seconds, [&usb](double time) { usb.mean(way_over_floor(time)); });
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
    std::unique_ptr<StalledThread> stalled;
    return time_stalls(
        stalls,
        [&stalled](Loop&) {
            stalled = std::make_unique<StalledThread>("tactus-device");
            return stalled->since();
        },
        [&stalled](Loop&) { stalled.reset(); });
}

}  // namespace tactus::shared
