// Bodies that roll on each other.
#include <algorithm>
#include <glm/gtc/quaternion.hpp>

#include "credibility/cases.hpp"

namespace tactus::bench {

namespace {

// A ball rolls on a table that turns: in a circle, at 2/7 of the table's rate, wherever it begins.
void on_turntable(Results& results) {
    constexpr double rate = 5.0, radius = 0.03, speed = 0.1, from_axis = 0.2, seconds = 4.0;
    PhysicsWorld world;
    BodyDescription table = shared::box({2.0, 0.1, 2.0}, {0.0, -0.05, 0.0}, 1.0);
    table.motion = Motion::Kinematic;
    table.angular_velocity = {0.0, rate, 0.0};
    enter(world, table);
    BodyDescription ball = shared::ball(radius, {from_axis, radius, 0.0}, 0.1);
    ball.linear_velocity = {0.0, 0.0, speed};
    // v - w x r is the table's velocity, (0, 0, -rate * from_axis).
    ball.angular_velocity = {(speed + rate * from_axis) / radius, 0.0, 0.0};
    const BodyId id = enter(world, ball);
    double turned = 0.0;
    Vec3 before = ball.linear_velocity;
    run_until(world, seconds, [&](double) {
        const Vec3 now = world.linear_velocity(id);
        turned += std::remainder(std::atan2(-now.z, now.x) - std::atan2(-before.z, before.x),
                                 2.0 * std::numbers::pi);
        before = now;
        return false;
    });
    add_case(results, "turntable.rate", turned / seconds, 2.0 / 7.0 * rate);
}

// A box of half height h rocks on a cylinder of radius R that does not turn. Small swings have
// w^2 = m g (R - h) / (I + m h^2), and nothing takes or gives energy.
void rocking(Results& results) {
    constexpr double radius = 0.1, half_height = 0.05, half_width = 0.1, angle = 0.05;
    PhysicsWorld world;
    BodyDescription round = shared::ball(radius, {0.0, -radius, 0.0}, 1.0);
    round.shapes = shared::one(CylinderShape{radius, 0.2});
    round.pose.rotation = glm::angleAxis(0.5 * std::numbers::pi, Vec3(1.0, 0.0, 0.0));
    round.motion = Motion::Static;
    enter(world, round);
    const Vec3 normal(std::sin(angle), std::cos(angle), 0.0);
    BodyDescription box = shared::box({2.0 * half_width, 2.0 * half_height, 0.1}, Vec3(0.0), 0.5);
    box.pose.position = Vec3(0.0, -radius, 0.0) + (radius + half_height) * normal -
                        radius * angle * Vec3(normal.y, -normal.x, 0.0);
    box.pose.rotation = glm::angleAxis(-angle, Vec3(0.0, 0.0, 1.0));
    box.can_sleep = false;
    const BodyId id = enter(world, box);
    double before = angle, most = 0.0, swing = 0.0, first = 0.0, last = 0.0;
    int crossings = 0;
    run_until(world, 20.0, [&](double t) {
        const Quat turned = world.pose(id).rotation;
        const double now = -2.0 * std::atan2(turned.z, turned.w);
        if (before * now < 0.0) {
            (crossings++ == 0 ? first : last) = t;
            swing = most;
            most = 0.0;
        }
        most = std::max(most, std::abs(now));
        before = now;
        return false;
    });
    const double moment = (half_width * half_width + half_height * half_height) / 3.0;
    add_case(results, "rocking.period", 2.0 * (last - first) / (crossings - 1),
             2.0 * std::numbers::pi *
                 std::sqrt((moment + half_height * half_height) / (gravity * (radius - half_height))));
    add_case(results, "rocking.swing_20s", swing, angle);
}

}  // namespace

void measure_rolling_bodies(Results& results) {
    on_turntable(results);
    rocking(results);
}

}  // namespace tactus::bench
