// Fingers on bodies: the figures a hand would feel. A finger here is a spring between the hand and a place on
// the body.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "physics/physics_world.hpp"
#include "scene.hpp"

namespace tactus::hand_contact_test {
namespace {

using namespace scene;

constexpr double density = 1000.0;  // (unit: kilograms per cubic meter)

BodyDescription cube(double edge, const Vec3& position, double friction = 0.5) {
    BodyDescription body = box(Vec3(edge), position, density * edge * edge * edge);
    body.material.friction = friction;
    return body;
}

// Largest way that any corner of a cube moves to and fro.
class Restlessness {
public:
    void look(const Pose& pose, double edge) {
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 side((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                            (corner & 4) != 0 ? 0.5 : -0.5);
            const Vec3 now = to_parent(pose, edge * side);
            low_[corner] = seen_ ? glm::min(low_[corner], now) : now;
            high_[corner] = seen_ ? glm::max(high_[corner], now) : now;
        }
        seen_ = true;
    }
    double peak_to_peak() const {
        double most = 0.0;
        for (int corner = 0; corner < 8; ++corner)
            most = std::max(most, glm::length(high_[corner] - low_[corner]));
        return most;
    }

private:
    Vec3 low_[8], high_[8];
    bool seen_ = false;
};

// A hand held still so far inside the cube that its spring presses with `force`.
double pressed_restlessness(double edge, const Vec3& force, const Vec3& local_point) {
    constexpr double stiffness = 1000.0;
    PhysicsWorld world;
    add(world, ground());
    const Vec3 start{0.3, 0.5 * edge, 0.1};
    const BodyId id = add(world, cube(edge, start));
    const Vec3 hand = start + edge * local_point + force / stiffness;
    Restlessness rest;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 point = to_parent(world.pose(id), local_point * edge);
        world.apply_spring_force(id, {stiffness * (hand - point), point, stiffness});
        world.step(tick);
        if (i >= 2000)
            rest.look(world.pose(id), edge);
    }
    return rest.peak_to_peak();
}

TEST(HandContact, PressedCubesRestWithinAMicrometre) {
    for (const double edge : {0.15, 0.02, 0.005}) {
        EXPECT_LT(pressed_restlessness(edge, {0.0, -8.0, 0.0}, {0.0, 0.5, 0.0}), 1e-6) << edge;
        EXPECT_LT(pressed_restlessness(edge, {0.0, -8.0, 0.0}, {0.2, 0.5, 0.1}), 1e-6) << edge;
        EXPECT_LT(pressed_restlessness(edge, {2.0, -8.0, 0.0}, {0.1, 0.5, 0.0}), 1e-6) << edge;
    }
}

struct Push {
    double mean_force = 0.0;  // (unit: newtons)
    double noise = 0.0;       // above 30 Hz, RMS (unit: newtons)
    int ticks_lost = 0;
};

// Pushes a cube over the ground at 30 mm/s for four seconds and looks at the last three.
Push pushed(double edge, double stiffness) {
    PhysicsWorld world;
    add(world, ground());
    BodyDescription description = cube(edge, {0.0, 0.5 * edge, 0.0});
    const BodyId id = add(world, description);
    const Vec3 velocity{0.03, 0.0, 0.0};
    double hand = -0.5 * edge;
    std::vector<double> forces;
    Push result;
    for (int i = 0; i < 4000; ++i) {
        hand += velocity.x * tick;
        const Vec3 point = to_parent(world.pose(id), Vec3(-0.5, -0.1, 0.0) * edge);
        const double force = std::max(0.0, stiffness * (hand - point.x));
        world.apply_spring_force(id, {{force, 0.0, 0.0}, point, stiffness, 0.0, velocity});
        world.step(tick);
        if (i < 1000)
            continue;
        forces.push_back(force);
        result.ticks_lost += force > 0.0 ? 0 : 1;
    }
    for (const double force : forces)
        result.mean_force += force / static_cast<double>(forces.size());
    // First-order high pass.
    const double keep = 1.0 / (1.0 + 2.0 * std::numbers::pi * 30.0 * tick);
    double passed = 0.0;
    for (std::size_t i = 1; i < forces.size(); ++i) {
        passed = keep * (passed + forces[i] - forces[i - 1]);
        result.noise += passed * passed / static_cast<double>(forces.size());
    }
    result.noise = std::sqrt(result.noise);
    return result;
}

TEST(HandContact, PushedCubesResistAsCoulombSaysAndAreNeverLost) {
    for (const double edge : {0.15, 0.02, 0.005})
        for (const double stiffness : {1000.0, 3000.0}) {
            const Push push = pushed(edge, stiffness);
            const double expected = 0.5 * 9.81 * density * edge * edge * edge;
            EXPECT_NEAR(push.mean_force, expected, 0.005 * expected) << edge << " m, " << stiffness << " N/m";
            EXPECT_LT(push.noise, 0.01 * expected) << edge << " m, " << stiffness << " N/m";
            EXPECT_EQ(push.ticks_lost, 0) << edge << " m, " << stiffness << " N/m";
        }
}

TEST(HandContact, FreeBodyIsNotThrownByAStiffSpring) {
    PhysicsSettings settings;
    settings.gravity = Vec3(0.0);
    PhysicsWorld world(settings);
    const BodyId id = add(world, cube(0.005, Vec3(0.0)));
    // 1 mm into the body at 3000 N/m: 3 N on 0.04 g. The spring may not give back more than it holds: 1.5 mJ.
    world.apply_spring_force(id, {{3.0, 0.0, 0.0}, {-0.0025, 0.0, 0.0}, 3000.0});
    world.step(tick);
    const double speed = world.linear_velocity(id).x;
    EXPECT_GT(speed, 0.0);
    EXPECT_LE(speed * tick, 0.001);
    EXPECT_LE(0.5 * world.mass(id) * speed * speed, 1.5e-3);
}

TEST(HandContact, SpringForceIsAPlainForceToAHeavyBody) {
    PhysicsSettings settings;
    settings.gravity = Vec3(0.0);
    PhysicsWorld world(settings);
    const BodyId id = add(world, box(Vec3(1.0), Vec3(0.0), 1000.0));
    world.apply_spring_force(id, {{10.0, 0.0, 0.0}, {-0.5, 0.0, 0.0}, 1000.0});
    world.step(tick);
    EXPECT_NEAR(world.linear_velocity(id).x, 10.0 * tick / 1000.0, 1e-10);
}

// Energy of a free body over what it and the spring had at first, after a hand that stands still `depth`
// inside it (or as far away, and it comes at `speed`) has pushed it off.
double energy_kept(double stiffness, double mass, double depth, double speed, int sub_steps) {
    PhysicsSettings settings;
    settings.gravity = Vec3(0.0);
    settings.sub_steps = sub_steps;
    PhysicsWorld world(settings);
    const BodyId id = add(world, box(Vec3(0.1), Vec3(0.0), mass));
    world.set_velocity(id, {-speed, 0.0, 0.0}, Vec3(0.0));
    for (int i = 0; i < 1000; ++i) {
        const Vec3 point = world.pose(id).position - Vec3(0.05, 0.0, 0.0);
        const double left = depth - 0.05 - point.x;
        if (left > 0.0)
            world.apply_spring_force(id, {{stiffness * left, 0.0, 0.0}, point, stiffness});
        world.step(tick);
    }
    const double first = mass * speed * speed + (depth > 0.0 ? stiffness * depth * depth : 0.0);
    const double last = world.linear_velocity(id).x;
    return mass * last * last / first;
}

// The share k dt^2 / m is what the steps' places are off by; to a free body, a hundredth of the spring gives
// way.
TEST(HandContact, AFreeBodyKeepsTheEnergyThatASpringGivesIt) {
    for (const double stiffness : {100.0, 1000.0, 3000.0})
        for (const double mass : {1.0, 3.0})
            for (const int sub_steps : {1, 2}) {
                const double share = stiffness * tick * tick / mass;
                const double off = 1e-3 + 2.0 * share + 0.01 * std::numbers::pi * std::sqrt(share);
                EXPECT_NEAR(energy_kept(stiffness, mass, 0.01, 0.0, sub_steps), 1.0, off)
                    << "thrown, " << stiffness << " N/m, " << mass << " kg, " << sub_steps;
                EXPECT_NEAR(energy_kept(stiffness, mass, -0.005, 0.1, sub_steps), 1.0, off)
                    << "bounced, " << stiffness << " N/m, " << mass << " kg, " << sub_steps;
            }
}

TEST(HandContact, BodyMayLeaveBetweenPushAndStep) {
    PhysicsWorld world;
    const BodyId first = add(world, cube(0.1, Vec3(0.0)));
    const BodyId second = add(world, cube(0.1, {1.0, 0.0, 0.0}));
    world.apply_spring_force(first, {{1.0, 0.0, 0.0}, {-0.05, 0.0, 0.0}, 1000.0});
    world.apply_spring_force(second, {{1.0, 0.0, 0.0}, {0.95, 0.0, 0.0}, 1000.0});
    const PreparedBody gone = world.remove(first);
    world.step(tick);
    EXPECT_GT(world.linear_velocity(second).x, 0.0);
}

// A finger that sticks: a spring in all directions between the hand and a place on the body.
void hold(PhysicsWorld& world, BodyId id, const Vec3& hand, const Vec3& local_point, double stiffness,
          const Vec3& hand_velocity) {
    const Vec3 point = to_parent(world.pose(id), local_point);
    const Vec3 force = stiffness * (hand - point);
    world.apply_spring_force(id, {force, point, stiffness, 0.0, hand_velocity, true});
}

TEST(HandContact, TwoFingersLiftALightCube) {
    PhysicsWorld world;
    add(world, ground());
    const double edge = 0.02;
    const BodyId id = add(world, cube(edge, {0.0, 0.5 * edge, 0.0}));
    const Vec3 up{0.0, 0.05, 0.0};
    double lift = 0.0;
    for (int i = 0; i < 2000; ++i) {
        lift += i >= 500 && i < 1500 ? up.y * tick : 0.0;
        const Vec3 velocity = i >= 500 && i < 1500 ? up : Vec3(0.0);
        for (const double side : {-1.0, 1.0})
            hold(world, id, {side * (0.5 * edge - 0.001), 0.5 * edge + lift, 0.0},
                 {side * 0.5 * edge, 0.0, 0.0}, 1000.0, velocity);
        world.step(tick);
    }
    EXPECT_NEAR(world.pose(id).position.y, 0.5 * edge + 0.05, 1e-4);
    EXPECT_NEAR(world.pose(id).position.x, 0.0, 1e-5);
    EXPECT_GT(std::abs(world.pose(id).rotation.w), 0.9999);
    EXPECT_LT(glm::length(world.linear_velocity(id)), 1e-4);
}

TEST(HandContact, CubeSqueezedAgainstAWallStaysStill) {
    PhysicsWorld world;
    add(world, ground());
    BodyDescription wall = box({0.1, 1.0, 1.0}, {0.06, 0.5, 0.0}, 1.0);
    wall.motion = Motion::Static;
    add(world, wall);
    const BodyId id = add(world, cube(0.02, {0.0, 0.01, 0.0}));
    Restlessness rest;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 point = to_parent(world.pose(id), Vec3(-0.01, 0.0, 0.0));
        world.apply_spring_force(id, {{5.0, 0.0, 0.0}, point, 1000.0});
        world.step(tick);
        if (i >= 1500)
            rest.look(world.pose(id), 0.02);
    }
    EXPECT_LT(rest.peak_to_peak(), 1e-6);
}

