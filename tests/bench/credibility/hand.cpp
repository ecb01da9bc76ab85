// What a hand does to free bodies, and what it gets back from them.
#include <array>
#include <vector>

#include "credibility/cases.hpp"

namespace tactus::bench {

namespace {

// A finger that does not turn rolls a ball between itself and the floor: the ball goes half its way.
double rolled(double finger_radius) {
    constexpr double radius = 0.03;
    const double over = 2.0 * radius + finger_radius;
    Stage stage(finger_radius, {0.0, over + 0.001, 0.0});
    stage.add(shared::ground(1.0), 1000.0, 1.0);
    const SessionHandle ball = stage.add(shared::ball(radius, {0.0, radius, 0.0}, 0.1, 1.0), 1000.0, 1.0);
    stage.wait(0.1);
    for (int i = 1; i <= 100; ++i)
        stage.go({0.0, over + 0.001 - 3e-5 * i, 0.0});
    stage.wait(0.1);
    const double start = stage.state(ball).pose.position.x;
    const Vec3 from = stage.hand.position;
    constexpr double way = 0.02;
    for (int i = 1; i <= 400; ++i)
        stage.go(from + Vec3(way * i / 400.0, 0.0, 0.0));
    stage.wait(0.1);
    return (stage.state(ball).pose.position.x - start) / way;
}

// A hinged wheel turns at 5 rad/s; a finger that sticks is drawn along by its rim and gives way as a mass
// does. The most that the hand has got, over what the wheel had.
double braked(double finger_radius) {
    constexpr double radius = 0.02;
    constexpr double inertia = 1e-4;
    constexpr double spin = 5.0;
    constexpr double hand_mass = 0.25;
    constexpr double depth = 2e-4;
    Stage stage(finger_radius, {0.0, radius + finger_radius + 0.001, 0.0}, Vec3(0.0));
    BodyDescription wheel = shared::ball(radius, Vec3(0.0), 0.2);
    const Quat along_z(std::sqrt(0.5), std::sqrt(0.5), 0.0, 0.0);
    wheel.shapes = {PlacedShape{CylinderShape{radius, 0.02}, Pose{Vec3(0.0), along_z}}};
    wheel.inertia = Vec3(inertia);
    wheel.can_sleep = false;
    const SessionHandle body = stage.add(wheel, 2000.0, 5.0);
    JointDescription hinge;
    hinge.kind = JointKind::Hinge;
    hinge.angular[2] = JointRange::free();
    stage.session().add_joint(hinge, body, no_handle);
    stage.wait(0.01);
    stage.session().set_body_velocity(body, Vec3(0.0), {0.0, 0.0, -spin});
    double best = 0.0;
    Vec3 velocity(0.0);
    for (int i = 0; i < 300; ++i) {
        velocity.x += stage.hand.force.x / hand_mass * tick;
        const double height =
            radius + finger_radius + std::max(-depth, 0.001 - 0.1 * tick * static_cast<double>(i));
        stage.go({stage.hand.position.x + velocity.x * tick, height, 0.0});
        best = std::max(best, stage.work());
    }
    return best / (0.5 * inertia * spin * spin);
}

// Impulse that a free body has got, over what the hand gave: a finger runs into it at 0.1 m/s. `phase`: of
// the tick in which they meet, 0 to 1.
double pushed(double mass, double stiffness, double damping, double phase) {
    Stage stage(0.005, {-0.02 - 0.1 * tick * phase, 0.0, 0.0}, Vec3(0.0));
    BodyAddition addition;
    addition.description = shared::ball(0.01, Vec3(0.0), mass);
    addition.touch_material.stiffness = stiffness;
    addition.touch_material.damping = damping;
    const SessionHandle body = stage.session().add_body(addition).handle;
    double given = 0.0;
    for (int i = 0; i < 200; ++i) {
        given -= stage.hand.force.x * tick;
        stage.go(stage.hand.position + Vec3(0.1 * tick, 0.0, 0.0));
    }
    // The force of the last tick acts on the body in that tick.
    given -= stage.hand.force.x * tick;
    return mass * stage.state(body).linear_velocity.x / given;
}

// What a path gave a hand: with the force that a device holds for a tick, with the mean of two ticks, and by
// a device that has motors and friction of its own.
struct Given {
    double held = 0.0, between = 0.0, handle = 0.0;  // (unit: joules)
};

// As the driver of an Inverse3 declares it.
DeviceCapabilities with_motors() {
    DeviceCapabilities device;
    device.feels = true;
    device.damping = 2.0;
    device.max_damping = 10.0;
    return device;
}

// A hand goes round a block that stands still and comes back to where it was: no such way may give work.
// `damping`: of the surface, in k dt / 2.
Given closed_path(int i, double damping = 0.0, Nanoseconds period = 1'000'000,
                  const DeviceCapabilities& device = {}) {
    const std::array<double, 5> depths{0.003, 0.008, 0.012, 0.015, 0.02};
    const std::array<double, 2> radii{0.002, 0.005};
    const std::array<double, 2> speeds{0.1, 0.4};
    const std::array<double, 2> stiffnesses{500.0, 3000.0};
    const double depth = depths[static_cast<std::size_t>(i) % 5];
    const double radius = radii[static_cast<std::size_t>(i / 5) % 2];
    const double speed = speeds[static_cast<std::size_t>(i / 10) % 2];
    const double stiffness = stiffnesses[static_cast<std::size_t>(i / 20) % 2];
    Stage stage(radius, {0.0, 0.05, 0.0}, Vec3(0.0), device, period);
    const double step = speed * stage.seconds_a_tick();
    BodyDescription block = shared::box({0.1, 0.06, 0.1}, Vec3(0.0), 1.0);
    block.motion = Motion::Static;
    stage.add(block, stiffness, 0.0, damping * 0.5 * stiffness * stage.seconds_a_tick());
    stage.wait(0.01);
    Given most;
    const auto to = [&](const Vec3& target) {
        const Vec3 from = stage.hand.position;
        const int ticks = std::max(1, static_cast<int>(glm::distance(from, target) / step));
        for (int k = 1; k <= ticks; ++k)
            stage.go(from + (target - from) * (static_cast<double>(k) / ticks));
    };
    const double down = 0.03 + radius - depth;
    for (int loop = 0; loop < 3; ++loop) {
        const Given before{stage.work(), stage.work_between_ticks(), stage.work_at_handle()};
        to({0.0, down, 0.0});
        to({0.049, down, 0.0});
        to({0.07, down, 0.0});
        to({0.08, 0.05, 0.0});
        to({0.0, 0.05, 0.0});
        most = {std::max(most.held, stage.work() - before.held),
                std::max(most.between, stage.work_between_ticks() - before.between),
                std::max(most.handle, stage.work_at_handle() - before.handle)};
    }
    return most;
}

// A cube on ice pushed by the hand's spring: F = m a.
double accelerated() {
    Stage stage(0.005, {-0.06, 0.05, 0.0});
    stage.add(shared::ground(0.4), 1000.0, 0.0);
    const SessionHandle body = stage.add(shared::box(Vec3(0.1), {0.0, 0.05, 0.0}, 0.5, 0.4), 1000.0, 0.0);
    stage.wait(0.1);
    double impulse = 0.0;
    double moving_from = 0.0;
    double velocity_then = 0.0;
    for (int i = 0; i < 600; ++i) {
        const double t = i * tick;
        stage.go({-0.06 + 0.5 * t * t, 0.05, 0.0});
        if (t > 0.3) {
            if (moving_from == 0.0) {
                moving_from = t;
                velocity_then = stage.state(body).linear_velocity.x;
                continue;
            }
            impulse -= stage.hand.force.x * tick;
        }
    }
    const double seconds = 599 * tick - moving_from;
    return impulse /
           (0.5 * (stage.state(body).linear_velocity.x - velocity_then) + 0.4 * 0.5 * gravity * seconds);
}

}  // namespace

void measure_hand(Results& results) {
    double worst = 0.0;
    for (const double radius : {0.002, 0.01, 0.02}) {
        const double ours = rolled(radius);
        results.add("roll.way_ratio_r" + std::to_string(static_cast<int>(radius * 1e3)) + "mm.ours", ours);
        worst = std::max(worst, deviation(ours, 0.5));
    }
    results.add("roll.way_ratio", worst);
    double most = 0.0;
    for (const double radius : {0.002, 0.01, 0.02})
        most = std::max(most, braked(radius));
    results.add("wheel.energy_over_stored", most);
    for (const auto& [name, mass] :
         {std::pair{"_1g", 0.001}, std::pair{"_10g", 0.01}, std::pair{"_1kg", 1.0}}) {
        double plain = 0.0, damped = 0.0;
        for (const double phase : {0.0, 0.3, 0.6, 0.9}) {
            for (const double stiffness : {500.0, 1000.0, 2000.0})
                plain = std::max(plain, deviation(pushed(mass, stiffness, 0.0, phase), 1.0));
            damped = std::max(damped, deviation(pushed(mass, 500.0, 3.0, phase), 1.0));
        }
        results.add(std::string("light.impulse") + name, plain);
        results.add(std::string("light.impulse_damped") + name, damped);
    }
    Given created;
    double at_2khz = 0.0;
    double damped = 0.0;
    for (int i = 0; i < 40; ++i) {
        const Given path = closed_path(i);
        created = {std::max(created.held, path.held), std::max(created.between, path.between),
                   std::max(created.handle, closed_path(i, 0.0, 1'000'000, with_motors()).handle)};
        at_2khz = std::max(at_2khz, closed_path(i, 0.0, 500'000).held);
        damped = std::max(damped, closed_path(i, 1.0).held);
    }
    results.add("closed_path_energy_created_max_J", created.held);
    results.add("closed_path_energy_created_2khz_max_J", at_2khz);
    results.add("closed_path_energy_damped_max_J", damped);
    results.add("closed_path_energy_between_ticks_max_J", created.between);
    results.add("closed_path_energy_at_handle_max_J", created.handle);
    results.add("push.force", deviation(accelerated(), 1.0));
}

}  // namespace tactus::bench
