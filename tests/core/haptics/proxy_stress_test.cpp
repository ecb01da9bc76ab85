// The short form of `./run bench stress`: many hard cases, a few hundred ticks each.
#include <gtest/gtest.h>

#include "shared/stress.hpp"

namespace tactus {
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

TEST(ProxyStress, NoTickIsStuck) {
    EXPECT_EQ(counts().stuck_ticks, 0u);
}

}  // namespace
}  // namespace tactus