TEST(HandContact, StackPushedAtItsFootMovesAsOne) {
    PhysicsWorld world;
    add(world, ground());
    std::vector<BodyId> stack;
    for (int i = 0; i < 3; ++i)
        stack.push_back(add(world, cube(0.05, {0.0, 0.025 + 0.05 * i, 0.0}, 0.8)));
    double hand = -0.025;
    for (int i = 0; i < 3000; ++i) {
        hand += 0.02 * tick;
        const Vec3 point = to_parent(world.pose(stack[0]), Vec3(-0.025, 0.0, 0.0));
        const double force = std::max(0.0, 1000.0 * (hand - point.x));
        world.apply_spring_force(stack[0], {{force, 0.0, 0.0}, point, 1000.0, 0.0, {0.02, 0.0, 0.0}});
        world.step(tick);
    }
    for (const BodyId id : stack)
        EXPECT_NEAR(world.pose(id).position.x, world.pose(stack[0]).position.x, 2e-3);
    EXPECT_GT(world.pose(stack[0]).position.x, 0.055);
    EXPECT_NEAR(world.pose(stack[2]).position.y, 0.125, 1e-4);
}

// Pressed down 5 mm off its axis, a ball rolls away under the finger without jumping.
TEST(HandContact, BallRollsUnderTheFinger) {
    PhysicsWorld world;
    add(world, ground());
    BodyDescription description = ball(0.03, {0.0, 0.03, 0.0}, 0.05);
    description.material.friction = 0.8;
    const BodyId id = add(world, description);
    double highest = 0.0;
    for (int i = 0; i < 300; ++i) {
        const Vec3 top = world.pose(id).position + Vec3(0.0, 0.03, 0.0);
        world.apply_spring_force(id, {{0.05, -1.0, 0.0}, top, 1000.0});
        world.step(tick);
        highest = std::max(highest, world.pose(id).position.y);
    }
    EXPECT_LT(highest, 0.03 + 1e-5);
    EXPECT_GT(world.pose(id).position.x, 0.01);
    EXPECT_NEAR(world.angular_velocity(id).z, -world.linear_velocity(id).x / 0.03,
                0.01 * world.linear_velocity(id).x / 0.03);
}

