#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "platform/clock.hpp"
#include "platform/this_thread.hpp"
#include "realtime/tick_loop.hpp"
#include "sensing/sensing_figures.hpp"
#include "session/session.hpp"

namespace tactus::shared {

namespace {

constexpr int rounds = 5;
constexpr auto warm_up = std::chrono::milliseconds(300);
constexpr auto measured = std::chrono::seconds(3);
constexpr auto image_time = std::chrono::milliseconds(33);

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
        return static_cast<Touching*>(context)->session.tick(now);
    }

    StrokingHand hand;
    Session session{SessionSettings{}};
};

// Looks at the same images again and again, thirty a second, as a sensor's thread does.
class Looking {
public:
    Looking(const SensingCase& bench, bool is_on) {
        if (is_on) {
            thread_ = std::thread([this, &bench] { look(bench); });
        }
    }
    ~Looking() {
        ends_ = true;
        if (thread_.joinable()) {
            thread_.join();
        }
    }
    Looking(const Looking&) = delete;
    Looking& operator=(const Looking&) = delete;

private:
    void look(const SensingCase& bench) {
        work_in_background();
        const StillScene still(bench, bench.first, 0.85);
        std::vector<DepthImage> images;
        for (int i = 0; i < 8; ++i) {
            images.push_back(still.image(i));
        }
        Discovery discovery(bench.meshes, bench_settings(true));
        auto due = std::chrono::steady_clock::now();
        for (std::uint64_t i = 0; !ends_; ++i) {
            DepthImage& image = images[i % images.size()];
            image.time_us = 33'333 * (i + 1);
            discovery.update(image, still.scene.camera_pose);
            due += image_time;
            std::this_thread::sleep_until(due);
        }
    }

    std::atomic<bool> ends_{false};
    std::thread thread_;
};

// What 99 of 100 ticks take at most (unit: microseconds); below zero: there is no loop.
double tick_p99(const SensingCase& bench, const TriangleMesh& mesh, bool sees) {
    Touching touching(mesh);
    TickLoop loop;
    const Looking looking(bench, sees);
    std::this_thread::sleep_for(warm_up);
    if (const std::string error = loop.start({}, &Touching::tick, &touching); !error.empty()) {
        std::fprintf(stderr, "tick: %s\n", error.c_str());
        return -1.0;
    }
    std::this_thread::sleep_for(warm_up);
    loop.statistics().request_clear();
    std::this_thread::sleep_for(measured);
    loop.stop();
    return loop.statistics().figures().compute_p99_us;
}

}  // namespace

// In turns, each with the median of its rounds: what the rest of the machine takes varies.
void report_tick(Report& report, const SensingCase& bench) {
    const TriangleMesh& torus = bench.library[2].mesh;
    std::vector<double> on, off;
    for (int i = 0; i < rounds; ++i) {
        off.push_back(tick_p99(bench, torus, false));
        on.push_back(tick_p99(bench, torus, true));
    }
    const double with = quantile(on, 0.5), without = quantile(off, 0.5);
    if (!(without > 0.0) || !(with > 0.0)) {
        return;
    }
    report.set("tick_p99_on_us", with);
    report.set("tick_p99_off_us", without);
    report.set("tick_p99_on_over_off", with / without);
    std::printf("tick           p99 %.1f us with a sensor that looks, %.1f us without: %.2f\n", with, without,
                with / without);
}

}  // namespace tactus::shared
