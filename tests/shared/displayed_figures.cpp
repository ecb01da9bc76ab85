#include "shared/displayed_figures.hpp"

#include <algorithm>
#include <atomic>
#include <functional>
#include <glm/geometric.hpp>
#include <numeric>
#include <thread>
#include <vector>

#include "platform/clock.hpp"
#include "realtime/sleeper.hpp"
#include "shared/bench_kit.hpp"
#include "shared/driver_figures.hpp"
#include "shared/even_ticks.hpp"
#include "shared/processor_stalls.hpp"

namespace tactus::shared {

namespace {

class BusyProcessors {
public:
    explicit BusyProcessors(int threads) {
        for (int i = 0; i < threads; ++i) {
            threads_.emplace_back([this] {
                while (!end_) {
                }
            });
        }
    }
    ~BusyProcessors() {
        end_ = true;
        for (std::thread& thread : threads_) {
            thread.join();
        }
    }

private:
    std::atomic<bool> end_{false};
    std::vector<std::thread> threads_;
};

// The loop, and what it sees of the device just before it writes. No list grows here: that may take a
// millisecond of a tick.
class ContactLoop {
public:
    ContactLoop(const WatchedDevice& watched, const DisplayedCase& c, DriverDevice& device,
                const ProcessorStalls& stalls, DisplayedFigures& figures, DurationHistogram& writes)
        : watched_(watched),
          case_(c),
          device_(device),
          stalls_(stalls),
          figures_(figures),
          writes_(writes),
          period_(from_seconds(1.0 / c.rate)),
          even_(period_),
          deadline_(monotonic_now() / period_ * period_) {}

    bool wait_for_hand() {
        for (const Nanoseconds end = monotonic_now() + 5'000'000'000; monotonic_now() < end;) {
            if (tick(Vec3(0.0)).is_connected) {
                return true;
            }
        }
        return false;
    }
    void run(double seconds) {
        asked_ = displayed_ = 0.0;
        const Vec3 wanted(0.0, case_.newtons, 0.0);
        if (last_wanted_ == Vec3(0.0)) {
            grow(wanted);
        }
        last_wanted_ = wanted;
        for (const Nanoseconds end = monotonic_now() + from_seconds(seconds); monotonic_now() < end;) {
            note(tick(wanted));
        }
    }
    // As the safety layer lets a force grow.
    void grow(const Vec3& wanted) {
        for (int i = 1; i <= 20; ++i) {
            tick(wanted * (i / 20.0));
        }
    }
    void stop_for(Nanoseconds span) {
        SleepTimer().sleep_until(monotonic_now() + span);
        deadline_ = monotonic_now();
    }
    double over_asked() const { return asked_ > 0.0 ? displayed_ / asked_ : 1.0; }

private:
    static std::uint64_t cuts_of(const DriverHealth& health) {
        return std::accumulate(health.cuts.begin(), health.cuts.end(), std::uint64_t{0});
    }
    struct Tick {
        bool is_connected = false, is_even = false;
        double seen = 0.0;       // of the force (unit: newtons)
        std::uint64_t cuts = 0;  // since the last tick
    };
    Tick tick(const Vec3& wanted) {
        Tick tick;
        TickTimes times;
        deadline_ = std::max(deadline_ + period_, monotonic_now() - 20 * period_);
        sleeper_.wait_until(deadline_);
        tick.is_connected = device_.read(deadline_).connected;
        tick.seen = watched_.force().y;
        times.writes = monotonic_now();
        device_.write(deadline_, wanted);
        times.written = monotonic_now();
        const std::uint64_t cuts = cuts_of(device_.health());
        tick.cuts = cuts - std::exchange(cuts_, cuts);
        times.counted = monotonic_now();
        tick.is_even = even_.add(times, stalls_.any_since(even_.last()));
        writes_.add(times.written - times.writes);
        return tick;
    }
    void note(const Tick& tick) {
        figures_.cuts += tick.cuts;
        ++figures_.ticks;
        if (tick.is_even) {
            ++figures_.even_ticks;
            figures_.let_go_while_even += tick.cuts;
            asked_ += case_.newtons;
            displayed_ += tick.seen;
        }
    }

    const WatchedDevice& watched_;
    const DisplayedCase& case_;
    DriverDevice& device_;
    const ProcessorStalls& stalls_;
    DisplayedFigures& figures_;
    DurationHistogram& writes_;
    Sleeper sleeper_{SleepSettings{}};
    Nanoseconds period_;
    EvenTicks even_;
    Nanoseconds deadline_;
    double asked_ = 0.0, displayed_ = 0.0;
    std::uint64_t cuts_ = 0;
    Vec3 last_wanted_{0.0};
};

}  // namespace

std::string refusal(const WatchedDevice& watched, double rate) {
    DriverDevice device(watched.driver());
    device.set_pace({from_seconds(1.0 / rate), true});
    wait_until([&] { return device.health().phase == DriverHealth::Phase::running; });
    const std::string said = device.health().text;
    return said.find("gives no force") != std::string::npos ? said : std::string();
}

DisplayedFigures play_displayed(const WatchedDevice& watched, const DisplayedCase& c) {
    DisplayedFigures figures;
    DurationHistogram writes;
    std::vector<double> p50, p99;
    const BusyProcessors load(c.is_loaded ? 2 : 0);
    const ProcessorStalls stalls;
    const Nanoseconds period = from_seconds(1.0 / c.rate);
    const auto play = [&](DriverDevice& device) {
        const AsLoop as_loop;
        ContactLoop loop(watched, c, device, stalls, figures, writes);
        if (!loop.wait_for_hand()) {
            return;
        }
        ++figures.opened;
        loop.run(c.seconds);
        figures.over_asked_min = std::min(figures.over_asked_min, loop.over_asked());
        p50.push_back(1e-3 * device.delays().quantile(0.5));
        p99.push_back(1e-3 * device.delays().quantile(0.99));
        for (const Nanoseconds span : {3'000'000, 30'000'000}) {
            if (c.is_cut) {
                watched.take_most_step();
                loop.stop_for(span);
                loop.run(0.05);
                figures.return_step_max = std::max(figures.return_step_max, watched.take_most_step());
            }
        }
    };
    for (int phase = 0; phase < c.phases; ++phase) {
        const Nanoseconds whole = (monotonic_now() / period + 2) * period;
        SleepTimer().sleep_until(whole + phase * period / c.phases);
        DriverDevice device(watched.driver());
        device.set_pace({period, true});
        std::thread(play, std::ref(device)).join();
    }
    figures.delay_p50_us = quantile(p50, 0.5);
    figures.delay_p99_us = p99.empty() ? 0.0 : *std::max_element(p99.begin(), p99.end());
    figures.write_p50_us = 1e-3 * writes.quantile(0.5);
    figures.write_p99_us = 1e-3 * writes.quantile(0.99);
    return figures;
}

}  // namespace tactus::shared
