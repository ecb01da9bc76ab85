// No change of the scene is felt as a kick.
#include <gtest/gtest.h>

#include <functional>
#include <glm/geometric.hpp>
#include <numeric>
#include <vector>

#include "linked_places.hpp"
#include "shared/kicks.hpp"

namespace tactus::kick_test {
namespace {

using session_test::HeldDevice;
using session_test::LinkedPlaces;
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

// What owns the hand changes where a model of the far side is touched, by delayed touch without one, and by
// those who then touch what is here.
TEST(LinkedKicks, NoneIsFeltOverALinkEither) {
    for (const bool traditional : {false, true}) {
        TeleopSettings settings;
        settings.traditional = traditional;
        LinkedPlaces places(0.03, 0.0, 2, settings, settings);
        BodyAddition ground;
        ground.description.shapes = {PlacedShape{BoxShape{Vec3(1.0)}, Pose{}}};
        ground.description.motion = Motion::Static;
        ground.touch_material = {1000.0, 0.0, 0.5, 0.4};
        const SessionHandle body = places.add(ground);
        places.settle();
        places.ticks(300);
        std::vector<HeldDevice>& hands = places.near.devices;
        const auto press = [&](HeldDevice& hand) {
            for (int i = 0; i < 400; ++i) {
                hand.position = {0.0, 1.01 + (400 - i) * 5e-5 - 0.004, 0.0};
                places.tick();
            }
            places.ticks(200);
        };
        press(hands[0]);
        EXPECT_GT(glm::length(hands[0].force), 3.0);
        Session& session = places.near.session;
        ProxyDescription pointer;
        pointer.device = 0;
        Workspace workspace;
        workspace.force_limit = 100.0;
        SessionHandle proxy = 0;
        const auto set_workspace = [&](double y, double force_scale) {
            // Over a link without a model a hand that is put elsewhere has gone there, for who touches there.
            workspace.pose.position.y = traditional ? 0.0 : y;
            workspace.force_scale = force_scale;
            session.set_workspace(0, workspace);
        };
        const auto set_enabled = [&](bool enabled) {
            pointer.enabled = enabled;
            session.set_proxy(proxy, pointer);
        };
        const std::vector<std::function<void()>> changes = {
            [&] { set_enabled(false); },          [&] { set_enabled(true); },
            [&] { set_workspace(0.0, 2.0); },     [&] { set_workspace(-0.002, 2.0); },
            [&] { set_workspace(0.0, 1.0); },     [&] { session.attach(std::unique_ptr<TeleopSide>()); },
            [&] { session.remove_proxy(proxy); }, [&] { proxy = session.add_proxy(pointer).handle; },
            [&] { session.remove_body(body); },
        };
        for (std::size_t i = 0; i < changes.size(); ++i) {
            changes[i]();
            for (int tick = 0; tick < 150; ++tick) {
                const Vec3 before = hands[0].force;
                places.tick();
                EXPECT_LE(glm::distance(hands[0].force, before), 0.5)
                    << "change " << i << (traditional ? " traditional" : "") << ", tick " << tick;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Family, Kicks, ::testing::ValuesIn(shared::kick_cases),
                         [](const auto& tested) { return std::string(shared::name_of(tested.param)); });

}  // namespace
}  // namespace tactus::kick_test
