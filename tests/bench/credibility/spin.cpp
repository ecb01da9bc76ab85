// Bodies that spin freely, and a heavy top, against Euler's equations.
#include <vector>

#include "credibility/cases.hpp"

namespace tactus::bench {

namespace {

// Moments of a box of three different box_edges (unit: kilogram square meters).
constexpr double box_mass = 0.5;
constexpr Vec3 box_edges{0.04, 0.08, 0.12};
const Vec3 box_moments = box_mass / 12.0 *
                         Vec3(box_edges.y * box_edges.y + box_edges.z * box_edges.z,
                              box_edges.x* box_edges.x + box_edges.z * box_edges.z,
                              box_edges.x* box_edges.x + box_edges.y * box_edges.y);

PhysicsSettings weightless() {
    PhysicsSettings settings;
    settings.gravity = Vec3(0.0);
    return settings;
}

struct Free {
    explicit Free(const Vec3& velocity) : world(weightless()) {
        BodyDescription body = shared::box(box_edges, Vec3(0.0), box_mass);
        body.angular_velocity = velocity;
        id = enter(world, body);
    }
    Vec3 local_velocity() const {
        return glm::conjugate(world.pose(id).rotation) * world.angular_velocity(id);
    }
    Vec3 momentum() const { return world.pose(id).rotation * (box_moments * local_velocity()); }
    double energy() const {
        const Vec3 w = local_velocity();
        return 0.5 * glm::dot(w, box_moments * w);
    }
    PhysicsWorld world;
    BodyId id;
};

// Complete elliptic integral of the first kind, by the arithmetic-geometric mean: pi / (2 agm(1, k')).
double complete_elliptic(double modulus_squared) {
    double a = 1.0;
    double b = std::sqrt(1.0 - modulus_squared);
    while (std::abs(a - b) > 1e-15 * a) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return std::numbers::pi / (2.0 * a);
}

// Time from one flip to the next of a body that spins about its middle axis: half a period of w2, which is
// 4 K / p (Landau and Lifshitz, Mechanics, section 37). I1 < I2 < I3.
double flip_time(const Vec3& w, const Vec3& I) {
    const double twice_energy = glm::dot(w, I * w);
    const double m2 = glm::dot(I * w, I * w);
    double i1 = I.x;
    double i3 = I.z;
    if (m2 < twice_energy * I.y)
        std::swap(i1, i3);
    const double p = std::sqrt((i3 - I.y) * (m2 - twice_energy * i1) / (I.x * I.y * I.z));
    const double k2 = (I.y - i1) * (twice_energy * i3 - m2) / ((i3 - I.y) * (m2 - twice_energy * i1));
    return 2.0 * complete_elliptic(k2) / p;
}

// The largest change over a minute, in percent of the momentum and of the energy.
void keeps(Results& results, const std::string& name, const Vec3& velocity) {
    Free body(velocity);
    const Vec3 momentum = body.momentum();
    const double energy = body.energy();
    double momentum_drift = 0.0;
    double energy_drift = 0.0;
    run_until(body.world, 60.0, [&](double) {
        momentum_drift =
            std::max(momentum_drift, glm::distance(body.momentum(), momentum) / glm::length(momentum));
        energy_drift = std::max(energy_drift, std::abs(body.energy() / energy - 1.0));
        return false;
    });
    results.add(name + ".momentum_drift_60s", 100.0 * momentum_drift);
    results.add(name + ".energy_drift_60s", 100.0 * energy_drift);
}

void flips(Results& results) {
    // About the middle one of the box_moments, a little off. Edges x < y < z: box_moments x > y > z.
    const Vec3 velocity{0.05, 10.0, 0.0};
    Free body(velocity);
    std::vector<double> times;
    double before = body.local_velocity().y;
    run_until(body.world, 60.0, [&](double t) {
        const double now = body.local_velocity().y;
        if (now * before < 0.0)
            times.push_back(t);
        before = now;
        return false;
    });
    const double ours = times.size() > 1 ? (times.back() - times.front()) / (times.size() - 1.0) : 1e9;
    const Vec3 ascending{box_moments.z, box_moments.y, box_moments.x};
    add_case(results, "free_rotation.flip", ours, flip_time({velocity.z, velocity.y, velocity.x}, ascending));
}

// A disc on a rod whose end is held: steady precession, I1 W^2 cos - I3 w W + m g l = 0, the slow root.
void steady_top(Results& results, const std::string& name, double spin) {
    constexpr double radius = 0.03;
    constexpr double half_height = 0.005;
    constexpr double top_mass = 0.1;
    constexpr double arm = 0.0216;
    const double tilt = 0.5;
    const double along = 0.5 * top_mass * radius * radius;
    const double across = top_mass * (radius * radius / 4.0 + half_height * half_height / 3.0 + arm * arm);
    const double c = across * std::cos(tilt);
    const double weight = top_mass * gravity * arm;
    const double right =
        2.0 * weight / (along * spin + std::sqrt(along * spin * along * spin - 4.0 * c * weight));
    PhysicsWorld world;
    BodyDescription body = shared::box(Vec3(1.0), Vec3(0.0), top_mass);
    body.shapes = shared::one(CylinderShape{radius, half_height});
    body.pose.rotation = Quat(std::cos(0.5 * tilt), 0.0, 0.0, std::sin(0.5 * tilt));
    const Vec3 axis = body.pose.rotation * Vec3(0.0, 1.0, 0.0);
    body.pose.position = arm * axis;
    // w along the axis is `spin` in all: of its own and the part of the precession along it.
    body.angular_velocity = Vec3(0.0, right, 0.0) + (spin - right * std::cos(tilt)) * axis;
    body.linear_velocity = glm::cross(body.angular_velocity, body.pose.position);
    body.can_sleep = false;
    const BodyId id = enter(world, body);
    JointDescription pin;
    pin.kind = JointKind::Pin;
    world.add_joint(pin, id, BodyId{});
    constexpr double seconds = 5.0;
    double turned = 0.0;
    double before = std::atan2(-axis.z, axis.x);
    run_until(world, seconds, [&](double) {
        const Vec3 now = world.center_of_mass(id);
        const double angle = std::atan2(-now.z, now.x);
        turned += std::remainder(angle - before, 2.0 * std::numbers::pi);
        before = angle;
        return false;
    });
    add_case(results, name, turned / seconds, right);
}

}  // namespace

void measure_spin(Results& results) {
    keeps(results, "free_rotation", {3.0, 4.0, 5.0});
    keeps(results, "fast_rotation", {300.0, 400.0, 500.0});
    flips(results);
    steady_top(results, "top.precession", 200.0);
    steady_top(results, "top.precession_100", 100.0);
}

}  // namespace tactus::bench
