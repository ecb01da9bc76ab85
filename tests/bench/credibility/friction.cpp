// Friction of patches that slide and turn at once. Each case is the mean over 20 headings of the whole scene
// about the vertical. What is right comes from box_on_corners.hpp, and from closed forms where there are any;
// tools/credibility/mujoco_cases.py has the same bodies.
#include "credibility/box_on_corners.hpp"
#include "credibility/cases.hpp"

namespace tactus::bench {

namespace {

constexpr int placings = 20;

double heading_of(int i) {
    return 0.5 * std::numbers::pi * i / placings;
}

Quat about_y(double angle) {
    return {std::cos(0.5 * angle), 0.0, std::sin(0.5 * angle), 0.0};
}

struct Slide {
    double way = 0.0;        // (unit: meters)
    double spin_time = 0.0;  // until 1 % of the spin is left (unit: seconds)
};

Slide slide(BodyDescription body, double height, double speed, double spin, double heading) {
    PhysicsWorld world;
    enter(world, shared::ground(body.material.friction));
    body.pose.position.y = height;
    body.pose.rotation = about_y(heading);
    const BodyId id = enter(world, body);
    run_until(world, 0.2, [](double) { return false; });
    const Vec3 start = world.center_of_mass(id);
    world.set_velocity(id, about_y(heading) * Vec3(speed, 0.0, 0.0), {0.0, spin, 0.0});
    Slide result;
    run_until(world, 5.0, [&](double t) {
        if (result.spin_time == 0.0 && std::abs(world.angular_velocity(id).y) < 0.01 * spin)
            result.spin_time = t;
        return result.spin_time > 0.0 && glm::length(world.linear_velocity(id)) < 1e-3;
    });
    result.way = glm::distance(world.center_of_mass(id), start);
    return result;
}

Slide slide_by_equations(const Vec3& size, double mass, double friction, double speed, double spin) {
    BoxOnCorners box(size, mass, friction);
    box.velocity.x = speed;
    box.spin.y = spin;
    Slide result;
    for (int i = 1;
         i * BoxOnCorners::step < 5.0 && (result.spin_time == 0.0 || glm::length(box.velocity) >= 1e-3);
         ++i) {
        box.advance();
        if (result.spin_time == 0.0 && std::abs(box.spin.y) < 0.01 * spin)
            result.spin_time = i * BoxOnCorners::step;
    }
    result.way = glm::length(Vec3(box.place.x, 0.0, box.place.z));
    return result;
}

struct Push {
    double turn = 0.0;   // of the body (unit: radians)
    double force = 0.0;  // on the finger against its way, mean of the second half (unit: newtons)
};

constexpr double finger_radius = 0.005;  // (unit: meters)

double yaw_of(const Quat& rotation) {
    const Vec3 x = rotation * Vec3(1.0, 0.0, 0.0);
    return std::atan2(-x.z, x.x);
}

Push push_by_equations(const Vec3& size, double mass, double friction, double beside, double speed,
                       double seconds) {
    constexpr double step = BoxOnCorners::step;
    BoxOnCorners box(size, mass, friction);
    const Vec3 start(-0.5 * size.x - finger_radius, 0.5 * size.y, beside);
    const Vec3 velocity(speed, 0.0, 0.0);
    const int steps = static_cast<int>(seconds / step);
    Push result;
    for (int i = 0; i < steps; ++i) {
        const Vec3 force = box.push(start + (i + 1) * step * velocity, finger_radius, velocity);
        const double before = yaw_of(box.rotation);
        box.advance();
        result.turn += std::remainder(yaw_of(box.rotation) - before, 2.0 * std::numbers::pi);
        if (i >= steps / 2)
            result.force += force.x / (steps - steps / 2);
    }
    result.turn = std::abs(result.turn);
    return result;
}

// A frictionless finger pushes a box along a straight line beside its middle.
Push push(const Vec3& size, double mass, double friction, double beside, double speed, double seconds,
          double heading) {
    const Quat placed = about_y(heading);
    const double before = -0.5 * size.x - finger_radius;
    Stage stage(finger_radius, placed * Vec3(before - 0.002, 0.5 * size.y, beside));
    stage.add(shared::ground(friction), 5000.0, 0.0);
    BodyDescription box = shared::box(size, {0.0, 0.5 * size.y, 0.0}, mass, friction);
    box.pose.rotation = placed;
    const SessionHandle body = stage.add(box, 5000.0, 0.0);
    stage.wait(0.2);
    const int ticks = static_cast<int>(seconds / tick);
    Push result;
    double turned_before = heading;
    for (int i = 0; i < ticks; ++i) {
        stage.go(placed * Vec3(before + speed * (i + 1) * tick, 0.5 * size.y, beside));
        const double turned = yaw_of(stage.state(body).pose.rotation);
        result.turn += std::remainder(turned - turned_before, 2.0 * std::numbers::pi);
        turned_before = turned;
        if (i >= ticks / 2)
            result.force -= glm::dot(stage.hand.force, placed * Vec3(1.0, 0.0, 0.0)) / (ticks - ticks / 2);
    }
    result.turn = std::abs(result.turn);
    return result;
}

template <class Case>
double mean(Case&& measured) {
    double sum = 0.0;
    for (int i = 0; i < placings; ++i)
        sum += measured(heading_of(i));
    return sum / placings;
}

BodyDescription disc() {
    BodyDescription body = shared::box(Vec3(1.0), Vec3(0.0), 0.2, 0.4);
    body.shapes = shared::one(CylinderShape{0.05, 0.01});
    return body;
}

}  // namespace

void measure_friction(Results& results) {
    add_case(results, "push_off_center.turn",
             mean([](double heading) { return push(Vec3(0.1), 0.2, 1.0, 0.04, 0.1, 2.0, heading).turn; }),
             push_by_equations(Vec3(0.1), 0.2, 1.0, 0.04, 0.1, 2.0).turn);
    const Vec3 rod(0.02, 0.02, 0.3);
    add_case(results, "rod.force",
             mean([&](double heading) { return push(rod, 0.3, 0.4, 0.14, 0.1, 0.1, heading).force; }),
             push_by_equations(rod, 0.3, 0.4, 0.14, 0.1, 0.1).force);
    const BodyDescription cube = shared::box(Vec3(0.1), Vec3(0.0), 0.2, 0.4);
    const Slide slid = slide_by_equations(Vec3(0.1), 0.2, 0.4, 1.0, 20.0);
    add_case(results, "slide_spin.way",
             mean([&](double heading) { return slide(cube, 0.05, 1.0, 20.0, heading).way; }), slid.way);
    add_case(results, "slide_spin.spin_time",
             mean([&](double heading) { return slide(cube, 0.05, 1.0, 20.0, heading).spin_time; }),
             slid.spin_time);
    // A rigid body on a rigid floor bears its load at the corners of its outline: w I / (mu m g d), d their
    // distance from the middle, less the last hundredth of the spin.
    const BodyDescription square = shared::box({0.1, 0.02, 0.1}, Vec3(0.0), 0.2, 0.4);
    const double inverse_deceleration = 0.99 * 20.0 / (0.4 * gravity);
    const double of_disc = inverse_deceleration * 0.5 * 0.05;
    const double of_square = inverse_deceleration * 0.1 * 0.1 / 6.0 / (0.05 * std::numbers::sqrt2);
    add_case(results, "disc.stop",
             mean([](double heading) { return slide(disc(), 0.01, 0.0, 20.0, heading).spin_time; }), of_disc);
    add_case(results, "square.stop",
             mean([&](double heading) { return slide(square, 0.01, 0.0, 20.0, heading).spin_time; }),
             of_square);
    // Without spin: v^2 / (2 mu g).
    add_case(results, "slide.way",
             mean([&](double heading) { return slide(cube, 0.05, 1.5, 1e-9, heading).way; }),
             1.5 * 1.5 / (2.0 * 0.4 * gravity));
}

}  // namespace tactus::bench
