#include "world/scaled_shape.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>

namespace tactus::scaled_shape_test {
namespace {

Mat3 along_axes(double x, double y, double z) {
    return Mat3(Vec3(x, 0, 0), Vec3(0, y, 0), Vec3(0, 0, z));
}

template <class Kind>
Kind only(const ShapeReading& reading) {
    EXPECT_EQ(reading.error, "");
    EXPECT_EQ(reading.shapes.size(), 1u);
    return std::get<Kind>(reading.shapes.front().shape);
}

bool is_uneven(const ShapeReading& reading) {
    return reading.shapes.empty() && reading.error.find("scale it evenly") != std::string::npos;
}

TEST(ScaledShape, ABoxTakesAScaleOfItsOwnForEachAxis) {
    EXPECT_EQ(only<BoxShape>(scaled_shape(BoxShape{Vec3(1.0)}, along_axes(1, 2, 3), {})).half_extents,
              Vec3(1.0, 2.0, 3.0));
}

TEST(ScaledShape, WhatIsRoundTakesOneScaleOnly) {
    EXPECT_EQ(only<SphereShape>(scaled_shape(SphereShape{0.5}, along_axes(2, 2, 2), {})).radius, 1.0);
    EXPECT_TRUE(is_uneven(scaled_shape(SphereShape{0.5}, along_axes(1, 2, 1), {})));
    EXPECT_EQ(only<CapsuleShape>(scaled_shape(CapsuleShape{0.5, 1.0}, along_axes(2, 2, 2), {})).half_segment,
              2.0);
    EXPECT_TRUE(is_uneven(scaled_shape(CapsuleShape{0.5, 1.0}, along_axes(1, 2, 1), {})));
}

TEST(ScaledShape, ACylinderMayBeLongerThanItIsWide) {
    const auto longer = only<CylinderShape>(scaled_shape(CylinderShape{0.5, 1.0}, along_axes(2, 3, 2), {}));
    EXPECT_EQ(longer.radius, 1.0);
    EXPECT_EQ(longer.half_height, 3.0);
    EXPECT_TRUE(is_uneven(scaled_shape(CylinderShape{0.5, 1.0}, along_axes(2, 2, 1), {})));
}

TEST(ScaledShape, ShearIsUneven) {
    const Mat3 sheared(Vec3(1, 0, 0), Vec3(0.5, 1, 0), Vec3(0, 0, 1));
    EXPECT_TRUE(is_uneven(scaled_shape(BoxShape{Vec3(1.0)}, sheared, {})));
    EXPECT_TRUE(is_uneven(scaled_shape(HeightFieldShape{}, sheared, {})));
}

TEST(ScaledShape, ThePlaneStaysWhereItsPointsGo) {
    const Vec3 normal = glm::normalize(Vec3(1.0, 2.0, 0.0));
    const Mat3 scaling = along_axes(2.0, 1.0, 1.0);
    const auto plane = only<PlaneShape>(scaled_shape(PlaneShape{normal, 0.5}, scaling, {}));
    for (const Vec3 along : {Vec3(2.0, -1.0, 0.0), Vec3(0.0, 0.0, 1.0), Vec3(0.0)}) {
        const Vec3 point = scaling * (0.5 * normal + along);
        EXPECT_NEAR(glm::dot(plane.normal, point), plane.offset, 1e-12);
    }
    EXPECT_NE(scaled_shape(PlaneShape{Vec3(0.0), 0.0}, Mat3(1.0), {}).error, "");
}

TEST(ScaledShape, AMirroredHeightMapKeepsItsUp) {
    HeightFieldShape field;
    field.columns = field.rows = 2;
    field.heights = std::make_shared<std::vector<float>>(4, 0.0f);
    const ShapeReading reading = scaled_shape(field, along_axes(-1, -1, -1), {});
    EXPECT_EQ(only<HeightFieldShape>(reading).scale, Vec3(-1.0, 1.0, 1.0));
    EXPECT_NEAR((reading.shapes.front().pose.rotation * Vec3(0, 1, 0)).y, -1.0, 1e-12);
}

TEST(ScaledShape, ASizeThatIsNoneIsSaidAtOnce) {
    EXPECT_NE(scaled_shape(SphereShape{0.0}, Mat3(1.0), {}).error, "");
    EXPECT_NE(scaled_shape(BoxShape{Vec3(std::numeric_limits<double>::quiet_NaN())}, Mat3(1.0), {}).error,
              "");
}

TEST(ScaledShape, AHullOfScaledPointsAndOneWithoutVolume) {
    const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const auto hull = only<ConvexHullShape>(scaled_hull(corners, along_axes(2, 2, 2), {}));
    double largest = 0.0;
    for (const Vec3& vertex : hull.hull->vertices) {
        largest = std::max(largest, glm::length(vertex));
    }
    EXPECT_EQ(largest, 2.0);
    EXPECT_NE(scaled_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, Mat3(1.0), {}).error, "");
}

}  // namespace
}  // namespace tactus::scaled_shape_test
