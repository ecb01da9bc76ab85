// A hand, bodies and the ground together: light, small, stacked, squeezed, rolling and lifted things.
#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "physics/least_exact_mass.hpp"
#include "session_rig.hpp"

namespace tactus::coupling_test {
namespace {

using namespace session_test;

constexpr double seconds_a_tick = 1e-3;
constexpr double radius = 0.005;  // of the finger (unit: meters)

BodyAddition thing(const Shape& shape, const Vec3& position, double mass) {
    BodyAddition addition = body(shape, position, Motion::Dynamic, mass);
    addition.description.material.friction = 0.5;
    addition.touch_material = {1000.0, 0.0, 0.3, 0.3};
    return addition;
}

BodyAddition cube(double size, const Vec3& position, double mass) {
    return thing(BoxShape{Vec3(0.5 * size)}, position, mass);
}

// A finger of its own: device and proxy.
struct Finger {
    explicit Finger(Session& session) {
        Workspace workspace;
        workspace.force_limit = 1e6;
        ProxyDescription description;
        description.device = session.add_device(device, workspace).handle;
        description.settings.radius = radius;
        session.add_proxy(description);
    }
    void go(const Vec3& step) {
        device.position += step;
        device.velocity = step / seconds_a_tick;
    }
    HeldDevice device;
};

struct Table {
    explicit Table(int fingers = 1) {
        SessionSettings settings;
        settings.max_bodies = 32;
        session = std::make_unique<Session>(settings);
        for (int i = 0; i < fingers; ++i) {
            finger.push_back(std::make_unique<Finger>(*session));
        }
        BodyAddition floor = ground();
        floor.description.material.friction = 0.5;
        add(floor);
    }

    SessionHandle add(const BodyAddition& addition) {
        const AddResult result = session->add_body(addition);
        EXPECT_EQ(result.error, "");
        return result.handle;
    }

    void tick() {
        session->tick(now += period);
        session->refresh();
    }

    const ProxyState& proxy(std::size_t i = 0) const { return session->snapshot().proxies[i]; }

    Pose pose(SessionHandle handle) const {
        const SessionSnapshot& snapshot = session->snapshot();
        const BodyState* const state = state_of(snapshot.bodies, snapshot.body_count, handle);
        EXPECT_NE(state, nullptr) << "no such body";
        return state ? state->pose : Pose{};
    }

    std::unique_ptr<Session> session;
    std::vector<std::unique_ptr<Finger>> finger;
    Nanoseconds now = 0;
};

// What a hand feels over time.
struct Feel {
    void note(const Vec3& force, bool touching) {
        forces.push_back(glm::length(force));
        lost += touching ? 0 : 1;
    }
    double mean() const {
        double sum = 0.0;
        for (const double force : forces) {
            sum += force;
        }
        return sum / static_cast<double>(forces.size());
    }
    // RMS above 30 Hz (first-order high pass) over the mean.
    double noise() const {
        const double keep = 1.0 / (1.0 + 2.0 * std::numbers::pi * 30.0 * seconds_a_tick);
        double passed = 0.0;
        double square = 0.0;
        for (std::size_t i = 1; i < forces.size(); ++i) {
            passed = keep * (passed + forces[i] - forces[i - 1]);
            square += passed * passed / static_cast<double>(forces.size());
        }
        return std::sqrt(square) / mean();
    }

