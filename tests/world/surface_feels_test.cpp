#include "world/surface_feels.hpp"

#include <gtest/gtest.h>

namespace tactus::surface_feels_test {
namespace {

SurfaceFeel plain() {
    return {};
}

SurfaceFeel by_uv() {
    SurfaceFeel feel;
    feel.material.by_uv = true;
    feel.images.friction = std::make_shared<const TouchImage>();
    return feel;
}

TEST(SurfaceFeels, OnlyWhatSomebodyAsksForIsRead) {
    EXPECT_EQ(parts_for({}, false), (SurfaceParts{false, false}));
    EXPECT_EQ(parts_for({std::nullopt, std::nullopt}, false), (SurfaceParts{false, false}));
    EXPECT_EQ(parts_for({}, true), (SurfaceParts{false, true}));
    EXPECT_EQ(parts_for({std::nullopt, plain()}, false), (SurfaceParts{true, false}));
    EXPECT_EQ(parts_for({by_uv()}, false), (SurfaceParts{true, true}));
    SurfaceFeel without_images = by_uv();
    without_images.images = {};
    EXPECT_EQ(parts_for({without_images}, false), (SurfaceParts{true, false}));
}

constexpr std::array<std::array<float, 2>, 4> corners{
    {{0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 1.0F}, {0.0F, 1.0F}}};

TEST(SurfaceFeels, TrianglesAreNumberedBySurfaceAndTurnedRound) {
    constexpr std::array<std::int32_t, 6> indices{0, 1, 2, 0, 2, 3};
    SurfaceMap map;
    add(map, {0, 3, {}, {}}, {true, true});
    add(map, {1, 4, indices, corners}, {true, true});
    EXPECT_EQ(map.surface, (std::vector<std::uint8_t>{0, 1, 1}));
    ASSERT_EQ(map.uv.size(), 3u);
    EXPECT_EQ(map.uv[0], (SurfaceMap::Corners{}));
    EXPECT_EQ(map.uv[1], (SurfaceMap::Corners{corners[0], corners[2], corners[1]}));
    EXPECT_EQ(map.uv[2], (SurfaceMap::Corners{corners[0], corners[3], corners[2]}));
    EXPECT_EQ(parts_of(map), (SurfaceParts{true, true}));
}

TEST(SurfaceFeels, PartsThatNobodyWantsAreNotThere) {
    SurfaceMap map;
    add(map, {3, 6, {}, {}}, {true, false});
    EXPECT_EQ(parts_of(map), (SurfaceParts{true, false}));
    EXPECT_EQ(map.surface, (std::vector<std::uint8_t>{3, 3}));
    SurfaceMap images;
    add(images, {0, 4, {}, corners}, {false, true});
    EXPECT_EQ(parts_of(images), (SurfaceParts{false, true}));
}

TEST(SurfaceFeels, AnIndexThatLeadsNowhereHasThePlaceOfNothing) {
    constexpr std::array<std::int32_t, 3> indices{-1, 4, 2};
    SurfaceMap map;
    add(map, {0, 4, indices, corners}, {false, true});
    ASSERT_EQ(map.uv.size(), 1u);
    EXPECT_EQ(map.uv[0], (SurfaceMap::Corners{{{0.0F, 0.0F}, corners[2], {0.0F, 0.0F}}}));
}

TEST(SurfaceFeels, WhatIsNotFeltIsTold) {
    EXPECT_EQ(problem_of({}, 0, nullptr), "");
    EXPECT_EQ(problem_of({plain()}, 1, nullptr), "");
    EXPECT_NE(problem_of({plain(), plain()}, 1, nullptr), "");
    SurfaceMap map;
    EXPECT_NE(problem_of({by_uv()}, 1, &map), "");
    add(map, {0, 3, {}, {}}, {true, true});  // all corners at one point
    EXPECT_NE(problem_of({by_uv()}, 1, &map), "");
    add(map, {0, 4, {}, corners}, {true, true});
    EXPECT_EQ(problem_of({by_uv()}, 1, &map), "");
}

}  // namespace
}  // namespace tactus::surface_feels_test
