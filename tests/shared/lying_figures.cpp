#include "shared/lying_figures.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <thread>
#include <utility>

#include "platform/clock.hpp"
#include "realtime/sleeper.hpp"
#include "session/session.hpp"
#include "shared/driver_figures.hpp"

namespace tactus::shared {

namespace {

constexpr Nanoseconds ms = 1'000'000;
constexpr Nanoseconds look_often = 20'000;
constexpr Nanoseconds longest_return = 5'000 * ms;
constexpr double radius = 0.006;  // of the sphere, whose middle lies on the floor in the end (unit: meters)
constexpr double lower = 0.02;    // the floor, at first (unit: meters)

}  // namespace

// A session that ticks by itself.
class LyingHand::Room {
public:
    explicit Room(std::unique_ptr<Driver> driver) : device_(std::move(driver)), thread_([this] { run(); }) {}
    ~Room() {
        end_ = true;
        thread_.join();
    }

    DriverDevice& device() { return device_; }
    const std::atomic<bool>& is_ready() const { return is_ready_; }
    double slew() const { return slew_; }

private:
    // The floor is below where the device says that its hand is.
    SessionHandle build(Session& session, const Vec3& hand) {
        BodyAddition floor;
        floor.description.shapes = {{BoxShape{Vec3(0.5, 0.05, 0.5)}, Pose{}}};
        floor.description.pose.position = hand - Vec3(0.0, 0.05 + lower, 0.0);
        floor.description.motion = Motion::Static;
        floor.touch_material = {2'000.0, 0.0, 0.0, 0.0};
        const SessionHandle added = session.add_body(floor).handle;
        ProxyDescription pointer;
        Workspace workspace;
        workspace.force_limit = 100.0;
        workspace.dead_man = 1;
        pointer.device = session.add_device(device_, workspace).handle;
        pointer.settings.radius = radius;
        session.add_proxy(pointer);
        return added;
    }
    void run() {
        const AsLoop as_loop;
        Sleeper sleeper{SleepSettings{}};
        Nanoseconds tick = monotonic_now();
        const auto wait = [&] {
            tick = std::max(tick + ms, monotonic_now() - 20 * ms);
            sleeper.wait_until(tick);
        };
        DeviceSample sample;
        while (!end_ && !sample.connected) {
            wait();
            sample = device_.read(tick);
        }
        // The hand stays, and the floor comes up to it.
        constexpr int rising = 200;  // ticks
        Session session{SessionSettings{}};
        const SessionHandle floor = build(session, sample.position);
        slew_ = device_.capabilities().max_slew;
        for (int ticks = 0; !end_; ++ticks) {
            wait();
            if (ticks <= rising) {
                const double left = lower * (1.0 - static_cast<double>(ticks) / rising);
                const Vec3 below(0.0, 0.05 + left, 0.0);
                session.move_body(floor, {sample.position - below, Quat(1.0, 0.0, 0.0, 0.0)}, 1e-3);
            }
            session.tick(tick);
            session.collect();
            is_ready_ = ticks > rising;
        }
        session.rest();
    }

    DriverDevice device_;
    std::atomic<bool> end_{false}, is_ready_{false};
    std::atomic<double> slew_{0.0};
    std::thread thread_;
};

LyingHand::LyingHand(const LyingDevice& device)
    : device_(device), room_(std::make_unique<Room>(device.watched.driver())) {
    device_.tell(stand_ins::Field::position, stand_ins::Lie::none);
}

LyingHand::~LyingHand() = default;

double LyingHand::slew() const {
    return room_->slew();
}

bool LyingHand::is_there() const {
    return wait_until(
        [this] { return room_->is_ready().load() && glm::length(device_.watched.force()) > 1.0; });
}

LyingFigures LyingHand::play(stand_ins::Field field, stand_ins::Lie lie) {
    LyingFigures figures;
    SleepTimer timer;
    const auto force = [this] { return glm::length(device_.watched.force()); };
    // Until it grows no more.
    double before = -1.0;
    wait_until([&] {
        timer.sleep_until(monotonic_now() + 20 * ms);
        const double last = std::exchange(before, force());
        return before > 1.0 && std::abs(before - last) < 0.02 * before;
    });
    figures.force = before;
    device_.tell(field, lie);
    const Nanoseconds began = monotonic_now();
    const Nanoseconds longest = is_nonsense(device_, field, lie) ? longest_return : 30 * ms;
    while (monotonic_now() < began + longest) {
        if (force() == 0.0) {
            const Nanoseconds zero = monotonic_now(), told = device_.told_at();
            figures.to_zero_ms = 1e3 * to_seconds(zero - (told != 0 ? told : began));
            break;
        }
        timer.sleep_until(monotonic_now() + look_often);
    }
    figures.was_even = !stalls_.any_since(began);
    device_.watched.take_most_step();
    const Nanoseconds lied = monotonic_now();
    while (monotonic_now() < lied + 30 * ms) {
        figures.while_lying_max = std::max(figures.while_lying_max, force());
        timer.sleep_until(monotonic_now() + look_often);
    }
    device_.tell(field, stand_ins::Lie::none);
    figures.has_returned = wait_until([&] { return force() > 0.8 * figures.force; }, longest_return);
    figures.return_step_max = device_.watched.take_most_step();
    return figures;
}

}  // namespace tactus::shared
