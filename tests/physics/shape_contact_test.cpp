// Each kind of shape, dropped on each kind of ground, comes to rest where geometry says.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "core/geometry/touch_shape.hpp"
#include "core/tree/triangle_tree.hpp"
#include "physics/physics_world.hpp"
#include "scene.hpp"

namespace tactus::shape_contact_test {
namespace {

using namespace scene;

BodyDescription still(Shape shape, const Vec3& position = Vec3(0.0)) {
    BodyDescription body;
    body.shapes = one(std::move(shape));
    body.pose.position = position;
    body.motion = Motion::Static;
    return body;
}

double resting_height(const BodyDescription& floor, const Shape& shape, double start) {
    PhysicsWorld world;
    add(world, floor);
    BodyDescription body;
    body.shapes = one(shape);
    body.pose.position = {0.013, start, 0.017};
    body.mass = 0.5;
    const BodyId id = add(world, body);
    run(world, 1500);
    return world.pose(id).position.y;
}

std::shared_ptr<const std::vector<float>> flat_heights(std::size_t count) {
    return std::make_shared<std::vector<float>>(count, 0.25f);
}

struct Ground {
    const char* name;
    BodyDescription body;
    double height;
};

std::vector<Ground> grounds() {
    return {
        {"plane", still(PlaneShape{}), 0.0},
        {"box", still(BoxShape{{1.0, 0.5, 1.0}}, {0.0, -0.5, 0.0}), 0.0},
        {"mesh", still(MeshShape{cube_mesh(0.5)}), 0.5},
        {"hull", still(ConvexHullShape{cube_mesh(0.5)}), 0.5},
        {"square heights", still(HeightFieldShape{9, 9, Vec3(0.25, 2.0, 0.25), flat_heights(81)}), 0.5},
        {"oblong heights", still(HeightFieldShape{9, 6, Vec3(0.25, 2.0, 0.3), flat_heights(54)}), 0.5},
        {"strip of heights", still(HeightFieldShape{100, 3, Vec3(0.05, 2.0, 0.5), flat_heights(300)}), 0.5}};
}

struct Dropped {
    const char* name;
    Shape shape;
    double half_height;
};

std::vector<Dropped> shapes() {
    return {{"sphere", SphereShape{0.05}, 0.05},
            {"box", BoxShape{{0.05, 0.04, 0.06}}, 0.04},
            {"cylinder", CylinderShape{0.05, 0.03}, 0.03},
            {"hull", ConvexHullShape{cube_mesh(0.05)}, 0.05},
            {"mesh", MeshShape{cube_mesh(0.05)}, 0.05}};
}

TEST(ShapeContact, EveryShapeRestsOnEveryGround) {
    for (const Ground& ground_kind : grounds())
        for (const Dropped& dropped : shapes()) {
            const double expected = ground_kind.height + dropped.half_height;
            EXPECT_NEAR(resting_height(ground_kind.body, dropped.shape, expected + 0.003), expected, 1e-4)
                << dropped.name << " on " << ground_kind.name;
        }
}

TEST(ShapeContact, CapsuleLies) {
    PhysicsWorld world;
    add(world, ground());
    BodyDescription body;
    body.shapes = one(CapsuleShape{0.03, 0.1});
    body.pose = {{0.0, 0.031, 0.0}, glm::angleAxis(std::numbers::pi / 2.0, Vec3(0.0, 0.0, 1.0))};
    const BodyId id = add(world, body);
    run(world, 1000);
    EXPECT_NEAR(world.pose(id).position.y, 0.03, 1e-4);
}

// The slope z -> y of a height field must meet the body where the samples say.
TEST(ShapeContact, SlopedHeightFieldIsWhereItsSamplesAre) {
    auto heights = std::make_shared<std::vector<float>>();
    for (int row = 0; row < 7; ++row)
        for (int column = 0; column < 10; ++column)
            heights->push_back(0.1f * static_cast<float>(row));
    PhysicsWorld world;
    BodyDescription terrain = still(HeightFieldShape{10, 7, Vec3(0.2, 1.0, 0.2), heights});
    add(world, terrain);
    BodyDescription body = ball(0.05, {0.1, 0.42, 0.1}, 1.0);
    body.lock_linear[0] = body.lock_linear[2] = true;
    const BodyId id = add(world, body);
    run(world, 1000);
    const double surface = 0.1 * (0.1 / 0.2 + 3.0);
    const double above = 0.05 / std::cos(std::atan(0.5));
    EXPECT_NEAR(world.pose(id).position.y, surface + above, 2e-4);
}

// A saddle is a valley along one diagonal of its cells and a ridge along the other: what is touched and what
// bodies rest on must be cut along the same one, mirrored or not, square or not.
TEST(ShapeContact, BodiesRestWhereAHeightFieldIsTouched) {
    for (const std::uint32_t rows : {8u, 12u, 400u}) {
        for (const double mirror : {1.0, -1.0}) {
            auto heights = std::make_shared<std::vector<float>>();
            for (std::uint32_t row = 0; row < rows; ++row)
                for (int column = 0; column < 8; ++column)
                    heights->push_back(row % 2 == 0 && column % 2 == 0 ? 0.08f
                                                                       : 0.02f * static_cast<float>(column));
            const HeightFieldShape field{8, rows, Vec3(0.2 * mirror, 1.0, 0.2), heights};
            const PlacedShape placed{field, {}};
            const TouchShapeResult touched = make_touch_shape({&placed, 1});
            ASSERT_TRUE(touched.shape) << touched.error;
            const TriangleTree& tree = *touched.shape->parts[0].tree();
            for (int i = 0; i < 12; ++i) {
                constexpr double radius = 0.004;
                const Vec3 above(0.2 * (i % 4) - 0.28, 0.3, 0.2 * (i / 4) - 0.18);
                PhysicsWorld world;
                add(world, still(field));
                BodyDescription body = ball(radius, above, 1.0);
                body.lock_linear[0] = body.lock_linear[2] = true;
                const BodyId id = add(world, body);
                run(world, 700);
                EXPECT_NEAR(tree.nearest(world.pose(id).position, 1.0).distance, radius, 2e-4)
                    << rows << " rows, mirrored " << mirror << ", place " << i;
            }
        }
    }
}

TEST(ShapeContact, CompoundTurnsAboutItsCommonCentre) {
    PhysicsSettings settings;
    settings.gravity = Vec3(0.0);
    PhysicsWorld world(settings);
    BodyDescription dumbbell;
    dumbbell.shapes = {{SphereShape{0.1}, {{0.5, 0.0, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)}},
                       {SphereShape{0.2}, {{-0.5, 0.0, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)}}};
    dumbbell.mass = 9.0;
    const BodyId id = add(world, dumbbell);
    const double centre = (0.5 * 1.0 - 0.5 * 8.0) / 9.0;
    EXPECT_NEAR(world.center_of_mass(id).x, centre, 1e-6);
    world.apply_torque(id, {0.0, 10.0, 0.0});
    world.step(tick);
    const double inertia =
        0.4 * (1.0 * 0.01 + 8.0 * 0.04) + 1.0 * std::pow(0.5 - centre, 2) + 8.0 * std::pow(0.5 + centre, 2);
    EXPECT_NEAR(world.angular_velocity(id).y, 10.0 * tick / inertia, 1e-6);
}

TEST(ShapeContact, GivenCentreOfMassAndInertiaAreUsed) {
    PhysicsSettings settings;
    settings.gravity = Vec3(0.0);
    PhysicsWorld world(settings);
    BodyDescription body = box(Vec3(0.2), {1.0, 1.0, 1.0}, 2.0);
    body.center_of_mass = Vec3(0.0, 0.05, 0.0);
    body.inertia = Vec3(0.2, 0.25, 0.4);
    const BodyId id = add(world, body);
    EXPECT_NEAR(glm::length(world.center_of_mass(id) - Vec3(1.0, 1.05, 1.0)), 0.0, 1e-7);
    EXPECT_EQ(world.pose(id).position, Vec3(1.0));
    world.apply_torque(id, {1.0, 1.0, 1.0});
    world.step(tick);
    EXPECT_NEAR(world.angular_velocity(id).x, 0.005, 1e-7);
    EXPECT_NEAR(world.angular_velocity(id).y, 0.004, 1e-7);
    EXPECT_NEAR(world.angular_velocity(id).z, 0.0025, 1e-7);
}

// A channel: a floor and two walls.
std::vector<PlacedShape> channel_of_boxes() {
    const Quat upright{1.0, 0.0, 0.0, 0.0};
    return {{BoxShape{{0.1, 0.01, 0.1}}, {{0.0, 0.01, 0.0}, upright}},
            {BoxShape{{0.01, 0.05, 0.1}}, {{-0.09, 0.05, 0.0}, upright}},
            {BoxShape{{0.01, 0.05, 0.1}}, {{0.09, 0.05, 0.0}, upright}}};
}

std::shared_ptr<const TriangleMesh> channel_mesh() {
    auto mesh = std::make_shared<TriangleMesh>();
    for (const PlacedShape& part : channel_of_boxes()) {
        const std::shared_ptr<const TriangleMesh> cube = cube_mesh(1.0);
        const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
        for (const Vec3& vertex : cube->vertices)
            mesh->vertices.push_back(part.pose.position +
                                     std::get<BoxShape>(part.shape).half_extents * vertex);
        for (const auto& t : cube->triangles)
            mesh->triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    return mesh;
}

// Where a ball of 20 mm comes to rest over the middle of the channel, which lies on the ground.
double height_in_channel(std::vector<PlacedShape> shapes, Motion motion) {
    PhysicsWorld world;
    add(world, ground());
    BodyDescription channel;
    channel.shapes = std::move(shapes);
    channel.motion = motion;
    channel.mass = 2.0;
    add(world, channel);
    BodyDescription description = ball(0.02, {0.0, 0.125, 0.0}, 0.05);
    description.angular_damping = 20.0;
    const BodyId id = add(world, description);
    run(world, 2000);
    return world.pose(id).position.y;
}

// A mesh that moves collides as its convex hull; given as several convex shapes it is as concave as they
// make it. One that stands still collides as it is.
TEST(ShapeContact, AMovingConcaveMeshCollidesAsItsHullAndACompoundAsItsParts) {
    const std::vector<PlacedShape> mesh = one(MeshShape{channel_mesh()});
    EXPECT_NEAR(height_in_channel(mesh, Motion::Dynamic), 0.1 + 0.02, 2e-4);
    EXPECT_NEAR(height_in_channel(mesh, Motion::Static), 0.02 + 0.02, 2e-4);
    EXPECT_NEAR(height_in_channel(channel_of_boxes(), Motion::Dynamic), 0.02 + 0.02, 2e-4);
}

}  // namespace
}  // namespace tactus::shape_contact_test
