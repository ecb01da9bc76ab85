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

// The loop, and what it sees of the device just before it writes.
class ContactLoop {
public:
    ContactLoop(const WatchedDevice& watched, const DisplayedCase& c, DriverDevice& device,
                const ProcessorStalls& stalls, DisplayedFigures& figures, std::vector<double>& writes)
        : watched_(watched), case_(c), device_(device), stalls_(stalls), figures_(figures), writes_(writes) {}

    bool wait_for_hand() {
        for (const Nanoseconds end = monotonic_now() + 5'000'000'000; monotonic_now() < end;) {
            if (tick(Vec3(0.0)).connected) {
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
            tick(wanted);
            note();
        }
    }
    // As the safety layer lets a force grow.
    void grow(const Vec3& wanted) {
        for (int i = 1; i <= 20; ++i) {
            tick(wanted * (i / 20.0));
        }
        cuts_ = cuts_of(device_.health());
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
    DeviceSample tick(const Vec3& wanted) {
        const Nanoseconds period = from_seconds(1.0 / case_.rate);
        deadline_ = std::max(deadline_ + period, monotonic_now() - 20 * period);
        sleeper_.wait_until(deadline_);
        const DeviceSample sample = device_.read(deadline_);
        seen_ = watched_.force().y;
        const Nanoseconds before = monotonic_now();
        device_.write(deadline_, wanted);
        const Nanoseconds written = monotonic_now();
        writes_.push_back(1e-3 * static_cast<double>(written - before));
        // A force lives for at least 1.5 ms, or for half a period more than one.
        const Nanoseconds late = std::max<Nanoseconds>(1'400'000, period * 11 / 10);
        const bool is_late = written - last_ > late || stalls_.any_since(last_);
        since_late_ = is_late ? 0 : since_late_ + 1;
        last_ = written;
        return sample;
    }
    void note() {
        const std::uint64_t cuts = cuts_of(device_.health());
        const std::uint64_t news = cuts - std::exchange(cuts_, cuts);
        figures_.cuts += news;
        ++figures_.ticks;
        if (since_late_ > 10) {
            ++figures_.even_ticks;
            figures_.let_go_while_even += news;
            asked_ += case_.newtons;
            displayed_ += seen_;
        }
    }

    const WatchedDevice& watched_;
    const DisplayedCase& case_;
    DriverDevice& device_;
    const ProcessorStalls& stalls_;
    DisplayedFigures& figures_;
    std::vector<double>& writes_;
    Sleeper sleeper_{SleepSettings{}};
    Nanoseconds deadline_ = monotonic_now() / from_seconds(1.0 / case_.rate) * from_seconds(1.0 / case_.rate);
    Nanoseconds last_ = 0;
    double asked_ = 0.0, displayed_ = 0.0, seen_ = 0.0;
    std::uint64_t cuts_ = 0;
    int since_late_ = 0;  // ticks
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
    std::vector<double> writes, p50, p99;
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
    figures.write_p50_us = quantile(writes, 0.5);
    figures.write_p99_us = quantile(writes, 0.99);
    return figures;
}

}  // namespace tactus::shared
