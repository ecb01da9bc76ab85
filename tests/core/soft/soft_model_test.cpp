#include "core/soft/soft_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shared/meshes.hpp"

namespace tactus::soft_model_test {
namespace {

constexpr double tick = 1e-3;
const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

std::string error_of_tetrahedra(const std::vector<Vec3>& vertices, const std::vector<Tetrahedron>& cells) {
    return make_soft_tetrahedra(vertices, cells, {}, {}, tick).error;
}

TEST(SoftModel, ABlockWeighsWhatItHoldsAndHasASpringOnEachFace) {
    const auto made = make_soft_volume(shared::grid_box(Vec3(0.04), 8), 8, {}, {}, tick);
    ASSERT_EQ(made.error, "");
    EXPECT_EQ(made.model->rest.size(), 729u);
    EXPECT_EQ(made.model->element_count, 512u + 3u * 8u * 8u * 9u);
    EXPECT_NEAR(made.model->total_mass(), 1000.0 * 0.08 * 0.08 * 0.08, 1e-9);
    EXPECT_TRUE(made.model->is_free());
    EXPECT_TRUE(made.model->closed);
}

TEST(SoftModel, ABallWeighsAboutWhatItHoldsAndItsSurfaceHangsOnItsNodes) {
    const TriangleMesh ball = shared::icosphere(3, 0.05);
    const auto made = make_soft_volume(ball, 6, {}, {}, tick);
    ASSERT_EQ(made.error, "");
    EXPECT_NEAR(made.model->total_mass(), 1000.0 * 4.0 / 3.0 * std::numbers::pi * 0.05 * 0.05 * 0.05, 0.04);
    for (std::size_t i = 0; i < ball.vertices.size(); ++i) {
        const SoftAnchor& anchor = made.model->anchors[i];
        Vec3 place(0.0);
        for (std::size_t k = 0; k < 4; ++k) {
            EXPECT_GE(anchor.weight[k], -1e-12);
            place += anchor.weight[k] * made.model->rest[anchor.node[k]];
        }
        ASSERT_LT(glm::distance(place, ball.vertices[i]), 1e-12);
    }
}

TEST(SoftModel, WhatIsInTheBoxIsHeldAndWhatNamedVerticesHangOn) {
    const TriangleMesh block = shared::grid_box(Vec3(0.04), 4);
    const auto floor = make_soft_volume(block, 4, {}, {Vec3(-1.0), Vec3(1.0, -0.039, 1.0), {}}, tick);
    EXPECT_EQ(std::ranges::count(floor.model->held, 1), 25);
    const auto point = make_soft_volume(block, 4, {}, {Vec3(1.0), Vec3(-1.0), {0}}, tick);
    EXPECT_EQ(std::ranges::count(point.model->held, 1), 1);
}

TEST(SoftModel, ASheetIsOnePieceAlongItsSeams) {
    TriangleMesh sheet = shared::terrain(4, 0.2, 0.0);
    const std::size_t count = sheet.vertices.size();
    for (auto& triangle : sheet.triangles) {
        for (std::uint32_t& corner : triangle) {
            sheet.vertices.push_back(sheet.vertices[corner]);
            corner = static_cast<std::uint32_t>(sheet.vertices.size() - 1);
        }
    }
    const auto made = make_soft_sheet(sheet, {}, {}, tick);
    ASSERT_EQ(made.error, "");
    EXPECT_EQ(made.model->rest.size(), count);
    EXPECT_NEAR(made.model->total_mass(), 1000.0 * 1e-3 * 0.04, 1e-9);
    EXPECT_FALSE(made.model->closed);
}

TEST(SoftModel, BadInputIsToldWithWhatToDo) {
    const TriangleMesh open = shared::terrain(2, 0.2, 0.01);
    EXPECT_NE(make_soft_volume(open, 4, {}, {}, tick).error.find("open"), std::string::npos);
    const TriangleMesh vertex{{Vec3(0.0)}, {}};
    EXPECT_NE(make_soft_sheet(vertex, {}, {}, tick).error, "");
    EXPECT_NE(make_soft_volume(vertex, 4, {}, {}, tick).error, "");
    EXPECT_NE(make_soft_volume(shared::box(Vec3(0.1)), 0, {}, {}, tick).error.find("cells"),
              std::string::npos);
    EXPECT_NE(make_soft_volume(shared::box(Vec3(0.1)), 40, {}, {}, tick).error.find("fewer"),
              std::string::npos);
    TriangleMesh nonsense = shared::box(Vec3(0.1));
    nonsense.vertices[3].y = std::nan("");
    EXPECT_NE(make_soft_volume(nonsense, 4, {}, {}, tick).error, "");
    EXPECT_NE(make_soft_sheet(nonsense, {}, {}, tick).error, "");
    for (const SoftMaterial& bad :
         {SoftMaterial{.stiffness = 0.0}, SoftMaterial{.stiffness = std::nan("")},
          SoftMaterial{.poisson_ratio = 0.5}, SoftMaterial{.density = -1.0}, SoftMaterial{.thickness = 0.0},
          SoftMaterial{.damping = -1.0}, SoftMaterial{.friction = std::nan("")}}) {
        EXPECT_NE(make_soft_volume(shared::box(Vec3(0.1)), 4, bad, {}, tick).error, "");
    }
}

TEST(SoftModel, TetrahedraThatAreNoneAreToldByTheirNumber) {
    EXPECT_EQ(error_of_tetrahedra(corners, {{0, 1, 2, 3}}), "");
    EXPECT_NE(error_of_tetrahedra(corners, {{0, 2, 1, 3}}).find("0 is turned inside out"), std::string::npos);
    EXPECT_NE(error_of_tetrahedra(corners, {{0, 1, 2, 3}, {0, 1, 2, 2}}).find("1 is flat"),
              std::string::npos);
    EXPECT_NE(error_of_tetrahedra(corners, {{0, 1, 2, 4}}).find("below 4"), std::string::npos);
    EXPECT_NE(error_of_tetrahedra({}, {}).find("no tetrahedra"), std::string::npos);
    std::vector<Vec3> nonsense = corners;
    nonsense[2].x = std::nan("");
    EXPECT_NE(error_of_tetrahedra(nonsense, {{0, 1, 2, 3}}).find("vertex 2"), std::string::npos);
}

}  // namespace
}  // namespace tactus::soft_model_test
