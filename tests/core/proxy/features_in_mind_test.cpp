#include "core/proxy/features_in_mind.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace tactus::features_in_mind_test {
namespace {

bool has(std::span<const FeatureId> features, std::uint32_t part) {
    return std::ranges::find(features, part, &FeatureId::part) != features.end();
}

TEST(FeaturesInMind, TheOldestIsForgottenForANewOne) {
    FeaturesInMind mind;
    for (std::uint32_t part = 0; part < 6; ++part) {
        mind.keep({part});
        mind.keep({0});
    }
    EXPECT_EQ(mind.kept().size(), 6u);
    EXPECT_TRUE(has(mind.kept(), 0));
    mind.keep({6});
    EXPECT_EQ(mind.kept().size(), 6u);
    EXPECT_FALSE(has(mind.kept(), 0));
    EXPECT_TRUE(has(mind.kept(), 6));
    mind.let_go();
    EXPECT_TRUE(mind.kept().empty());
}

TEST(FeaturesInMind, WhatStopsTheSphereCountsUntilItHasMoved) {
    const Vec3 here(0.0, 0.1, 0.0);
    const Vec3 there(0.0, 0.2, 0.0);
    FeaturesInMind mind;
    EXPECT_TRUE(mind.insist_on({1}, here));
    EXPECT_FALSE(mind.insist_on({1}, here));
    EXPECT_TRUE(mind.insist_on({2}, here));
    EXPECT_EQ(mind.insisted_at(here).size(), 2u);
    EXPECT_TRUE(mind.insisted_at(there).empty());
    EXPECT_TRUE(mind.insist_on({1}, there));
    EXPECT_EQ(mind.insisted_at(there).size(), 1u);
    EXPECT_TRUE(mind.insisted_at(here).empty());
    mind.scene_has_changed();
    EXPECT_EQ(mind.count(), 0);
}

TEST(FeaturesInMind, NoMoreIsInsistedOnThanThereIsRoomFor) {
    const Vec3 here(0.0);
    FeaturesInMind mind;
    std::uint32_t part = 0;
    while (part < 1'000 && mind.insist_on({part}, here)) {
        ++part;
    }
    EXPECT_EQ(mind.insisted_at(here).size(), part);
    EXPECT_LT(part, 100u);
}

}  // namespace
}  // namespace tactus::features_in_mind_test
