// No change of the scene is felt as a kick.
#include <gtest/gtest.h>

#include "shared/kicks.hpp"

namespace tactus {
namespace {

using shared::KickCase;
using shared::KickFigures;

class Kicks : public ::testing::TestWithParam<KickCase> {};

TEST_P(Kicks, NoneIsFelt) {
    constexpr int seeds = 25;
    for (int seed = 0; seed < seeds; ++seed) {
        const KickFigures figures = shared::play_kick(GetParam(), static_cast<std::uint64_t>(seed));
        EXPECT_LE(figures.force_step_max, 0.5) << "seed " << seed;
        EXPECT_EQ(figures.overlaps, 0) << "seed " << seed;
        EXPECT_EQ(figures.imprisoned, 0) << "seed " << seed;
        EXPECT_EQ(figures.untouchable, 0) << "seed " << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Family, Kicks, ::testing::ValuesIn(shared::kick_cases),
                         [](const auto& tested) { return std::string(shared::name_of(tested.param)); });

}  // namespace
}  // namespace tactus
