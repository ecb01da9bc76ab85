#include "physics/prepared_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scene.hpp"

namespace tactus::prepared_body_test {
namespace {

using namespace scene;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// What is wrong must be said, and a mere number or name is not enough.
void expect_refused(const BodyDescription& description, const std::string& about) {
    const PreparedBody body = prepare(description);
    EXPECT_FALSE(body.ready());
    EXPECT_NE(body.error().find(about), std::string::npos) << "said: " << body.error();
}

BodyDescription with(Shape shape, Motion motion = Motion::Dynamic) {
    BodyDescription body;
    body.shapes = one(std::move(shape));
    body.motion = motion;
    return body;
}

std::shared_ptr<TriangleMesh> changed_cube(void (*change)(TriangleMesh&)) {
    auto mesh = std::make_shared<TriangleMesh>(*cube_mesh(0.1));
    change(*mesh);
    return mesh;
}

TEST(PreparedBody, EmptyOneIsNotReady) {
    EXPECT_FALSE(PreparedBody().ready());
}

TEST(PreparedBody, GoodOnesHaveNoError) {
    auto heights = std::make_shared<std::vector<float>>(6, 0.0f);
    for (const Shape& shape :
         {Shape(SphereShape{}), Shape(BoxShape{}), Shape(CapsuleShape{}), Shape(CylinderShape{}),
          Shape(ConvexHullShape{cube_mesh(0.2)}), Shape(MeshShape{cube_mesh(0.2)}), Shape(PlaneShape{}),
          Shape(HeightFieldShape{3, 2, Vec3(1.0), heights})}) {
        const PreparedBody body = prepare(with(shape, Motion::Static));
        EXPECT_TRUE(body.ready()) << shape.index() << ": " << body.error();
        EXPECT_EQ(body.error(), "");
    }
}

TEST(PreparedBody, NoShape) {
    expect_refused(BodyDescription{}, "no shape");
}

TEST(PreparedBody, NegativeOrNoSize) {
    expect_refused(with(SphereShape{-1.0}), "radius");
    expect_refused(with(BoxShape{{1.0, 0.0, 1.0}}), "half extent");
    expect_refused(with(CapsuleShape{0.1, nan}), "half the distance");
    expect_refused(with(CylinderShape{0.1, 1e9}), "half height");
}

TEST(PreparedBody, CapsuleWithoutMiddleIsASphere) {
    EXPECT_TRUE(prepare(with(CapsuleShape{0.1, 0.0})).ready());
}

TEST(PreparedBody, PoseThatIsNoPose) {
    BodyDescription body = with(SphereShape{});
    body.pose.position.x = nan;
    expect_refused(body, "transform");
    body = with(SphereShape{});
    body.pose.rotation *= 2.0;
    expect_refused(body, "scale");
}

TEST(PreparedBody, MassThatIsNoMass) {
    BodyDescription body = with(SphereShape{});
    body.mass = 0.0;
    expect_refused(body, "mass");
    body.motion = Motion::Static;
    EXPECT_TRUE(prepare(body).ready());
}

TEST(PreparedBody, InertiaThatNoBodyHas) {
    BodyDescription body = with(SphereShape{});
    body.inertia = Vec3(0.1, 0.2, 0.4);
    expect_refused(body, "sum of the other two");
    body.inertia = Vec3(0.1, 0.2, 0.3);
    EXPECT_TRUE(prepare(body).ready());
}

TEST(PreparedBody, MeshWithoutTriangles) {
    expect_refused(with(MeshShape{}, Motion::Static), "no vertices");
    expect_refused(
        with(MeshShape{changed_cube([](TriangleMesh& m) { m.triangles.clear(); })}, Motion::Static),
        "no triangle");
}

TEST(PreparedBody, MeshWithNaN) {
    const auto mesh = changed_cube([](TriangleMesh& m) { m.vertices[3].y = nan; });
    expect_refused(with(MeshShape{mesh}, Motion::Static), "vertex 3");
    expect_refused(with(ConvexHullShape{mesh}), "vertex 3");
}

TEST(PreparedBody, MeshOfZeroArea) {
    const auto mesh = changed_cube([](TriangleMesh& m) {
        for (Vec3& v : m.vertices)
            v = Vec3(v.x, 0.0, 0.0);
    });
    expect_refused(with(MeshShape{mesh}, Motion::Static), "area");
}

TEST(PreparedBody, MeshThatNamesMissingVertices) {
    expect_refused(
        with(MeshShape{changed_cube([](TriangleMesh& m) { m.triangles[0][0] = 99; })}, Motion::Static),
        "vertex 99");
}

TEST(PreparedBody, FlatHull) {
    expect_refused(with(ConvexHullShape{changed_cube([](TriangleMesh& m) {
                       for (Vec3& v : m.vertices)
                           v.y = 0.0;
                   })}),
                   "flat");
}

TEST(PreparedBody, MovingPlaneAndHeightField) {
    expect_refused(with(PlaneShape{}), "plane");
    auto heights = std::make_shared<std::vector<float>>(4, 0.0f);
    expect_refused(with(HeightFieldShape{2, 2, Vec3(1.0), heights}), "height field");
}

TEST(PreparedBody, HeightFieldWithTooFewHeights) {
    auto heights = std::make_shared<std::vector<float>>(5, 0.0f);
    expect_refused(with(HeightFieldShape{3, 2, Vec3(1.0), heights}, Motion::Static), "columns x rows");
}

TEST(PreparedBody, CompoundNamesTheShapeAtFault) {
    BodyDescription body = with(SphereShape{});
    body.shapes.push_back({BoxShape{Vec3(-1.0)}, Pose{}});
    expect_refused(body, "shape 2 (box)");
}

TEST(PreparedBody, AllAxesLocked) {
    BodyDescription body = with(SphereShape{});
    for (int i = 0; i < 3; ++i)
        body.lock_linear[i] = body.lock_angular[i] = true;
    expect_refused(body, "locked");
}

TEST(PreparedBody, MovedFromOwnsNothing) {
    PreparedBody first = prepare(with(SphereShape{}));
    const PreparedBody second = std::move(first);
    EXPECT_FALSE(first.ready());
    EXPECT_TRUE(second.ready());
}

}  // namespace
}  // namespace tactus::prepared_body_test