// A leaf of 50 g in a hinge that drags, pushed at its free edge by a hand that goes along the arc: the hand
// feels the drag I c w / r and nothing else, and the hinge stays where it is.
TEST(HandContact, DoorOpensUnderTheFinger) {
    constexpr double width = 0.1;
    constexpr double stiffness = 1000.0;
    constexpr double drag = 20.0;  // (unit: 1/seconds)
    constexpr double speed = 0.5;  // (unit: radians per second)
    PhysicsWorld world;
    BodyDescription leaf = box({width, 0.15, 0.006}, {0.5 * width, 0.0, 0.0}, 0.05);
    leaf.angular_damping = drag;
    leaf.gravity_scale = 0.0;
    const BodyId id = add(world, leaf);
    JointDescription hinge;
    hinge.kind = JointKind::Hinge;
    hinge.frame.rotation = Quat(std::sqrt(0.5), -std::sqrt(0.5), 0.0, 0.0);  // z to y
    hinge.angular[2] = JointRange::free();
    ASSERT_TRUE(world.add_joint(hinge, BodyId{}, id).valid());
    const Vec3 at{0.4 * width, 0.0, 0.003};  // on the leaf, 0.09 m from the hinge
    std::vector<double> forces;
    double loosest = 0.0;
    for (int i = 0; i < 3000; ++i) {
        const Pose pose = world.pose(id);
        const Vec3 point = to_parent(pose, at);
        const double angle = speed * tick * (i + 1);
        const double ahead = angle - std::atan2(-to_parent(pose, Vec3(0.4 * width, 0.0, 0.0)).z,
                                                to_parent(pose, Vec3(0.4 * width, 0.0, 0.0)).x);
        const double force = std::max(0.0, stiffness * ahead * 0.9 * width);
        const Vec3 way = direction_to_parent(pose, {0.0, 0.0, -1.0});
        world.apply_spring_force(id, {force * way, point, stiffness, 0.0, 0.9 * width * speed * way});
        world.step(tick);
        loosest = std::max(loosest, glm::length(to_parent(world.pose(id), Vec3(-0.5 * width, 0.0, 0.0))));
        if (i >= 1500)  // the drag has calmed how the leaf swung as it was met
            forces.push_back(force);
    }
    // Jolt's damping acts on the spin about the leaf's own centre and on nothing else.
    const double inertia = 0.05 * (width * width + 0.006 * 0.006) / 12.0;
    const double expected = inertia * drag * speed / (0.9 * width);
    const auto [least, most] = std::minmax_element(forces.begin(), forces.end());
    EXPECT_NEAR(*least, expected, 0.02 * expected);
    EXPECT_LT(*most - *least, 0.01 * expected);
    EXPECT_LT(loosest, 1e-5);
}

}  // namespace
}  // namespace tactus::hand_contact_test
