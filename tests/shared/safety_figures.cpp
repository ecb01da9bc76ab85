#include "shared/safety_figures.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "shared/random_values.hpp"

namespace tactus::shared {

namespace {

constexpr double rounding = 1e-9;  // relative

double maybe_wild(RandomValues& random, double value) {
    switch (random.below(4'000)) {
        case 0:
            return std::numeric_limits<double>::quiet_NaN();
        case 1:
            return std::numeric_limits<double>::infinity();
        case 2:
            return -1e300;
        default:
            return value;
    }
}

Vec3 maybe_wild(RandomValues& random, const Vec3& v) {
    return {maybe_wild(random, v.x), maybe_wild(random, v.y), maybe_wild(random, v.z)};
}

bool is_number(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

SafetySettings random_settings(RandomValues& random) {
    SafetySettings settings;
    settings.limits = {random.magnitude(10.0, 1e5), random.magnitude(1e-3, 10.0),
                       random.magnitude(0.1, 100.0)};
    settings.max_force = random.magnitude(0.1, 100.0);
    settings.max_speed = random.magnitude(1.0, 20.0);
    settings.ramp = random.flip() ? 0.0 : random.magnitude(1e-3, 1.0);
    settings.dead_man = random.flip() ? 0u : 1u + static_cast<std::uint32_t>(random.below(15));
    settings.passive = random.flip();
    settings.damping = random.between(0.0, 5.0);
    settings.max_damping = random.between(0.0, 20.0);
    return settings;
}

// How far `force` is from being a part of `before`, from nothing to all of it.
double way_from_letting_go(const Vec3& force, const Vec3& before) {
    double least = glm::length(force);
    for (double low = 0.0, high = 1.0, i = 0; i < 60; ++i) {
        const double a = low + (high - low) / 3.0;
        const double b = high - (high - low) / 3.0;
        const double from_a = glm::distance(force, before * a);
        const double from_b = glm::distance(force, before * b);
        least = std::min({least, from_a, from_b});
        (from_a < from_b ? high : low) = from_a < from_b ? b : a;
    }
    return std::min(least, glm::distance(force, before));
}

// Keeps its own account of what the hand was given.
class Judge {
public:
    bool approves(const SafetySettings& settings, const SafetySample& in, const SafeForce& out) {
        const Vec3 force = out.force;
        const bool read = in.connected && glm::length(in.position) < 1e6 && glm::length(in.velocity) < 1e6;
        const bool far = known_ && !(glm::distance(in.position, place_) <= settings.max_speed * in.seconds);
        const bool sound = read && !far && glm::length(in.velocity) <= settings.max_speed && in.enabled &&
                           (settings.dead_man == 0 || (in.buttons & settings.dead_man) != 0);
        known_ = read;
        place_ = in.position;
        tank_ = std::max(0.0, tank_ - settings.limits.power * in.seconds);
        if (!sound) {
            before_ = Vec3(0.0);
            return force == Vec3(0.0);
        }
        const double given = glm::dot(force, in.velocity) * in.seconds;
        const double step = settings.limits.slew * in.seconds;
        const bool fine = is_number(force) && glm::length(force) <= settings.max_force * (1.0 + rounding) &&
                          way_from_letting_go(force, before_) <= step * (1.0 + rounding) + 1e-12 &&
                          tank_ + given <= settings.limits.energy * (1.0 + rounding) + 1e-12;
        tank_ = std::max(0.0, tank_ + given);
        before_ = force;
        return fine;
    }

    // Other limits, another contact.
    void begin() { *this = {}; }

private:
    bool known_ = false;
    Vec3 place_{0.0};
    Vec3 before_{0.0};
    double tank_ = 0.0;
};

}  // namespace

void SafetyFigures::add(const SafetyFigures& other) {
    inputs += other.inputs;
    violations += other.violations;
    working += other.working;
}

SafetyFigures play_random_hand(std::uint64_t seed, std::int64_t inputs) {
    constexpr int episode = 2'000;
    RandomValues random(seed);
    SafetyFigures figures;
    SafetySettings settings;
    HandSafety safety;
    Judge judge;
    SafetySample in;
    double pace = 0.0;
    double strength = 0.0;
    Vec3 place(0.0), wanted(0.0);
    for (; figures.inputs < inputs; ++figures.inputs) {
        if (figures.inputs % episode == 0) {
            settings = random_settings(random);
            safety = {};
            judge.begin();
            in = {};
            in.seconds = random.magnitude(2.5e-4, 4e-3);
            place = Vec3(0.0);
            pace = random.magnitude(1e-3, 1.2) * settings.max_speed;
            strength = random.magnitude(1e-2, 1e3) * settings.max_force;
        }
        // The velocity is what the device says; the place goes its own way now and then.
        const Vec3 velocity = random.in_ball(pace);
        place += random.in_ball(pace) * in.seconds;
        in.velocity = maybe_wild(random, velocity);
        in.position = maybe_wild(random, place);
        wanted = random.flip() ? wanted : random.in_ball(strength);
        in.wanted = maybe_wild(random, wanted);
        in.connected = random.below(500) != 0;
        in.enabled = random.below(500) != 0;
        in.buttons = random.below(100) == 0 ? static_cast<std::uint32_t>(random.below(16)) : in.buttons;
        in.source = random.below(100) == 0 ? random.magnitude(1e-6, 1e-2) : 0.0;
        const SafeForce out = safety.pass(settings, in);
        figures.violations += judge.approves(settings, in, out) ? 0 : 1;
        figures.working += out.force != Vec3(0.0) ? 1 : 0;
    }
    return figures;
}

namespace {

// The hand that holds on (Choi and Tan 2004 give such values).
constexpr double hand_mass = 0.15;        // (unit: kilograms)
constexpr double hand_damping = 4.0;      // (unit: newton seconds per meter)
constexpr double hand_stiffness = 150.0;  // (unit: newtons per meter)
constexpr double press = 0.02;            // how deep the arm means to be (unit: meters)
constexpr double pressing = 2.0;          // for how long (unit: seconds)
constexpr double leaving = 0.4;           // and out again, until its end (unit: seconds)
constexpr double rest_speed = 2e-3;       // of a handle at rest (unit: meters per second)

struct Handle {
    double x = 0.005;  // before the wall, which is at 0 and below (unit: meters)
    double v = 0.0;    // (unit: meters per second)
};

// Implicit midpoint: exact in energy, so that what is made is the wall's doing.
Handle step_handle(const Handle& from, double intended, double force, double damping, double mass,
                   double seconds) {
    const double h = 0.5 * seconds;
    const double d = damping + hand_damping;
    const double pull = hand_stiffness * (intended - from.x - h * from.v) - d * from.v + force;
    const double acceleration = pull / (mass + h * d + h * h * hand_stiffness);
    return {from.x + seconds * (from.v + h * acceleration), from.v + seconds * acceleration};
}

}  // namespace

ContactFigures play_contact(const ContactCase& contact) {
    constexpr int parts = 20;  // of a tick
    const double seconds = contact.lag.seconds;
    const Wall wall =
        contact.limited ? safe_wall(contact.lag, contact.device_damping, contact.wall) : contact.wall;
    SafetySettings settings;
    settings.passive = contact.passive;
    settings.damping = contact.device_damping;
    settings.max_damping = contact.device_damping;
    HandSafety safety;
    Handle handle;
    const auto late = static_cast<std::size_t>(std::llround(contact.lag.delay / seconds));
    std::vector<Handle> past(late + 1, handle);
    ContactFigures figures;
    figures.stiffness_used = wall.stiffness;
    double created = 0.0;
    double fastest_at_end = 0.0;
    double before = handle.x;
    const auto ticks = static_cast<std::size_t>((pressing + leaving) / seconds);
    for (std::size_t tick = 0; tick < ticks; ++tick) {
        const double now = static_cast<double>(tick) * seconds;
        past[tick % past.size()] = {handle.x, (handle.x - before) / seconds};
        before = handle.x;
        const Handle& seen = past[(tick + 1) % past.size()];
        SafetySample in;
        in.position.x = handle.x;
        in.velocity.x = past[tick % past.size()].v;
        in.wanted.x = seen.x < 0.0 ? std::max(0.0, -wall.stiffness * seen.x - wall.damping * seen.v) : 0.0;
        in.seconds = seconds;
        const double force = safety.pass(settings, in).force.x;
        const double intended = now < pressing ? -press : press;
        for (int part = 0; part < parts; ++part) {
            const double step = seconds / parts;
            const Handle next = step_handle(handle, intended, force, contact.device_damping,
                                            contact.device_mass + hand_mass, step);
            const double way = next.x - handle.x;
            created += force * way - contact.device_damping * way * way / step;
            handle = next;
        }
        figures.largest_created = std::max(figures.largest_created, created);
        if (now > 0.8 * pressing && now < pressing) {
            fastest_at_end = std::max(fastest_at_end, std::abs(handle.v));
        }
    }
    figures.energy_created = std::max(0.0, created);
    figures.stable = fastest_at_end < rest_speed;
    return figures;
}

}  // namespace tactus::shared
