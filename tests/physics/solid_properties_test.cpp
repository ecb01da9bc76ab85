#include "physics/solid_properties.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <random>

#include "scene.hpp"

namespace tactus::solid_properties_test {
namespace {

using namespace scene;

// The slow reference: points spread evenly over a box around the solid.
template <class Inside>
SolidProperties sampled(double half, Inside inside) {
    constexpr int per_axis = 120;
    const double edge = 2.0 * half / per_axis;
    const double cell = edge * edge * edge;
    SolidProperties solid;
    Mat3 about_origin(0.0);
    for (int i = 0; i < per_axis; ++i)
        for (int j = 0; j < per_axis; ++j)
            for (int k = 0; k < per_axis; ++k) {
                const Vec3 p = Vec3(i + 0.5, j + 0.5, k + 0.5) * edge - half;
                if (!inside(p))
                    continue;
                solid.volume += cell;
                about_origin += cell * (Mat3(glm::dot(p, p)) - glm::outerProduct(p, p));
            }
    solid.inertia = about_origin;
    return solid;
}

void expect_near(const SolidProperties& a, const SolidProperties& b, double share) {
    EXPECT_NEAR(a.volume, b.volume, share * b.volume);
    const double scale = b.inertia[0][0] + b.inertia[1][1] + b.inertia[2][2];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(a.inertia[i][j], b.inertia[i][j], share * scale) << i << j;
}

TEST(SolidProperties, Sphere) {
    expect_near(*solid_properties(SphereShape{0.9}),
                sampled(1.0, [](const Vec3& p) { return glm::length(p) < 0.9; }), 0.01);
}

TEST(SolidProperties, Cylinder) {
    expect_near(*solid_properties(CylinderShape{0.6, 0.9}),
                sampled(1.0, [](const Vec3& p) { return std::hypot(p.x, p.z) < 0.6 && std::abs(p.y) < 0.9; }),
                0.01);
}

TEST(SolidProperties, Capsule) {
    const auto inside = [](const Vec3& p) {
        const double y = std::max(0.0, std::abs(p.y) - 0.5);
        return p.x * p.x + y * y + p.z * p.z < 0.16;
    };
    expect_near(*solid_properties(CapsuleShape{0.4, 0.5}), sampled(1.0, inside), 0.01);
}

TEST(SolidProperties, CubeMeshEqualsBoxWhereverItIs) {
    auto mesh = std::make_shared<TriangleMesh>(*cube_mesh(0.3));
    for (Vec3& v : mesh->vertices)
        v += Vec3(1.0, -2.0, 3.0);
    const SolidProperties solid = *solid_properties(MeshShape{mesh});
    expect_near(solid, *solid_properties(BoxShape{Vec3(0.3)}), 1e-9);
    EXPECT_NEAR(glm::length(solid.centroid - Vec3(1.0, -2.0, 3.0)), 0.0, 1e-12);
}

TEST(SolidProperties, BoxOfTwoHalvesEqualsTheWhole) {
    const SolidProperties half = *solid_properties(BoxShape{{0.25, 0.2, 0.1}});
    const SolidProperties whole = combined({placed(half, {{-0.25, 0.0, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)}),
                                            placed(half, {{0.25, 0.0, 0.0}, Quat(1.0, 0.0, 0.0, 0.0)})});
    expect_near(whole, *solid_properties(BoxShape{{0.5, 0.2, 0.1}}), 1e-12);
}

TEST(SolidProperties, TurnedBoxSwapsItsAxes) {
    const Pose turned{Vec3(0.0), glm::angleAxis(std::numbers::pi / 2.0, Vec3(0.0, 0.0, 1.0))};
    expect_near(placed(*solid_properties(BoxShape{{0.1, 0.2, 0.3}}), turned),
                *solid_properties(BoxShape{{0.2, 0.1, 0.3}}), 1e-12);
}

TEST(SolidProperties, OpenInsideOutAndFlatMeshesEncloseNothing) {
    TriangleMesh open = *cube_mesh(0.3);
    open.triangles.pop_back();
    EXPECT_FALSE(solid_properties(open).has_value());
    TriangleMesh inside_out = *cube_mesh(0.3);
    for (auto& t : inside_out.triangles)
        std::swap(t[0], t[1]);
    EXPECT_FALSE(solid_properties(inside_out).has_value());
    TriangleMesh flat = *cube_mesh(0.3);
    for (Vec3& v : flat.vertices)
        v.z = 0.0;
    EXPECT_FALSE(solid_properties(flat).has_value());
    EXPECT_FALSE(solid_properties(TriangleMesh{}).has_value());
}

}  // namespace
}  // namespace tactus::solid_properties_test
