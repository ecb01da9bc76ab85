#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "platform/beside_loop.hpp"
#include "platform/clock.hpp"
#include "platform/this_thread.hpp"
#include "realtime/tick_loop.hpp"
#include "realtime/tick_statistics.hpp"
#include "sensing/sensing_figures.hpp"
#include "session/session.hpp"

namespace tactus::shared {

namespace {

constexpr int rounds = 9;
constexpr std::uint32_t turns = 128;  // a round
constexpr int images_in_turn = 4;
constexpr auto warm_up = std::chrono::milliseconds(300);
constexpr auto image_time = std::chrono::milliseconds(33);

// Whose ticks the running ones are; those of a turn's first image are nobody's, as the last turn's may still
// be looked at.
enum class Turn { Nobodys, Without, With };

// A hand that strokes a torus.
class StrokingHand final : public Device {
public:
    DeviceSample read(Nanoseconds now) override {
        const double t = to_seconds(now);
        DeviceSample sample;
        sample.connected = true;
        sample.position = {0.06 * std::cos(1.3 * t), 0.01 * std::sin(3.0 * t), 0.06 * std::sin(1.3 * t)};
        return sample;
    }
    void write(Nanoseconds, const Vec3&) override {}
};

struct Touching {
    explicit Touching(const TriangleMesh& mesh) {
        BodyAddition torus;
        torus.description.shapes = {{MeshShape{std::make_shared<const TriangleMesh>(mesh)}, Pose{}}};
        torus.description.motion = Motion::Static;
        torus.touch_material = {800.0, 1.0, 0.3, 0.2};
        session.add_body(torus);
        ProxyDescription pointer;
        pointer.device = session.add_device(hand, {}).handle;
        session.add_proxy(pointer);
        session.settle();
    }
    static TickStatus tick(void* context, Nanoseconds now) {
        return static_cast<Touching*>(context)->timed_tick(now);
    }
    TickStatus timed_tick(Nanoseconds now) {
        const Turn is = turn.load();
        const Nanoseconds start = monotonic_now();
        const TickStatus status = session.tick(now);
        const Nanoseconds span = monotonic_now() - start;
        if (is == turn.load() && is != Turn::Nobodys) {
            (is == Turn::With ? with : without).add(span);
        }
        return status;
    }

    StrokingHand hand;
    Session session{SessionSettings{}};
    std::atomic<Turn> turn{Turn::Nobodys};
    DurationHistogram with, without;
};

// Looks at the same images again and again, thirty a second, as a sensor's thread does, in every turn that
// the sequence of Thue and Morse gives it: what else the machine does, whatever its period, meets both kinds
// of turns alike.
class TurnsOfLooking {
public:
    explicit TurnsOfLooking(const SensingCase& bench)
        : still_(bench, bench.first, 0.85), discovery_(bench.meshes, bench_settings(true)) {
        for (int i = 0; i < 8; ++i) {
            images_.push_back(still_.image(i));
        }
    }

    void play(std::atomic<Turn>& turn) {
        work_in_background();
        auto due = std::chrono::steady_clock::now();
        for (std::uint32_t i = 0; i < turns; ++i) {
            const bool looks = std::popcount(i) % 2 != 0;
            for (int k = 0; k < images_in_turn; ++k) {
                turn = k == 0 ? Turn::Nobodys : looks ? Turn::With : Turn::Without;
                if (looks) {
                    look();
                }
                due += image_time;
                std::this_thread::sleep_until(due);
            }
        }
        turn = Turn::Nobodys;
    }

private:
    void look() {
        DepthImage& image = images_[seen_++ % images_.size()];
        image.time_us = 33'333 * seen_;
        beside_loop_.begin_burst();
        discovery_.update(image, still_.scene.camera_pose);
        beside_loop_.end_burst();
    }

    StillScene still_;
    Discovery discovery_;
    BesideLoop beside_loop_;
    std::vector<DepthImage> images_;
    std::uint64_t seen_ = 0;
};

struct TickTimes {
    double with_us = -1.0,
           without_us = -1.0;  // what 99 of 100 ticks take at most; below zero: there is no loop
};

TickTimes tick_times(const SensingCase& bench, const TriangleMesh& mesh) {
    Touching touching(mesh);
    TurnsOfLooking looking(bench);
    TickLoop loop;
    if (const std::string error = loop.start({}, &Touching::tick, &touching); !error.empty()) {
        std::fprintf(stderr, "tick: %s\n", error.c_str());
        return {};
    }
    std::this_thread::sleep_for(warm_up);
    std::thread sensor([&] { looking.play(touching.turn); });
    sensor.join();
    loop.stop();
    return {1e-3 * touching.with.quantile(0.99), 1e-3 * touching.without.quantile(0.99)};
}

}  // namespace

void report_tick(Report& report, const SensingCase& bench) {
    std::vector<double> with, without, ratios;
    for (int i = 0; i < rounds; ++i) {
        const TickTimes times = tick_times(bench, bench.library[2].mesh);
        if (!(times.with_us > 0.0) || !(times.without_us > 0.0)) {
            return;
        }
        with.push_back(times.with_us);
        without.push_back(times.without_us);
        ratios.push_back(times.with_us / times.without_us);
    }
    report.set("tick_p99_on_us", quantile(with, 0.5));
    report.set("tick_p99_off_us", quantile(without, 0.5));
    report.set("tick_p99_on_over_off", quantile(ratios, 0.5));
    std::printf("tick           p99 %.1f us with a sensor that looks, %.1f us without: %.2f\n",
                quantile(with, 0.5), quantile(without, 0.5), quantile(ratios, 0.5));
}

}  // namespace tactus::shared