    std::vector<double> forces;  // (unit: newtons)
    int lost = 0;                // ticks without contact
};

// From the finger's surface to the face x = -half of a box, in the frame of the box.
double gap_to_side(const Pose& box, double half, const Vec3& proxy) {
    return std::abs(-half - radius - to_local(box, proxy).x);
}

struct Push {
    Feel feel;
    double gap = 0.0;    // largest (unit: meters)
    double moved = 0.0;  // of the body along x (unit: meters)
};

// Pushes along +x at 30 mm/s against the face of a box of `size` at `height`; the first half second is not
// looked at.
Push push(Table& table, SessionHandle box, double size, double height, double seconds) {
    Finger& finger = *table.finger[0];
    finger.device.position = table.pose(box).position - Vec3(0.5 * size + radius + 0.001, 0.0, 0.0);
    finger.device.position.y = height;
    finger.device.velocity = Vec3(0.0);
    table.tick();
    const double start = table.pose(box).position.x;
    Push result;
    for (int i = 0; i < static_cast<int>(seconds / seconds_a_tick); ++i) {
        finger.go({3e-5, 0.0, 0.0});
        table.tick();
        if (i >= 500) {
            const ProxyState& proxy = table.proxy();
            result.feel.note(proxy.force, proxy.contact_count > 0);
            result.gap = std::max(result.gap, gap_to_side(table.pose(box), 0.5 * size, proxy.position));
        }
    }
    result.moved = table.pose(box).position.x - start;
    return result;
}

TEST(Coupling, ABoxIsPushedForTenSecondsWithoutAGapOrATremor) {
    Table table;
    const SessionHandle box = table.add(cube(0.15, {0.0, 0.075, 0.0}, 1.0));
    table.tick();
    const Push result = push(table, box, 0.15, 0.06, 10.0);
    EXPECT_LE(result.gap, 10e-6);
    EXPECT_LE(result.feel.noise(), 0.01);
    EXPECT_EQ(result.feel.lost, 0);
    EXPECT_NEAR(result.feel.mean(), 0.5 * 9.81, 0.02 * 0.5 * 9.81);
}

TEST(Coupling, ABodyOfAFewGramsIsPushedAsSteadily) {
    Table table;
    const SessionHandle box = table.add(cube(0.02, {0.0, 0.01, 0.0}, 0.005));
    table.tick();
    const Push result = push(table, box, 0.02, 0.008, 5.0);
    EXPECT_LE(result.gap, 10e-6);
    EXPECT_LE(result.feel.noise(), 0.01);
    EXPECT_NEAR(result.feel.mean(), 0.5 * 0.005 * 9.81, 1e-3);
    EXPECT_EQ(result.feel.lost, 0);
}

TEST(Coupling, ABodyOfAFewMillimetresIsPushedAsSteadily) {
    Table table;
    const SessionHandle box = table.add(cube(0.008, {0.0, 0.004, 0.0}, 0.0005));
    table.tick();
    const Push result = push(table, box, 0.008, 0.0055, 5.0);
    EXPECT_LE(result.gap, 10e-6);
    EXPECT_LE(result.feel.noise(), 0.01);
    EXPECT_NEAR(result.feel.mean(), 0.5 * 0.0005 * 9.81, 1e-4);
    EXPECT_EQ(result.feel.lost, 0);
}

TEST(Coupling, AStackPushedFromTheSideComesAlong) {
    Table table;
    std::vector<SessionHandle> boxes;
    for (int i = 0; i < 3; ++i) {
        boxes.push_back(table.add(cube(0.1, {0.0, 0.05 + 0.1 * i, 0.0}, 0.4)));
    }
    table.tick();
    const Push result = push(table, boxes[0], 0.1, 0.05, 5.0);
    EXPECT_LE(result.gap, 10e-6);
    EXPECT_LE(result.feel.noise(), 0.01);
    EXPECT_EQ(result.feel.lost, 0);
    EXPECT_NEAR(result.feel.mean(), 0.5 * 1.2 * 9.81, 0.02 * 0.5 * 1.2 * 9.81);
    for (std::size_t i = 1; i < boxes.size(); ++i) {
        const Vec3 on_first = table.pose(boxes[i]).position - table.pose(boxes[0]).position;
        EXPECT_LT(glm::distance(on_first, Vec3(0.0, 0.1 * static_cast<double>(i), 0.0)), 5e-5);
    }
}

TEST(Coupling, ABoxSqueezedAgainstAWallRests) {
    Table table;
    BodyAddition wall = body(BoxShape{{0.05, 0.2, 0.2}}, {0.1, 0.1, 0.0}, Motion::Static);
    wall.description.material.friction = 0.5;
    table.add(wall);
    const SessionHandle box = table.add(cube(0.04, {0.03, 0.02, 0.0}, 0.06));
    Finger& finger = *table.finger[0];
    finger.device.position = {0.0, 0.022, 0.003};
    table.tick();
    for (int i = 0; i < 400; ++i) {
        finger.go({3.25e-5, 0.0, 0.0});  // to 8 N
        table.tick();
    }
    finger.go(Vec3(0.0));
    Vec3 low(1.0);
    Vec3 high(-1.0);
    Feel feel;
    for (int i = 0; i < 2000; ++i) {
        table.tick();
        if (i >= 500) {
            low = glm::min(low, table.pose(box).position);
            high = glm::max(high, table.pose(box).position);
            feel.note(table.proxy().force, table.proxy().contact_count > 0);
        }
    }
    EXPECT_LE(glm::length(high - low), 1e-6);
    EXPECT_LE(feel.noise(), 0.01);
    EXPECT_NEAR(feel.mean(), 8.0, 0.01);
    EXPECT_EQ(feel.lost, 0);
}

// Rolling between finger and ground without slipping. The fingertip, of radius r, does not turn: its center
// goes as the point of the ball, of radius R, that it touches. With p the angle of that point from the top
// (R + r) dp = R dx / R, so that when the ball has gone x, the finger is at x + (R + r) sin(x / (R + r)).
TEST(Coupling, ABallRollsUnderTheFinger) {
    Table table;
    BodyAddition ball = thing(SphereShape{0.02}, {0.0, 0.02, 0.0}, 0.05);
    ball.touch_material = {1000.0, 0.0, 0.8, 0.8};
    const SessionHandle handle = table.add(ball);
    Finger& finger = *table.finger[0];
    finger.device.position = {0.0, 0.046, 0.0};
    table.tick();
    for (int i = 0; i < 300; ++i) {
        finger.go({0.0, -1e-5, 0.0});  // to 2 N
        table.tick();
    }
    const double start = table.pose(handle).position.x;
    Feel feel;
    for (int i = 0; i < 500; ++i) {
        finger.go({3e-5, 0.0, 0.0});
        table.tick();
        feel.note(table.proxy().force, table.proxy().contact_count > 0);
    }
    EXPECT_EQ(feel.lost, 0);
    const double x = table.pose(handle).position.x - start;
    EXPECT_NEAR(x + (0.02 + radius) * std::sin(x / (0.02 + radius)), 0.015, 2e-4);
    EXPECT_LE(feel.noise(), 0.02);
    EXPECT_NEAR(table.pose(handle).position.z, 0.0, 1e-6);
}

// Pressed down and drawn along at once: hand, box and ground.
TEST(Coupling, ABoxIsDrawnAlongByAFingertipOnTop) {
    Table table;
    BodyAddition addition = cube(0.05, {0.0, 0.025, 0.0}, 0.1);
    addition.touch_material = {1000.0, 0.0, 0.9, 0.9};
    addition.description.material.friction = 0.2;
    const SessionHandle box = table.add(addition);
    Finger& finger = *table.finger[0];
    finger.device.position = {0.0, 0.056, 0.0};
    table.tick();
    for (int i = 0; i < 400; ++i) {
        finger.go({0.0, -1e-5, 0.0});  // to 3 N
        table.tick();
    }
    const Pose before = table.pose(box);
    Feel feel;
    for (int i = 0; i < 2000; ++i) {
        finger.go({3e-5, 0.0, 0.0});
        table.tick();
        if (i >= 500) {
            feel.note(table.proxy().force, table.proxy().contact_count > 0);
        }
    }
    const Pose after = table.pose(box);
    EXPECT_EQ(feel.lost, 0);
    EXPECT_LE(feel.noise(), 0.01);
    // 60 mm less what the spring needs for the friction on the ground: 0.2 (3 N + 0.1 kg g) / 1000 N/m.
    EXPECT_NEAR(after.position.x - before.position.x, 0.06 - 0.0008, 5e-5);
    EXPECT_NEAR(after.position.y, before.position.y, 1e-6);
}

// What a free body gets over what the hand feels, in a push at 0.1 m/s that begins at this phase of a tick.
double impulse_share(double mass, double stiffness, double damping, double phase) {
    Table table;
    table.session->set_gravity(Vec3(0.0));
    BodyAddition addition = thing(SphereShape{0.01}, {0.0, 1.0, 0.0}, mass);
    addition.touch_material = {stiffness, damping, 0.0, 0.0};
    const SessionHandle ball = table.add(addition);
    Finger& finger = *table.finger[0];
    const Vec3 step{1e-4, 0.0, 0.0};
    finger.device.position = Vec3(-0.02, 1.0, 0.0) - phase * step;
    table.tick();
    double felt = 0.0;
    for (int i = 0; i < 200; ++i) {
        finger.go(step);
        table.tick();
        felt -= finger.device.force.x * seconds_a_tick;
    }
    const SessionSnapshot& snapshot = table.session->snapshot();
    return mass * state_of(snapshot.bodies, snapshot.body_count, ball)->linear_velocity.x / felt;
}

TEST(Coupling, AFreeBodyOfAGramGetsTheImpulseThatTheHandFeels) {
    for (const double phase : {0.0, 0.3, 0.6, 0.9}) {
        EXPECT_NEAR(impulse_share(0.001, 1000.0, 0.0, phase), 1.0, 0.01) << phase;
        EXPECT_NEAR(impulse_share(0.001, 1500.0, 0.0, phase), 1.0, 0.02) << phase;
        EXPECT_NEAR(impulse_share(0.01, 500.0, 3.0, phase), 1.0, 0.01) << phase;
    }
}

TEST(Coupling, FromTheLeastExactMassOnAFreeBodyGetsThatImpulseWithinAPercent) {
    for (const double stiffness : {200.0, 900.0, 3000.0}) {
        for (const double damping : {0.0, 0.7, 10.0}) {
            const double least = least_exact_mass(stiffness, damping, seconds_a_tick);
            for (const double phase : {0.1, 0.35, 0.85}) {
                SCOPED_TRACE(::testing::Message() << stiffness << ' ' << damping << ' ' << phase);
                EXPECT_NEAR(impulse_share(least, stiffness, damping, phase), 1.0, 0.01);
                EXPECT_NEAR(impulse_share(0.51 * least, stiffness, damping, phase), 1.0, 0.02);
            }
        }
    }
}

// No faster than an elastic blow of the hand's speed.
TEST(Coupling, SeveralFingersGiveALightBodyNoMoreThanOne) {
    constexpr double speed = 0.1;
    for (const int fingers : {2, 3, 4}) {
        for (const double damping : {0.0, 3.0}) {
            for (const double share : {0.3, 0.6, 1.0, 1.5, 2.5}) {
                SCOPED_TRACE(::testing::Message() << fingers << ' ' << damping << ' ' << share);
                Table table(fingers);
                table.session->set_gravity(Vec3(0.0));
                const double mass = share * least_exact_mass(1000.0, damping, seconds_a_tick);
                BodyAddition addition = cube(0.06, {0.0, 1.0, 0.0}, mass);
                addition.touch_material = {1000.0, damping, 0.3, 0.3};
                const SessionHandle box = table.add(addition);
                for (int i = 0; i < fingers; ++i) {
                    table.finger[static_cast<std::size_t>(i)]->device.position = {
                        -0.04, i % 2 ? 0.985 : 1.015, i / 2 ? 0.015 : -0.015};
                }
                table.tick();
                for (int i = 0; i < 200; ++i) {
                    for (const auto& one : table.finger) {
                        one->go({speed * seconds_a_tick, 0.0, 0.0});
                    }
                    table.tick();
                }
                const SessionSnapshot& snapshot = table.session->snapshot();
                const BodyState* state = state_of(snapshot.bodies, snapshot.body_count, box);
                ASSERT_NE(state, nullptr);
                EXPECT_LT(glm::length(state->linear_velocity), 2.3 * speed);
            }
        }
    }
}

TEST(Coupling, TwoFingersLiftABox) {
    Table table(2);
    BodyAddition addition = cube(0.04, {0.0, 0.02, 0.0}, 0.05);
    addition.touch_material = {1000.0, 1.0, 0.9, 0.9};
    const SessionHandle box = table.add(addition);
    Finger& left = *table.finger[0];
    Finger& right = *table.finger[1];
    left.device.position = {-0.026, 0.022, 0.0};
    right.device.position = {0.026, 0.022, 0.0};
    table.tick();
    const auto both = [&](int ticks, const Vec3& inward, const Vec3& together) {
        for (int i = 0; i < ticks; ++i) {
            left.go(inward + together);
            right.go(-inward + together);
            table.tick();
        }
    };
    both(300, {1e-5, 0.0, 0.0}, Vec3(0.0));  // 2 N from each side
    const Pose before = table.pose(box);
    both(1000, Vec3(0.0), {0.0, 5e-5, 0.0});
    both(500, Vec3(0.0), Vec3(0.0));
    const Pose lifted = table.pose(box);
    Feel feel;
    Vec3 low(1.0), high(-1.0);
    for (int i = 0; i < 2000; ++i) {
        both(1, Vec3(0.0), Vec3(0.0));
        feel.note(table.proxy(0).force, table.proxy(0).contact_count > 0);
        low = glm::min(low, table.pose(box).position);
        high = glm::max(high, table.pose(box).position);
    }
    const Pose held = table.pose(box);
    EXPECT_EQ(feel.lost, 0);
    EXPECT_LE(feel.noise(), 0.01);
    // 50 mm less what two springs of 1000 N/m give way under 0.05 kg.
    EXPECT_NEAR(lifted.position.y - before.position.y, 0.05 - 0.5 * 0.05 * 9.81 / 1000.0, 5e-5);
    EXPECT_LE(glm::length(high - low), 1e-6);
    EXPECT_LE(glm::distance(held.position, lifted.position), 1e-6);
}

}  // namespace
}  // namespace tactus::coupling_test
