// The teleoperator's world is moved while it runs, with all that is in it: in its own frame nothing has
// changed.
#include "linked_tools.hpp"

namespace tactus::moved_world_test {
namespace {

using namespace session_test;

const Pose places[] = {{{3.7, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}},
                       {{0.0, 2.0, -1.0}, glm::angleAxis(1.0, Vec3(0.0, 0.6, 0.8))},
                       {}};

BodyAddition slab() {
    return body(BoxShape{{1.0, 0.5, 1.0}}, {0.0, -0.5, 0.0}, Motion::Static);
}

void move_far_world(LinkedPlaces& rig, SessionHandle slab_there, const Pose& place) {
    TeleopSettings settings;
    settings.frame = place;
    settings.gravity = direction_to_parent(place, Vec3(0.0, -9.81, 0.0));
    rig.far.port->settings.publish(settings);
    rig.far.session.teleport_body(slab_there, compose(place, Pose{{0.0, -0.5, 0.0}, {1.0, 0.0, 0.0, 0.0}}));
}

TEST(MovedWorld, AFingertipPressesOn) {
    LinkedPlaces rig(0.02, 0.0, 1);
    const SessionHandle under = rig.add(slab());
    rig.settle();
    rig.near.devices[0].position = {0.0, 0.1, 0.0};
    rig.ticks(300);
    rig.near.devices[0].position = {0.0, 0.0, 0.0};
    rig.ticks(500);
    for (const Pose& place : places) {
        move_far_world(rig, under, place);
        for (int i = 0; i < 300; ++i) {
            rig.tick();
            const ProxyState& there = rig.far.session.snapshot().proxies[0];
            EXPECT_NEAR(glm::length(rig.near.devices[0].force), 5.0, 0.01);
            EXPECT_NEAR(glm::length(there.force), 5.0, 0.01);
            EXPECT_LT(glm::distance(to_local(place, there.position), Vec3(0.0, 0.01, 0.0)), 1e-4);
        }
    }
}

TEST(MovedWorld, AToolPressesOn) {
    LinkedTools rig(0.02);
    const SessionHandle under = rig.add(slab());
    rig.settle();
    put(rig.hand(), {0.0, 0.1, 0.0}, Quat(1.0, 0.0, 0.0, 0.0));
    rig.ticks(300);
    put(rig.hand(), {0.0, 0.005, 0.0}, Quat(1.0, 0.0, 0.0, 0.0));
    rig.ticks(500);
    const double before = glm::length(rig.theirs().force);
    ASSERT_GT(before, 1.0);
    for (const Pose& place : places) {
        move_far_world(rig, under, place);
        rig.ticks(300);
        EXPECT_NEAR(glm::length(rig.theirs().force), before, 0.05);
        EXPECT_LT(glm::distance(to_local(place, rig.theirs().pose.position), rig.ours().pose.position), 1e-3);
    }
}

// The line is dead meanwhile: the hand comes back to where it was on what has been moved.
TEST(MovedWorld, AHandThatWasLostComesBackInIt) {
    LinkedPlaces rig(0.02, 0.0, 1);
    const SessionHandle under = rig.add(slab());
    rig.settle();
    rig.near.devices[0].position = {0.0, 0.1, 0.0};
    rig.ticks(300);
    rig.near.devices[0].position = {0.0, 0.0, 0.0};
    rig.ticks(500);
    rig.lose_everything(true);
    rig.ticks(1500);
    move_far_world(rig, under, places[0]);
    rig.ticks(300);
    rig.lose_everything(false);
    rig.ticks(1500);
    const ProxyState& there = rig.far.session.snapshot().proxies[0];
    EXPECT_NEAR(glm::length(there.force), 5.0, 0.05);
    EXPECT_LT(glm::distance(to_local(places[0], there.position), Vec3(0.0, 0.01, 0.0)), 1e-3);
}

}  // namespace
}  // namespace tactus::moved_world_test
