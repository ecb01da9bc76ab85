// What becomes of what a mesh says of its triangles, as a body is built of it.
#include "world/body_form.hpp"

#include <gtest/gtest.h>

namespace tactus::body_form_test {
namespace {

// A sheet of two triangles; its texture coordinates are its places.
TriangleMesh sheet() {
    return {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}}, {{0, 2, 1}, {1, 2, 3}}};
}

SurfaceMap map_of(const TriangleMesh& mesh) {
    SurfaceMap map;
    for (const auto& triangle : mesh.triangles) {
        map.surface.push_back(static_cast<std::uint8_t>(map.surface.size()));
        SurfaceMap::Corners& corners = map.uv.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3& place = mesh.vertices[triangle[i]];
            corners[i] = {static_cast<float>(place.x), static_cast<float>(place.z)};
        }
    }
    return map;
}

MeshShape built(const Mat3& scaling, const SurfaceMap& map) {
    auto source = std::make_shared<TriangleSource>(
        TriangleSource::Checked{std::make_shared<const TriangleMesh>(sheet()), ""});
    BodyPlan plan;
    plan.form.touchable = true;
    plan.form.touched = {
        MeshDraft{source, scaling, Pose{}, 0.0, false, "", std::make_shared<const SurfaceMap>(map)}};
    const BuiltBody body = build_body(plan, run_serially);
    EXPECT_TRUE(body.buildable);
    EXPECT_EQ(body.addition.touch->parts[0].surfaces,
              std::get<MeshShape>(body.addition.description.shapes[0].shape).surfaces);
    return std::get<MeshShape>(body.addition.description.shapes[0].shape);
}

TEST(BodyForm, TextureCoordinatesStayWithTheirCornersHoweverTheMeshIsScaled) {
    for (const double along_x : {2.0, -2.0}) {
        const MeshShape shape =
            built(Mat3(Vec3(along_x, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 3)), map_of(sheet()));
        ASSERT_NE(shape.surfaces, nullptr);
        EXPECT_EQ(shape.surfaces->surface, (std::vector<std::uint8_t>{0, 1}));
        for (std::size_t t = 0; t < 2; ++t) {
            for (std::size_t i = 0; i < 3; ++i) {
                const Vec3& place = shape.mesh->vertices[shape.mesh->triangles[t][i]];
                EXPECT_EQ(shape.surfaces->uv[t][i][0], static_cast<float>(place.x / along_x));
                EXPECT_EQ(shape.surfaces->uv[t][i][1], static_cast<float>(place.z / 3.0));
            }
        }
    }
}

TEST(BodyForm, AMassThatIsTooSmallForItsSurfaceIsNamedWithTheLeastOne) {
    TouchMaterial touch;
    touch.stiffness = 1000.0;
    touch.damping = 3.0;
    EXPECT_EQ(problem_of_mass(0.00401, touch, 1e-3), "");
    EXPECT_EQ(problem_of_mass(0.001, touch, 1e-3),
              "its mass of 0.001 kg is too small for the stiffness and damping of its surface: a pushed body "
              "gets less than the hand feels; make it at least 0.004 kg");
    EXPECT_EQ(problem_of_mass(0.00201, touch, 0.5e-3), "");
    touch.stiffening = 2.0;
    EXPECT_NE(problem_of_mass(0.00401, touch, 1e-3), "");
}

// To keep a body upright games give it a large inertia about one axis: it is felt, with that one.
TEST(BodyForm, AnInertiaThatNoBodyHasBecomesAPossibleOneAndIsNamed) {
    BodyPlan plan;
    plan.form.touchable = true;
    plan.form.shapes = {{BoxShape{Vec3(0.05)}, {}}};
    plan.values.motion = Motion::Dynamic;
    plan.makings.inertia = Vec3(1e3, 0.1, 0.2);
    const BuiltBody built = build_body(plan, run_serially);
    ASSERT_TRUE(built.buildable);
    EXPECT_EQ(built.body.error, "");
    const Vec3 has = *built.addition.description.inertia;
    EXPECT_DOUBLE_EQ(has.x, 1e3);
    EXPECT_NEAR(has.y, 500.0, 0.1);
    EXPECT_NEAR(has.z, 500.0, 0.1);
    ASSERT_EQ(built.problems.size(), 1u);
    EXPECT_NE(built.problems[0].find("no body has the inertia 1e+03, 0.1, 0.2"), std::string::npos)
        << built.problems[0];

    plan.makings.inertia = Vec3(0.1, 0.2, 0.3);
    const BuiltBody flat = build_body(plan, run_serially);
    EXPECT_EQ(*flat.addition.description.inertia, Vec3(0.1, 0.2, 0.3));
    EXPECT_TRUE(flat.problems.empty());
}

TEST(BodyForm, WhatIsSaidOfOtherTrianglesIsLeftOut) {
    SurfaceMap map = map_of(sheet());
    map.uv.pop_back();
    EXPECT_EQ(built(Mat3(1.0), map).surfaces, nullptr);
}

}  // namespace
}  // namespace tactus::body_form_test
