// No change of the scene is felt as a kick.
#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "shared/kicks.hpp"

namespace tactus {
namespace {

using shared::KickCase;
using shared::KickFigures;

class Kicks : public ::testing::TestWithParam<KickCase> {};

TEST_P(Kicks, NoneIsFelt) {
    std::vector<std::uint64_t> seeds(25);
    std::iota(seeds.begin(), seeds.end(), 0);
    // Which have kicked: an edge that slips away below the hand, friction that gives way, a squeeze that
    // has no one place, a deformation that a tick did not finish.
    seeds.insert(seeds.end(), {1006, 1011, 1015, 1108, 1148, 1061, 1173, 1189});
    // Where a tool began anew astride a wall, between two of its spheres.
    seeds.insert(seeds.end(), {1014, 1078, 1166, 1199});
    for (const std::uint64_t seed : seeds) {
        const KickFigures figures = shared::play_kick(GetParam(), seed);
        EXPECT_LE(figures.force_step_max, 0.5) << "seed " << seed;
        EXPECT_LE(figures.torque_step_max, 0.02) << "seed " << seed;
        EXPECT_EQ(figures.overlaps, 0) << "seed " << seed;
        EXPECT_EQ(figures.imprisoned, 0) << "seed " << seed;
        EXPECT_EQ(figures.untouchable, 0) << "seed " << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Family, Kicks, ::testing::ValuesIn(shared::kick_cases),
                         [](const auto& tested) { return std::string(shared::name_of(tested.param)); });

}  // namespace
}  // namespace tactus
