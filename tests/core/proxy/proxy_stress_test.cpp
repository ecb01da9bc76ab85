// The short form of `./run bench stress`: many hard cases, a few hundred ticks each.
#include <gtest/gtest.h>

#include "shared/stress.hpp"

namespace tactus::proxy_stress_test {
namespace {

const shared::StressCounts& counts() {
    static const shared::StressCounts all = [] {
        shared::StressCounts c;
        for (std::uint64_t seed = 1; seed <= 900; ++seed) {
            shared::run_stress_case(seed, {.ticks = 400}, c);
        }
        return c;
    }();
    return all;
}

// Each with its seed, its tick and its numbers.
std::string failures() {
    std::string all;
    for (const std::string& failure : counts().failures) {
        all += failure + "\n";
    }
    return all;
}

TEST(ProxyStress, TheCasesAreInContact) {
    EXPECT_GT(counts().contact_ticks, 40'000u);
    EXPECT_GT(counts().checked_ticks, 200u);
}

TEST(ProxyStress, NoPenetrationNoPassNoNan) {
    EXPECT_EQ(counts().penetrations, 0u) << failures();
    EXPECT_EQ(counts().passes, 0u) << failures();
    EXPECT_EQ(counts().nans, 0u);
}

// A box that has become flatter than the sphere in it lets it out between two looks at its side; a crumpled
// star took all the work of a tick to push it off two walls in turn.
TEST(ProxyStress, WhatIsLetOutOfAFormWithoutRoomHasNotPassedIt) {
    shared::StressCounts let_out;
    shared::run_stress_case(24'010, {.ticks = 240}, let_out);
    shared::run_stress_case(39'814, {.ticks = 1'900}, let_out);
    EXPECT_EQ(let_out.passes, 0u);
    EXPECT_GT(let_out.excused_ticks, 0u);
}

TEST(ProxyStress, NoTickIsStuck) {
    EXPECT_EQ(counts().stuck_ticks, 0u);
}

TEST(ProxyStress, NoTickLeadsAwayFromItsHand) {
    EXPECT_LT(counts().thrown_max, 0.11);
}

TEST(ProxyStress, WhatIsFinishedIsThere) {
    EXPECT_EQ(counts().false_ends, 0u) << failures();
    EXPECT_LT(counts().error_max, 1e-3);
}

// The hand is in the plane of a row of vertices, to the last bit: the sphere balances on one of them.
TEST(ProxyStress, OnACrestAHairDecides) {
    shared::StressCounts crest;
    shared::run_stress_case(45'083, {.ticks = 410}, crest);
    EXPECT_EQ(crest.balanced_ticks, 1u);
    EXPECT_EQ(crest.false_ends, 0u);
}

}  // namespace
}  // namespace tactus::proxy_stress_test
